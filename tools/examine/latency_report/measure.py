# SPDX-License-Identifier: Apache-2.0
"""One measurement each: cyclictest, ddsperf, palpate. All give {"p50", "p99", "max"} in us."""
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import time

from . import processes, wire
from .processes import Failure

TICK_PRIORITY = 80     # docs/design.md, Threads
RECEIVE_PRIORITY = 70  # of palpate's threads that receive; ddsperf gets the same
SWEEP_RATE = 991       # Hz: against 1000 ticks per second the wait passes through all values nine times per second


class Setup:
    """The settings that all measurements share. @throw Failure naming a missing program or file"""

    def __init__(self, options, tools):
        self.seconds = options.seconds
        self.alternations = options.alternations
        self.model, self.bin, self.out = options.model, options.bin, options.out
        self.server_arguments = options.server_arguments.split()
        self.notes = []
        self._check_programs()
        self.out.mkdir(parents=True, exist_ok=True)
        for old in self.out.glob("*.log"):
            old.unlink()
        self.env = dict(os.environ, CYCLONEDDS_URI=_shell(tools, 'use_loopback; printf %s "$CYCLONEDDS_URI"'))
        self.domain = int(_shell(tools, "free_domain"))
        idl = tools.parent / "idl/palpate.idl"
        self.pose_bytes, self.force_bytes = wire.size_of(idl, "ToolPose"), wire.size_of(idl, "ToolForce")
        self.realtime = _realtime_granted()
        if not self.realtime:
            self.notes.append("no real-time priority: run as root, or raise rtprio in limits.conf; figures are those of "
                              "ordinary threads")
        self.phase_lock = "--phase-lock" in _help_of(self.bin / "palpate-server")
        if not self.phase_lock:
            self.notes.append("this palpate-server has no --phase-lock: that row is empty")
        self.tick_cpus = self._affinity_of_the_tick()
        self.busy_cpus = self._other_cpus()

    def log(self, name):
        return self.out / f"{name}.log"

    def note_awake(self, granted):
        if not granted:
            self.notes.append("/dev/cpu_dma_latency could not be held: processors may sleep deeply between wake-ups")

    def _check_programs(self):
        if not self.model.exists():
            raise Failure(f"{self.model} is not there: tools/demo makes it, or give --model")
        for program, package in (("cyclictest", "rt-tests"), ("ddsperf", "cyclonedds-tools"), ("taskset", "util-linux")):
            if shutil.which(program) is None:
                raise Failure(f"{program} is not installed: apt-get install {package}")
        for program in ("palpate-server", "palpate-latency", "palpate-watch"):
            if not (self.bin / program).exists():
                raise Failure(f"{self.bin / program} is not there: build first (tools/check, tools/demo), or give --bin")

    def _affinity_of_the_tick(self):
        """Processors that the server's tick thread may use: cyclictest gets the same."""
        with Server(self, locked=False) as server:
            return server.tick_cpus()

    def _other_cpus(self):
        """Processors that get the load: all but one that the tick may use."""
        keep = max(self.tick_cpus)
        return sorted(cpu for cpu in os.sched_getaffinity(0) if cpu != keep)


