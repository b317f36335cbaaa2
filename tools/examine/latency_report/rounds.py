# SPDX-License-Identifier: Apache-2.0
"""All measurements in turn, in several rounds, so that other work on the machine disturbs all alike."""
import contextlib
import statistics
import sys

from . import measure, processes
from .viewers import Viewers

VIEWERS = {"0": (0, False), "1": (1, False), "4": (4, False), "4_one_stopped": (4, True)}
LOCKED_RATE = 1000  # Hz: a rate that the tick can lock to
KEYS = ("p50", "p99", "max")


def _force(setup, name):
    viewers = Viewers(setup, *VIEWERS[name])
    try:
        return measure.latency(setup, measure.SWEEP_RATE)
    finally:
        viewers.end()


def _palpate(setup):
    with measure.Server(setup, locked=False):
        watched = {name: _force(setup, name) for name in VIEWERS}
        seen = measure.latency(setup, measure.SWEEP_RATE, fields=True)
    found = dict(watched["0"])
    found["pose_to_field"] = seen["pose_to_field"]
    found["force_with_viewers"] = {name: one["pose_to_force"] for name, one in watched.items()}
    found["force_less_wait_with_viewers"] = {name: one["pose_to_force_less_wait"] for name, one in watched.items()}
    return found


def _locked(setup):
    if not setup.phase_lock:
        return None
    with measure.Server(setup, locked=True):
        return measure.latency(setup, LOCKED_RATE)["pose_to_force"]


def one_round(setup):
    found = {"cyclictest": measure.cyclictest(setup)}
    pings = [measure.ddsperf(setup, size) for size in (setup.pose_bytes, setup.force_bytes)]
    found["ddsperf_roundtrip"] = {key: statistics.mean(ping[key] for ping in pings) for key in KEYS}
    found.update(_palpate(setup))
    found["pose_to_force_phase_locked"] = _locked(setup)
    return found


def middle(all_found):
    """The median of each p50 and p99, the largest max, of dictionaries of the same shape."""
    if all_found[0] is None:
        return None
    if "p50" in all_found[0]:
        return {"p50": statistics.median(one["p50"] for one in all_found), "p99": statistics.median(one["p99"] for one in all_found),
                "max": max(one["max"] for one in all_found)}
    return {key: middle([one[key] for one in all_found]) for key in all_found[0]}


def run_all(setup, alternations, loaded):
    """@return {"idle": ..., "loaded": ...}, medians over the rounds"""
    found = {"idle": [], "loaded": []} if loaded else {"idle": []}
    for turn in range(alternations):
        for name, rounds in found.items():
            print(f"alternation {turn + 1} of {alternations}, {name}", file=sys.stderr, flush=True)
            load = processes.busy(setup.busy_cpus, setup.log("busy")) if name == "loaded" else contextlib.nullcontext()
            with load:
                rounds.append(one_round(setup))
    return {name: middle(rounds) for name, rounds in found.items()}
