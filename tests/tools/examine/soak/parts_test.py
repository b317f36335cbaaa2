# SPDX-License-Identifier: Apache-2.0
"""What tools/soak judges and reads, on invented series and on the test's own process."""
import json
import os
import pathlib
import random
import sys
import tempfile
import threading
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[4]
sys.path.insert(0, str(ROOT / "tools" / "examine"))

from soak import judge, report, samples, scene, stage  # noqa: E402

HOURS = 8.0
TIMES = [60.0 * i for i in range(480)]


def noise(size, seed=1):
    chance = random.Random(seed)
    return [chance.gauss(0.0, size) for _ in TIMES]


def grows(values, what="server memory"):
    return not judge.growth(what, TIMES, values, 3600.0 * HOURS).holds


class Growth(unittest.TestCase):
    def test_noise_is_no_leak(self):
        for seed in range(20):
            self.assertFalse(grows([250.0 + n for n in noise(5.0, seed)]))

    def test_a_leak_of_one_MiB_an_hour_is_found_in_noise(self):
        self.assertTrue(grows([250.0 + t / 3600.0 + n for t, n in zip(TIMES, noise(2.0))]))

    def test_a_descriptor_a_quarter_of_an_hour_is_a_leak_and_one_in_all_is_not(self):
        self.assertTrue(grows([13 + int(t / 900.0) for t in TIMES], "viewer descriptors"))
        self.assertFalse(grows([13 + (t > 15000.0) for t in TIMES], "viewer descriptors"))

    def test_threads_that_come_and_go_are_no_leak_and_those_that_stay_are(self):
        self.assertFalse(grows([13 + (i % 5) for i in range(480)], "server threads"))
        self.assertTrue(grows([13 + i // 120 for i in range(480)], "server threads"))

    def test_what_fills_during_the_warm_up_and_single_peaks_are_no_leak(self):
        self.assertFalse(grows([250.0 - 100.0 * max(0.0, 1.0 - t / 5000.0) for t in TIMES]))
        self.assertFalse(grows([250.0 + (80.0 if i % 10 == 9 else 0.0) for i in range(480)]))

    def test_a_first_and_a_last_value_decide_nothing(self):
        values = [250.0] * 480
        values[-1] = 400.0
        self.assertFalse(grows(values))

    def test_shrinking_is_no_leak(self):
        self.assertFalse(grows([250.0 - 0.01 * i for i in range(480)]))

    def test_too_few_values_or_too_short_a_part_do_not_hold(self):
        self.assertFalse(judge.growth("server memory", [25.0, 26.0], [1.0, 1.0], 30.0).holds)
        self.assertFalse(judge.growth("server memory", [29.0 + 0.01 * i for i in range(50)], [1.0] * 50, 30.0).holds)

    def test_slope_is_the_median_of_all_pairs(self):
        self.assertAlmostEqual(judge.slope([0, 1, 2, 3, 4, 5], [0, 2, 4, 6, 8, 100]), 2.0)
        self.assertIsNone(judge.slope([0, 0, 0, 0, 0, 0], [1, 2, 3, 4, 5, 6]))


class OtherVerdicts(unittest.TestCase):
    def test_a_process_that_ended_does_not_hold(self):
        self.assertTrue(judge.lives("server", None).holds)
        self.assertFalse(judge.lives("server", 0).holds)
        self.assertFalse(judge.lives("server", -9).holds)

    def test_a_tick_that_stands_still_does_not_hold(self):
        self.assertTrue(judge.beats([0, 1, 2], [0, 1000, 2000]).holds)
        stopped = judge.beats([0, 1, 2], [0, 1000, 1000])
        self.assertFalse(stopped.holds)
        self.assertIn("from 1.0 to 2.0 s", stopped.said)
        self.assertFalse(judge.beats([0], [0]).holds)

    def test_a_lost_answer_or_a_play_that_failed_does_not_hold(self):
        well = {"who": "tool 2", "lost": 0, "failed": ""}
        self.assertTrue(judge.nothing_lost([well]).holds)
        self.assertFalse(judge.nothing_lost([well, dict(well, lost=1)]).holds)
        self.assertFalse(judge.nothing_lost([well, dict(well, failed="code 1, no server")]).holds)
        self.assertFalse(judge.nothing_lost([]).holds)
        stalled = dict(well, lost=700, stalled=True)
        self.assertTrue(judge.nothing_lost([well, stalled]).holds)
        self.assertIn("lost 700: not judged", judge.nothing_lost([well, stalled]).said)
        self.assertFalse(judge.nothing_lost([stalled]).holds)

    def test_a_play_is_read_from_what_the_tool_said(self):
        said = json.dumps({"summary": {"lost": 3}})
        self.assertEqual(scene.played("tool 2", 0, said, "")["lost"], 3)
        self.assertEqual(scene.played("tool 2", 1, said, "no server")["failed"], "code 1, no server")
        self.assertNotEqual(scene.played("tool 2", 0, "", "")["failed"], "")
        self.assertEqual(scene.played("tool 3", 3, json.dumps({"stable": False, "waited_periods": 2}), "")["failed"], "")
        stalled = {"stable": False, "waited_periods": 900, "judged": False, "server_left": False, "interrupted": False}
        self.assertEqual(scene.played("tool 0", 1, json.dumps(stalled), "")["failed"], "")
        self.assertNotEqual(scene.played("tool 0", 1, json.dumps(dict(stalled, server_left=True)), "")["failed"], "")


class Run(unittest.TestCase):
    """A made-up run of two hours: a scene a minute."""

    @staticmethod
    def made(leak=0.0):
        times = {"p50": 600.0, "p99": 900.0, "max": 2000.0}
        process = {"rss": 250.0, "pss": 240.0, "descriptors": 13, "threads": 13, "minor_faults": 0, "major_faults": 0}
        shots = [{"t": 60.0 * i, "quiet": True, "server": dict(process, rss=250.0 + leak * i / 60.0), "viewer": process,
                  "ticks": 60000 * i, "tick_faults": 0} for i in range(120)]
        plays = [{"who": "tool 0", "lost": 0, "failed": "", "t": 60.0 * i, "overruns": 2, "pose_to_force_us": times, "tick_us": times,
                  "wakeup_us": times} for i in range(120)]
        return {"seconds": 7200.0, "samples": shots, "plays": plays, "codes": {"server": None, "viewer": None}, "scenes": 120, "failed": "",
                "counts": dict.fromkeys(("visitors", "pages", "frames", "asked", "swaps", "accepted", "wrong"), 1)}

    def test_a_row_an_hour(self):
        lines = report.rows(self.made(), 3600.0)
        self.assertEqual([row["until_s"] for row in lines], [3600.0, 7200.0])
        self.assertEqual(lines[0]["lost_ticks"], 120)
        self.assertIn("2:00:00  250.0  240.0   13  13", report.table(self.made(), lines))

    def test_of_a_server_that_leaks_only_its_memory_does_not_hold(self):
        self.assertTrue(all(one.holds for one in report.verdicts(self.made())))
        self.assertEqual([one.what for one in report.verdicts(self.made(leak=3.0)) if not one.holds], ["server memory"])

    def test_a_scene_that_failed_is_a_verdict_beside_the_others(self):
        verdicts = report.verdicts(dict(self.made(), failed="not all tools play"))
        self.assertEqual([(one.what, one.said) for one in verdicts if not one.holds], [("scenes", "not all tools play")])


class Samples(unittest.TestCase):
    def test_this_process_is_seen_as_it_is(self):
        before = samples.of_process(os.getpid())
        stop = threading.Event()
        thread = threading.Thread(target=stop.wait)
        thread.start()
        block = bytearray(b"x" * (32 << 20))
        with tempfile.TemporaryFile():
            after = samples.of_process(os.getpid())
        stop.set()
        thread.join()
        self.assertEqual(after["descriptors"], before["descriptors"] + 1)
        self.assertEqual(after["threads"], before["threads"] + 1)
        self.assertGreater(after["rss"], before["rss"] + 20.0)
        self.assertGreater(after["pss"], before["pss"] + 20.0)
        self.assertGreater(after["minor_faults"], before["minor_faults"])
        self.assertEqual(len(block), 32 << 20)

    def test_a_thread_that_sleeps_is_seen_to_wake(self):
        before = samples.wakes(os.getpid(), os.getpid())
        for _ in range(5):
            time.sleep(0.001)
        self.assertGreaterEqual(samples.wakes(os.getpid(), os.getpid()), before + 5)

    def test_a_process_that_is_gone_is_none(self):
        child = os.fork()
        if child == 0:
            os._exit(0)
        os.waitpid(child, 0)
        self.assertIsNone(samples.of_process(child))


class Stage(unittest.TestCase):
    def test_places_lie_far_from_each_other(self):
        points = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.9, 0.1, 0.0), (0.0, 1.0, 0.0)]
        self.assertEqual(stage.apart(points, (0.0, 0.0, 0.0), 2), [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)])

    def test_points_are_read_from_a_vtk_file(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.vtk"
            file.write_text("# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 2 double\n0 1 2\n3 4 5e-1\nPOLYGONS 0 0\n")
            self.assertEqual(stage.points_of(file), [(0.0, 1.0, 2.0), (3.0, 4.0, 0.5)])


class Hostile(unittest.TestCase):
    def test_it_does_as_many_kinds_of_wrong_as_a_scene_has_time_for(self):
        source = (ROOT / "tests/hostile/hostile_peer.c").read_text(encoding="utf-8")
        kinds = source.partition("kKinds[] = {")[2].partition("};")[0].count('{"')
        self.assertEqual(kinds, scene.KINDS_OF_WRONG)


if __name__ == "__main__":
    unittest.main()
