# SPDX-License-Identifier: Apache-2.0
"""How many periods the server's tick misses, beside cyclictest's thread at the same rate."""
import json
import sys

from . import measure, processes

_FASTEST_POSES = 4000  # Hz: palpate-latency's


def missed(thread, period_us):
    """Periods that cyclictest's thread slept through: it goes on at the first point of its grid that is still to come.
    @param thread  of its JSON, histogram in whole us"""
    beyond = thread["cycles"] - sum(thread["histogram"].values())  # later than the histogram's second
    within = sum(int(int(late_us) // period_us) * count for late_us, count in thread["histogram"].items())
    return within + beyond * int(1e6 // period_us)


def _cyclictest(setup, rate):
    thread = measure.cyclictest_thread(setup, nanoseconds=False, rate=rate)
    return {"ticks": thread["cycles"], "missed": missed(thread, 1e6 / rate)}


def _server(setup, rate):
    with measure.Server(setup, locked=False, more=("--rate", f"{rate:g}")):
        command = [setup.bin / "palpate-latency", "--domain", setup.domain, "--seconds", setup.seconds,
                   "--rate", f"{min(rate, _FASTEST_POSES):g}", "--wait", 60, "--json"]
        report = json.loads(processes.output_of(command, setup.log("latency"), setup.seconds + 60, setup.env))
    return {"ticks": report["received"] + report["lost"], "missed": report["overruns"], "tick_us": report["tick_us"],
            "wakeup_us": report["wakeup_us"], "late_ticks": report["late_ticks"]}


def as_text(found, rate, seconds):
    totals = {name: (sum(one["missed"] for one in runs), sum(one["ticks"] for one in runs)) for name, runs in found.items()}
    lines = [f"periods missed at {rate:g} Hz, {len(found['server'])} x {seconds:g} s, one tool that presses and slides"]
    for name, title in (("cyclictest", "cyclictest"), ("server", "palpate-server's tick")):
        each = " + ".join(str(one["missed"]) for one in found[name])
        lines.append(f"{title:24} {totals[name][0]:8} of {totals[name][1]:9}   ({each})")
    last = found["server"][-1]
    lines.append("tick / us, the last run: compute p50 {:.1f}, p99 {:.1f}; woke late by p50 {:.1f}, p99 {:.1f}".format(
        last["tick_us"]["p50"], last["tick_us"]["p99"], last["wakeup_us"]["p50"], last["wakeup_us"]["p99"]))
    late = {}
    for one in found["server"]:
        measure.add_late(late, one["late_ticks"])
    lines.append("its late ticks: " + measure.late_text(late))
    lines.append("no more than cyclictest: " + ("held" if totals["server"][0] <= totals["cyclictest"][0] else "missed"))
    return "\n".join(lines)


def report(setup, rate, alternations, json_file):
    """Measures both in turn, prints, and writes lost.txt. @return the exit code"""
    found = {"cyclictest": [], "server": []}
    for turn in range(alternations):
        print(f"alternation {turn + 1} of {alternations}", file=sys.stderr, flush=True)
        found["cyclictest"].append(_cyclictest(setup, rate))
        found["server"].append(_server(setup, rate))
    text = as_text(found, rate, setup.seconds)
    print("\n".join([text, *setup.notes]))
    (setup.out / "lost.txt").write_text(text + "\n", encoding="utf-8")
    if json_file is not None:
        json_file.write_text(json.dumps({"rate_hz": rate, "seconds": setup.seconds, **found}, indent=2) + "\n", encoding="utf-8")
    return 0