def _shell(tools, command):
    result = subprocess.run(["bash", "-c", f"source {tools}/common.sh; {command}"], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise Failure(f"tools/common.sh: {result.stderr.strip()}")
    return result.stdout


def _help_of(program):
    return subprocess.run([str(program), "--help"], capture_output=True, text=True, check=False).stdout


def _realtime_granted():
    probe = subprocess.run(["chrt", "-f", str(TICK_PRIORITY), "true"], capture_output=True, check=False)
    return probe.returncode == 0


_COARSE = ("more than 1 % of cyclictest's wake-ups were later than 1 ms: it was run again in whole us; the machine stands still "
           "too often for these figures to say much")


def cyclictest(setup):
    """Wake-up lateness of a thread like the tick: priority, policy, clock_nanosleep on CLOCK_MONOTONIC each ms, memory locked.
    Where more than 1 % of the wake-ups are later than 1 ms, it measures again in whole us, up to 1 s."""
    for nanoseconds in (True, False):
        found = wakeups(cyclictest_thread(setup, nanoseconds), 1e-3 if nanoseconds else 1.0)
        if found is not None:
            if not nanoseconds and _COARSE not in setup.notes:
                setup.notes.append(_COARSE)
            return found
    raise Failure("cyclictest: 1 % of its wake-ups lie beyond 1 s")


def cyclictest_thread(setup, nanoseconds, rate=1000.0):
    result = setup.out / "cyclictest.json"
    command = ["cyclictest", "--quiet", "--mlockall", "--threads=1", f"--interval={round(1e6 / rate)}", "--histogram=1000000",
               f"--duration={max(1, round(setup.seconds))}", f"--json={result}"]
    if nanoseconds:
        command.append("--nsecs")
    command += [f"--priority={TICK_PRIORITY}", "--policy=fifo"] if setup.realtime else ["--policy=other"]
    if setup.tick_cpus != os.sched_getaffinity(0):
        command.append("--affinity=" + ",".join(str(cpu) for cpu in sorted(setup.tick_cpus)))
    processes.output_of(command, setup.log("cyclictest"), setup.seconds + 30)
    return json.loads(result.read_text(encoding="utf-8"))["thread"]["0"]


def wakeups(thread, unit):
    """Percentiles of a thread in cyclictest's output, in units of `unit` us. @return None when p99 is beyond the histogram"""
    lateness = sorted((int(value), count) for value, count in thread["histogram"].items())
    p50, p99 = (_quantile(lateness, thread["cycles"], q) for q in (0.5, 0.99))
    return None if p99 is None else {"p50": p50 * unit, "p99": p99 * unit, "max": thread["max"] * unit}


def _quantile(counts, total, q):
    """counts: sorted (value, count); values beyond the histogram count in total only. @return None for a percentile there"""
    seen = 0
    for value, count in counts:
        seen += count
        if seen >= q * total:
            return value
    return None


_STATISTICS = re.compile(r"size \d+ mean [\d.]+us min [\d.]+us 50% ([\d.]+)us 90% [\d.]+us 99% ([\d.]+)us max ([\d.]+)us cnt (\d+)")


def ping_pong(text):
    """Percentiles from `ddsperf ping`. It prints half of each round trip, (now - time of the ping) / 2; this doubles them."""
    found = [tuple(float(x) for x in match) for match in _STATISTICS.findall(text)]
    full = [second for second in found[1:] if second[3] > _ENOUGH_PINGS]  # the sides find each other in the first
    if not full:
        return None
    return {"p50": 2.0 * statistics.median(s[0] for s in full), "p99": 2.0 * statistics.median(s[1] for s in full),
            "max": 2.0 * max(s[2] for s in full)}


_ENOUGH_PINGS = 250    # of 1000 per second: some get lost while the machine stalls, most while a side begins or ends
_DDSPERF_ATTEMPTS = 3  # best effort: on a busy machine lost pings can invalidate all seconds of a run


def ddsperf(setup, size):
    """Ping-pong between two processes, best effort, 1000 per second. @return medians of what ddsperf reports each second"""
    log = setup.log("ddsperf")
    for _ in range(_DDSPERF_ATTEMPTS):
        found = ping_pong(_ddsperf_output(setup, size, log))
        if found is not None:
            return found
    raise Failure(f"ddsperf reported no second with enough ping-pong of {size} bytes in {_DDSPERF_ATTEMPTS} runs; see {log}")


def _ddsperf_output(setup, size, log):
    priority = RECEIVE_PRIORITY if setup.realtime else None
    command = ["ddsperf", "-i", str(setup.domain), "-u"]
    seconds = round(setup.seconds) + 2
    pong = processes.start(command + ["-D", str(seconds + 5), "pong"], log, setup.env, priority)
    try:
        return processes.output_of(command + ["-D", str(seconds), "ping", "1kHz", "size", str(size)], log, seconds + 30,
                                   setup.env, priority)
    finally:
        processes.end(pong)


class Server:
    """A palpate-server on the report's domain."""

    def __init__(self, setup, locked, more=()):
        self._setup = setup
        command = [setup.bin / "palpate-server", "--model", setup.model, "--domain", setup.domain, *setup.server_arguments, *more]
        self._process = processes.start(command + (["--phase-lock"] if locked else []), setup.log("server"), setup.env)

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        code = processes.end(self._process, patience=30.0)
        if code != 0 and kind is None:  # otherwise an earlier failure is the one to report
            raise Failure(f"palpate-server ended with code {code}: {processes.last_line(self._setup.log('server'))}")

    def tick_cpus(self):
        """@throw Failure when no thread named tick appears within a minute"""
        tasks = pathlib.Path(f"/proc/{self._process.pid}/task")
        for _ in range(600):
            time.sleep(0.1)
            if self._process.poll() is not None:
                break
            tick = next((task for task in tasks.iterdir() if _name_of(task) == "tick"), None)
            if tick is not None:
                time.sleep(0.3)  # its affinity may be set after its name
                return os.sched_getaffinity(int(tick.name))
        raise Failure(f"palpate-server has no tick thread: {processes.last_line(self._setup.log('server'))}")


def _name_of(task):
    try:
        return (task / "comm").read_text(encoding="utf-8").strip()
    except OSError:  # it has just ended
        return ""


def latency(setup, rate, fields=False):
    """palpate-latency's report while a server runs. @param rate  of the poses, Hz. @param fields  read the surface too"""
    command = [setup.bin / "palpate-latency", "--domain", setup.domain, "--seconds", setup.seconds, "--rate", rate, "--wait", 60, "--json"]
    if fields:
        command.append("--fields")
    report = json.loads(processes.output_of(command, setup.log("latency"), setup.seconds + 60, setup.env))
    # Of answered poses, as the wait that is taken off it, and as ddsperf's ping-pong beside it.
    names = {"wakeup": "wakeup_us", "tick": "tick_us", "pose_to_force": "answered_pose_to_force_us",
             "pose_to_force_less_wait": "pose_to_force_less_wait_us"}
    if fields:
        names["pose_to_field"] = "pose_to_field_us"
    return {name: {key: report[ours][key] for key in ("p50", "p99", "max")} for name, ours in names.items()}
