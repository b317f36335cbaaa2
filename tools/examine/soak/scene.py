# SPDX-License-Identifier: Apache-2.0
"""A scene: four tools play from its beginning to its end; beside them others come, go, ask and do wrong; at its end it is quiet.
A tool belongs to who moves it, so who does wrong comes after the tools and goes before them."""
import json
import signal
import subprocess
import time

from latency_report import processes
from latency_report.processes import Failure

from . import samples
from .page import Page

KINDS_OF_WRONG = 34  # of tests/hostile/hostile_peer.c
PATIENCE = 20.0      # s until all tools play
SETTLED = 2.0        # s that tools play longer than a scene, since it takes as long to see that they do
# What tools 2 and 0 do, scene by scene. Tool 1 presses and slides all the time, and sliding is what costs a tick most: of
# four that slide at once a tick takes longer than a millisecond (docs/measured.md, Soak), so no more than two do here.
SCRIPTS = ("slide", "press", "poke")
MOTIONS = ("press", "drag", "tap")
# A tool whose poses stop for so long may be taken by somebody else (docs/decisions/tool_ownership.md), and the hostile client is
# after these two. Where the machine let tool 1's sender or the server's receive thread wait for so long, us, what both lost is
# told and not judged.
SILENCE = 50e3
AT_RISK = ("tool 0", "tool 1")
TOLD = ("lost", "late", "received", "sent", "superseded", "left_out", "model_changes", "overruns", "late_ticks")
FEWEST_SECONDS = 4.0
MOST_POSES = 4000.0  # per s, of palpate-latency


def quiet_part(seconds):
    """s at the end of a scene in which only the tools and the viewer are there: what is judged is taken then."""
    return min(10.0, 0.3 * seconds)


