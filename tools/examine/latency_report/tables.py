# SPDX-License-Identifier: Apache-2.0
"""The report as text, as Markdown and as JSON."""
import json
import os
import platform

from . import measure

STATES = {"idle": "machine at rest", "loaded": "other processors busy"}

# Row: title, where it is in the results, what it is divided by, and the limits for p50 and p99 (None: not judged).
ROWS = (
    ("wake-up lateness: cyclictest", ("cyclictest",), None, (None, None)),
    ("wake-up lateness: tick", ("wakeup",), ("cyclictest",), (1.2, 1.2)),
    ("tick, compute time", ("tick",), None, (None, None)),
    ("round trip: ddsperf ping-pong", ("ddsperf_roundtrip",), None, (None, None)),
    ("round trip: pose to force", ("pose_to_force",), None, (None, None)),
    ("  less the wait for the tick", ("pose_to_force_less_wait",), ("ddsperf_roundtrip",), (3.0, None)),
    ("  with phase lock", ("pose_to_force_phase_locked",), None, (None, None)),
    ("pose to field", ("pose_to_field",), None, (None, None)),
    ("pose to force, 1 viewer", ("force_with_viewers", "1"), ("force_with_viewers", "0"), (None, None)),
    ("pose to force, 4 viewers", ("force_with_viewers", "4"), ("force_with_viewers", "0"), (None, None)),
    ("  1 of 4 stopped, 1 slow", ("force_with_viewers", "4_one_stopped"), ("force_with_viewers", "0"), (None, 1.2)),
    ("  less the wait, 4 viewers", ("force_less_wait_with_viewers", "4"), ("force_less_wait_with_viewers", "0"), (None, None)),
    ("  less the wait, so hampered", ("force_less_wait_with_viewers", "4_one_stopped"), ("force_less_wait_with_viewers", "0"),
     (None, 1.2)),
)
LOCKED_LIMIT = 300.0  # us, p50
HEAD = ("time / us", "p50", "p99", "max", "ratio p50", "ratio p99", "")


def at(results, path):
    for key in path:
        results = results[key]
    return results


def _ratio(results, row, key):
    title, path, over, _ = row
    if over is None or at(results, path) is None:
        return None
    return at(results, path)[key] / at(results, over)[key]


def _verdict(results, row):
    """The limits and whether they hold; empty for a row that is not judged."""
    said = []
    for key, limit in zip(("p50", "p99"), row[3]):
        if limit is not None:
            said.append(f"{key} <= {limit:g} x: " + ("held" if _ratio(results, row, key) <= limit else "missed"))
    if row[1] == ("pose_to_force_phase_locked",) and at(results, row[1]) is not None:
        said.append(f"p50 < {LOCKED_LIMIT:g}: " + ("held" if at(results, row[1])["p50"] < LOCKED_LIMIT else "missed"))
    return ", ".join(said)


def cells(results, row):
    found = at(results, row[1])
    if found is None:
        return [row[0], "-", "-", "-", "", "", "not measured"]
    numbers = [f"{found[key]:.1f}" for key in ("p50", "p99", "max")]
    ratios = ["" if _ratio(results, row, key) is None else f"{_ratio(results, row, key):.2f}" for key in ("p50", "p99")]
    return [row[0], *numbers, *ratios, _verdict(results, row)]


def _about(setup):
    cpus = ",".join(str(cpu) for cpu in sorted(setup.tick_cpus))
    return [f"{platform.system()} {platform.release()}, {os.cpu_count()} processors; the tick and cyclictest may use {cpus}; "
            f"load goes to {','.join(str(cpu) for cpu in setup.busy_cpus) or 'none'}",
            f"medians of {setup.alternations} alternations of {setup.seconds:g} s each; the maximum is over all and is not judged",
            f"ddsperf: mean of ping-pongs of {setup.pose_bytes} and {setup.force_bytes} bytes, the sizes of ToolPose and ToolForce, "
            "1000 a second, best effort, " + ("SCHED_FIFO 70" if setup.realtime else "no real-time priority"),
            "pose to force: 991 poses a second, so that all waits for a tick of 1 kHz come up; with phase lock 1000",
            "late ticks in all runs of palpate: " + measure.late_text(setup.late),
            *setup.notes]


def as_text(setup, results):
    lines = _about(setup)
    for state, found in results.items():
        lines += ["", f"== {STATES[state]}"]
        for row in [HEAD, *(cells(found, row) for row in ROWS)]:
            lines.append(f"{row[0]:32} {row[1]:>9} {row[2]:>9} {row[3]:>9} {row[4]:>9} {row[5]:>9}  {row[6]}".rstrip())
    return "\n".join(lines)


def as_markdown(setup, results):
    lines = ["# Latency report", ""] + [f"- {line}" for line in _about(setup)]
    for state, found in results.items():
        lines += ["", f"## {STATES[state][0].upper()}{STATES[state][1:]}", "", "| " + " | ".join(HEAD) + " |",
                  "|---" + "|--:" * 5 + "|---|"]
        lines += ["| " + " | ".join(cell.strip() for cell in cells(found, row)) + " |" for row in ROWS]
    return "\n".join(lines) + "\n"


def _rounded(found):
    if found is None:
        return None
    if "p50" in found:
        return {key: round(found[key], 3) for key in ("p50", "p99")}
    return {key: _rounded(value) for key, value in found.items()}


def as_json(setup, results):
    out = _rounded(results["idle"])
    out["loaded"] = _rounded(results["loaded"]) if "loaded" in results else None
    out["max"] = {state: {row[0].strip(): round(at(found, row[1])["max"], 3) for row in ROWS if at(found, row[1]) is not None}
                  for state, found in results.items()}
    out["about"] = {"alternations": setup.alternations, "seconds": setup.seconds, "pose_bytes": setup.pose_bytes,
                    "force_bytes": setup.force_bytes, "realtime": setup.realtime, "phase_lock": setup.phase_lock,
                    "tick_cpus": sorted(setup.tick_cpus), "busy_cpus": setup.busy_cpus, "late_ticks": setup.late,
                    "notes": setup.notes}
    return json.dumps(out, indent=2) + "\n"


def write_all(setup, results, json_file):
    (setup.out / "report.txt").write_text(as_text(setup, results) + "\n", encoding="utf-8")
    (setup.out / "report.md").write_text(as_markdown(setup, results), encoding="utf-8")
    if json_file is not None:
        json_file.write_text(as_json(setup, results), encoding="utf-8")
