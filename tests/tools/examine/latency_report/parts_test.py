# SPDX-License-Identifier: Apache-2.0
"""What tools/latency-report computes, without running anything that it measures."""
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[4]
sys.path.insert(0, str(ROOT / "tools" / "examine"))

from latency_report import lost, measure, processes, rounds, tables, wire  # noqa: E402


def times(p50, p99, largest=0.0):
    return {"p50": p50, "p99": p99, "max": largest}


def results(**changed):
    """Results in which every time is 100 us at the median and 200 us at p99, but for those named."""
    all_keys = ("cyclictest", "wakeup", "tick", "ddsperf_roundtrip", "pose_to_force", "pose_to_force_less_wait",
                "pose_to_field")
    found = {key: times(100.0, 200.0) for key in all_keys}
    found["pose_to_force_phase_locked"] = None
    for key in ("force_with_viewers", "force_less_wait_with_viewers"):
        found[key] = {name: times(100.0, 200.0) for name in rounds.VIEWERS}
    found.update(changed)
    return found


def row(title):
    return next(one for one in tables.ROWS if one[0].strip() == title)


class Wire(unittest.TestCase):
    def test_sizes_are_those_of_the_types_that_cross_the_wire(self):
        idl = ROOT / "idl/palpate.idl"
        self.assertEqual(wire.size_of(idl, "ToolPose"), 116)
        self.assertEqual(wire.size_of(idl, "ToolForce"), 316)

    def test_numbers_lie_at_multiples_of_their_size_up_to_four(self):
        with tempfile.TemporaryDirectory() as folder:
            idl = pathlib.Path(folder) / "a.idl"
            idl.write_text("struct A {\n  unsigned long a; // one\n  double b[2];\n  @key long c;\n  boolean d;\n  double e;\n};\n")
            self.assertEqual(wire.size_of(idl, "A"), 4 + 4 + 16 + 4 + 1 + 3 + 8)
            idl.write_text("struct A {\n  string<8> name;\n};\n")
            with self.assertRaisesRegex(processes.Failure, "string<8> name"):
                wire.size_of(idl, "A")
            with self.assertRaisesRegex(processes.Failure, "no struct B"):
                wire.size_of(idl, "B")


class Numbers(unittest.TestCase):
    def test_quantile_counts_what_the_histogram_left_out(self):
        counts = [(10, 50), (20, 49)]
        self.assertEqual(measure._quantile(counts, 100, 0.5), 10)
        self.assertEqual(measure._quantile(counts, 100, 0.99), 20)
        self.assertIsNone(measure._quantile(counts, 101, 0.99))

    def test_wakeups_of_cyclictest_are_in_us_unless_they_lie_beyond_its_histogram(self):
        thread = {"histogram": {"3000": 98, "9500": 1}, "cycles": 100, "max": 2500000}
        self.assertEqual(measure.wakeups(thread, 1e-3), times(3.0, 9.5, 2500.0))
        self.assertIsNone(measure.wakeups(dict(thread, cycles=101), 1e-3))

    def test_a_thread_that_woke_some_periods_late_missed_as_many(self):
        thread = {"histogram": {"40": 90, "249": 5, "250": 2, "800": 1}, "cycles": 99}
        self.assertEqual(lost.missed(thread, 250.0), 2 + 3 + 4000)
        self.assertEqual(lost.missed(dict(thread, cycles=98), 1000.0), 0)

    def test_periods_missed_are_added_up_and_compared(self):
        times_us = {"p50": 10.0, "p99": 20.0}
        def run(missed):
            return {"ticks": 100, "missed": missed, "tick_us": times_us, "wakeup_us": times_us,
                    "late_ticks": {"preempted": missed, "unknown": 1, "preempted_by": "hog"}}
        text = lost.as_text({"cyclictest": [run(2), run(1)], "server": [run(0), run(3)]}, 4000.0, 1.0)
        self.assertIn("3 of       200   (0 + 3)", text)
        self.assertIn("its late ticks: 3 preempted, 2 unknown\n", text)
        self.assertIn("no more than cyclictest: held", text)
        self.assertIn("missed", lost.as_text({"cyclictest": [run(2)], "server": [run(3)]}, 4000.0, 1.0).splitlines()[-1])

    def test_statistics_of_ddsperf_are_understood(self):
        line = ("[72] 1.000  vm:71 size 288 mean 123.652us min 46.967us 50% 79.272us 90% 90.558us 99% 1567.062us "
                "max 5919.791us cnt 995\n")
        self.assertEqual(measure._STATISTICS.findall(line), [("79.272", "1567.062", "5919.791", "995")])

    def test_ddsperf_prints_half_of_a_round_trip(self):
        line = "[72] {}.000  vm:71 size 288 mean 1us min 1us 50% {}us 90% 1us 99% 90us max 500us cnt {}\n"
        text = line.format(1, 900, 995) + line.format(2, 40, 1000) + line.format(3, 7, 3)
        self.assertEqual(measure.ping_pong(text), times(80.0, 180.0, 1000.0))
        self.assertIsNone(measure.ping_pong(line.format(1, 40, 1000)))
        self.assertIsNone(measure.ping_pong(line.format(1, 40, 1000) + line.format(2, 40, 250)))
        self.assertIsNotNone(measure.ping_pong(line.format(1, 40, 1000) + line.format(2, 40, 251)))

    def test_middle_is_the_median_and_the_largest_maximum(self):
        found = [results(tick=times(x, 10 * x, 100 * x)) for x in (3.0, 1.0, 50.0)]
        self.assertEqual(rounds.middle(found)["tick"], times(3.0, 30.0, 5000.0))
        self.assertIsNone(rounds.middle(found)["pose_to_force_phase_locked"])