class Scene:
    def __init__(self, stage, number, seconds, chance, clock):
        """@param[in] chance  random.Random; @param[in] clock  gives s since the soak's beginning"""
        self._stage, self._number, self._seconds, self._chance, self._clock = stage, number, seconds, chance, clock
        self._files, self._visitors, self._pages, self._questions = [], [], [], []
        self.samples, self.plays = [], []
        self.counts = {"visitors": 0, "pages": 0, "frames": 0, "asked": 0, "accepted": 0, "swaps": 0, "wrong": 0}
        self._sampled = -1.0

    def run(self):
        """@return whether the server lived"""
        tools = self._start_tools()
        self._until_all_play()
        began = self._clock()
        busy_until = began + self._seconds - quiet_part(self._seconds)
        hostile = self._start_hostile(busy_until - self._clock())
        for at, act in self._plan(self._clock(), busy_until):
            self._pass(at - self._clock())
            if not self._server_lives():
                break
            act()
        self._pass(busy_until - self._clock())
        self._end_others(hostile)
        quiet = self._back_to_the_first_model()
        self._pass(max(1.0, began + self._seconds - self._clock()), quiet)
        self._end_tools(tools)
        return self._server_lives()

    def _server_lives(self):
        return self._stage.server.poll() is None

    # -- tools that behave

    def _start_tools(self):
        stage, n = self._stage, self._number
        places = [",".join(f"{x:.6f}" for x in place) for place in stage.places]
        seconds = f"{self._seconds + SETTLED:.2f}"
        lines = {"tool 0": ["palpate-device", "--tool", 0, "--motion", MOTIONS[n % 3], f"--at={places[0]}"],
                 "tool 1": ["palpate-latency", "--tool", 1, "--wait", 30, "--rate", min(stage.rate, MOST_POSES)],
                 "tool 2": ["palpate-tool", "--tool", 2, "--script", SCRIPTS[n % 3], f"--at={places[1]}"],
                 "tool 3": ["palpate-tool", "--tool", 3, "--script", "poke", "--pokes", round(self._seconds), f"--at={places[2]}"]}
        started = {}
        for who, words in lines.items():
            file = stage.out / f"{who.replace(' ', '_')}.json"
            with open(file, "wb") as out:
                started[who] = (processes.start(stage.command([*words, "--seconds", seconds]), stage.log("tools"),
                                                stage.env, stdout=out), file)
        return started

    def _until_all_play(self):
        """@throw Failure when the server does not hear all four within PATIENCE"""
        end = self._clock() + PATIENCE
        while self._server_lives():
            try:
                heard = self._stage.asked(["palpate-list", "--timeout", 1.0], 20.0)["publishers"]
            except Failure:  # on a busy machine a second may be too short to find the server
                if self._clock() > end:
                    raise
                continue
            if {one["tool_id"] for one in heard if one["poses"] > 0} >= {0, 1, 2, 3}:
                return
            if self._clock() > end:
                raise Failure(f"not all tools play: {processes.last_line(self._stage.log('tools'))}")

    def _end_tools(self, tools):
        for who, (process, file) in tools.items():
            try:
                process.wait(15.0 + self._seconds)
            except subprocess.TimeoutExpired:
                pass
            code = processes.end(process)
            self.plays.append(played(who, code, file.read_text(encoding="utf-8"), processes.last_line(self._stage.log("tools"))))
        stalled = any(play.get("stalled") for play in self.plays)
        for play in self.plays:
            if play["who"] in AT_RISK:
                play["stalled"] = stalled

    # -- those beside them

    def _start_hostile(self, seconds):
        if self._stage.hostile is None or seconds <= 1.0:
            return None
        each = (seconds - 1.0) / KINDS_OF_WRONG
        with open(self._stage.out / "hostile.txt", "wb") as out:
            return processes.start([self._stage.hostile, self._stage.domain, "all", f"{each:.4f}", *self._stage.touch()],
                                   self._stage.log("hostile"), self._stage.env, stdout=out)

    def _plan(self, begin, end):
        """What happens when: [(s, function)] in order. Nothing in the last fifth: questions get their answers."""
        length = 0.8 * (end - begin)

        def often(every, act):
            return [(begin + length * self._chance.random(), act) for _ in range(max(1, round(length / every)))]

        plan = often(4.0, self._visit) + often(4.0, self._look) + often(5.0, self._change) + often(20.0, self._second_viewer)
        if len(self._stage.models) > 1:
            plan += [(begin + 0.25 * length, self._swap)] + (often(20.0, self._swap) if length > 20.0 else [])
        return sorted(plan, key=lambda one: one[0])

    def _visit(self):
        """Somebody follows the field, or lists; some are killed before they are done."""
        seconds = self._chance.uniform(1.0, 0.3 * self._seconds)
        words = self._chance.choice((["palpate-watch", "--seconds", f"{seconds:.2f}", "--wait", 30], ["palpate-list", "--timeout", 1]))
        self._add_visitor(self._stage.command(words), killed=self._chance.random() < 0.3)

    def _add_visitor(self, command, killed):
        process = processes.start(command, self._stage.log("visitors"), self._stage.env, stdout=subprocess.DEVNULL)
        self._visitors.append((process, killed))
        self.counts["visitors"] += 1

    def _second_viewer(self):
        process = self._stage.a_viewer(self._stage.out / "page", self._stage.out / "viewer2.json")
        self._visitors.append((process, self._chance.random() < 0.5))
        self.counts["visitors"] += 1

    def _look(self):
        self._pages.append(Page(self._stage.port, self._chance.uniform(0.5, 0.3 * self._seconds), self._chance.random() < 0.5))
        self.counts["pages"] += 1

    def _change(self):
        words = ["--friction", f"{self._chance.uniform(0.05, 0.3):.3f}",
                 "--youngs-modulus", f"{self._chance.uniform(0.6, 1.0) * self._stage.modulus:.1f}"]
        self._question(words)

    def _swap(self):
        self.counts["swaps"] += 1
        self._question(["--model", self._chance.choice(self._stage.models)])

    def _question(self, words):
        self.counts["asked"] += 1
        self._questions.append(processes.start(self._stage.command(["palpate-parameters", *words, "--wait", 10]),
                                               self._stage.log("questions"), self._stage.env, stdout=subprocess.DEVNULL))

    def _end_others(self, hostile):
        for process, killed in self._visitors:
            if killed:
                process.send_signal(signal.SIGKILL)
            processes.end(process)
        for page in self._pages:
            page.join(15.0)
            self.counts["frames"] += page.frames
            if page.failed or page.alive():
                self.plays.append({"who": "page", "lost": 0, "failed": page.failed or "it does not end"})
        for question in self._questions:
            try:
                question.wait(12.0)
            except subprocess.TimeoutExpired:
                pass
            self.counts["accepted"] += processes.end(question) == 0
        if hostile is not None:
            try:
                hostile.wait(10.0)
            except subprocess.TimeoutExpired:
                pass
            processes.end(hostile)
            text = (self._stage.out / "hostile.txt").read_text(encoding="utf-8")
            self.counts["wrong"] += sum(int(line.rpartition(":")[2]) for line in text.splitlines())

    def _back_to_the_first_model(self):
        """Memory is judged on one organ. @return whether it is back; the server rests between two models"""
        if len(self._stage.models) == 1:
            return True
        try:
            self._stage.ask_for(self._stage.models[0])
        except Failure:
            return False
        self._pass(0.5)
        return True

    # -- samples

    def _pass(self, seconds, quiet=False):
        """Time goes by; samples are taken once a second, in the quiet a dozen."""
        end = self._clock() + seconds
        every = seconds / 12.0 if quiet else 1.0
        while self._clock() < end and self._server_lives():
            if self._clock() - self._sampled >= every:
                self._sample(quiet)
            time.sleep(max(0.0, min(0.05, end - self._clock())))

    def _sample(self, quiet):
        stage = self._stage
        self._sampled = self._clock()
        server, viewer = samples.of_process(stage.server.pid), samples.of_process(stage.viewer.pid)
        wakes = samples.wakes(stage.server.pid, stage.tick)
        if server is None or viewer is None or wakes is None:
            return
        minor, major = samples.faults(stage.server.pid, stage.tick)
        self.samples.append({"t": self._sampled, "quiet": quiet, "server": server, "viewer": viewer, "ticks": wakes,
                             "tick_faults": minor + major})


def played(who, code, text, last_line):
    """One play of a tool, from what it said: {"who", "lost", "failed", ..}. A device that another organ made unstable (3), or
    that stalls let nobody judge (1), has played all the same."""
    play = {"who": who, "lost": 0, "failed": ""}
    try:
        said = json.loads(text)
    except json.JSONDecodeError:
        return dict(play, failed=f"code {code}, {last_line}")
    if "summary" in said:
        play["lost"] = said["summary"]["lost"]
    if "pose_to_force_us" in said:
        play.update({key: said[key] for key in TOLD})
        play["stalled"] = said["client_wakeup_us"]["max"] + said["receive_us"]["max"] >= SILENCE
        for key in ("pose_to_force_us", "answered_pose_to_force_us", "tick_us", "wakeup_us"):
            play[key] = {q: said[key][q] for q in ("p50", "p99", "max")}
    if "stable" in said:
        play["stable"], play["waited_periods"] = said["stable"], said["waited_periods"]
    not_judged = said.get("judged") is False and not said["server_left"] and not said["interrupted"]
    if code not in (0, 3) and not (code == 1 and not_judged):
        play["failed"] = f"code {code}, {last_line}"
    return play