class Verdicts(unittest.TestCase):
    def test_ratio_is_to_what_was_measured_beside_it(self):
        found = results(wakeup=times(110.0, 300.0, 9e9))
        self.assertEqual(tables.cells(found, row("wake-up lateness: tick"))[4:6], ["1.10", "1.50"])

    def test_a_limit_can_be_held_and_missed_and_the_maximum_is_no_limit(self):
        title = row("wake-up lateness: tick")
        self.assertEqual(tables.cells(results(wakeup=times(119.0, 239.0, 9e9)), title)[6], "p50 <= 1.2 x: held, p99 <= 1.2 x: held")
        self.assertEqual(tables.cells(results(wakeup=times(121.0, 241.0)), title)[6], "p50 <= 1.2 x: missed, p99 <= 1.2 x: missed")
        trip = row("less the wait for the tick")
        self.assertIn("held", tables.cells(results(pose_to_force_less_wait=times(299.0, 9e9)), trip)[6])
        self.assertIn("missed", tables.cells(results(pose_to_force_less_wait=times(301.0, 0.0)), trip)[6])

    def test_phase_lock_is_judged_when_it_was_measured(self):
        title = row("with phase lock")
        self.assertEqual(tables.cells(results(), title)[6], "not measured")
        self.assertIn("held", tables.cells(results(pose_to_force_phase_locked=times(299.0, 400.0)), title)[6])
        self.assertIn("missed", tables.cells(results(pose_to_force_phase_locked=times(301.0, 400.0)), title)[6])


class Processes(unittest.TestCase):
    def test_what_was_started_ends_even_when_it_is_stopped(self):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "log"
            sleeper = processes.start(["sleep", "100"], log)
            slow = processes.Slowed(sleeper)
            time.sleep(0.05)
            slow.end()
            processes.end_all()
            self.assertIsNotNone(sleeper.poll())

    def test_a_program_that_fails_or_hangs_or_is_missing_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "log"
            with self.assertRaisesRegex(processes.Failure, "bash ended with code 3: went wrong"):
                processes.output_of(["bash", "-c", "echo went wrong >&2; exit 3"], log, 10)
            with self.assertRaisesRegex(processes.Failure, "sleep did not end within 1 s"):
                processes.output_of(["sleep", "100"], log, 1)
            with self.assertRaisesRegex(processes.Failure, "no-such-program: No such file"):
                processes.output_of(["no-such-program"], log, 1)

    def test_the_script_refuses_what_it_cannot_measure(self):
        def said(*words):
            return subprocess.run([ROOT / "tools/latency-report", *words], capture_output=True, text=True, check=False)
        self.assertIn("--seconds is 0.5, expected 1 to 3600", said("--seconds", "0.5").stderr)
        self.assertIn("--rate goes with --lost-ticks", said("--rate", "4000").stderr)
        self.assertIn("--rate is 20000, expected 50 to 10000", said("--lost-ticks", "--rate", "20000").stderr)
        self.assertIn("/no/such.h5 is not there", said("--model", "/no/such.h5").stderr)
        self.assertIn("/bin/palpate-server is not there", said("--model", "/dev/null", "--bin", "/bin").stderr)


if __name__ == "__main__":
    unittest.main()
