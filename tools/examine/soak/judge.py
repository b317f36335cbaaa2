# SPDX-License-Identifier: Apache-2.0
"""Whether something grows, stops or gets lost: by the series that a soak has taken."""
import statistics
from dataclasses import dataclass

WARM_UP = 0.2        # part of the run that is not judged,
SHORT_WARM_UP = 0.4  # but of a short run up to this part, until there was
LEAST_WARM_UP = 60.0  # s, in which caches, thread stacks and the allocator's arenas fill
FEWEST = 6           # values that a line is laid through
SHORTEST = 0.2       # part of the run that they span
MOST = 300           # of more values, medians of neighbours are taken: the slopes of all pairs are computed


@dataclass(frozen=True)
class Allowance:
    """What a series may grow by in a run that is judged for `hours`: least + per_hour * hours."""
    least: float
    per_hour: float
    unit: str

    def of(self, hours):
        return self.least + self.per_hour * hours


# The least covers what is had once and late (an arena of the allocator, a socket); a leak grows with the hours.
ALLOWED = {"memory": Allowance(2.0, 0.5, "MiB"), "descriptors": Allowance(1.5, 0.0, ""), "threads": Allowance(1.5, 0.0, "")}


@dataclass(frozen=True)
class Verdict:
    what: str
    holds: bool
    said: str


def warm_up(seconds):
    """How much of a run of so many seconds is not judged, s."""
    return max(WARM_UP * seconds, min(LEAST_WARM_UP, SHORT_WARM_UP * seconds))


def thinned(times, values):
    """At most MOST pairs: medians of neighbours."""
    size = -(-len(times) // MOST) or 1
    blocks = range(0, len(times), size)
    return ([statistics.median(times[i:i + size]) for i in blocks], [statistics.median(values[i:i + size]) for i in blocks])


def slope(times, values):
    """Theil and Sen's: the median of the slopes between all pairs. Up to 29 % of the values may be anything.
    @return units of `values` per s; None with fewer than FEWEST values at different times"""
    times, values = thinned(times, values)
    if len(set(times)) < FEWEST:
        return None
    return statistics.median((values[j] - values[i]) / (times[j] - times[i])
                             for i in range(len(times)) for j in range(i + 1, len(times)) if times[j] != times[i])


def growth(what, times, values, seconds):
    """Whether a series grew by more than ALLOWED[what] after the warm-up, along its robust line.
    @param[in] what  process and figure, as in "server memory"; @param[in] times  of `values`, s from the beginning
    @param[in] seconds  length of the run"""
    begin = warm_up(seconds)
    judged = [(t, value) for t, value in zip(times, values) if t >= begin]
    steep = slope([t for t, _ in judged], [value for _, value in judged])
    span = judged[-1][0] - judged[0][0] if judged else 0.0
    if steep is None or span < SHORTEST * seconds:
        return Verdict(what, False, f"{len(judged)} values over {span:.0f} s after a warm-up of {begin:.0f} s: too few to judge, run longer")
    hours = span / 3600.0
    allowed = ALLOWED[what.split()[-1]]
    grown = steep * 3600.0 * hours
    unit = f" {allowed.unit}" if allowed.unit else ""
    said = (f"{grown:+.2f}{unit} in {60.0 * hours:.1f} min after a warm-up of {begin:.0f} s, "
            f"{allowed.of(hours):.2f}{unit} allowed ({steep * 3600.0:+.2f}{unit} per hour)")
    return Verdict(what, grown <= allowed.of(hours), said)


def lives(what, code):
    """@param[in] code  how the process ended before it was asked to; None: it did not"""
    return Verdict(what, code is None, "ran to the end" if code is None else f"ended early, with code {code}")


def beats(times, ticks):
    """Whether a thread went on: between neighbours of these samples it woke. @param[in] ticks  wake-ups since its start"""
    still = [(t0, t1) for t0, t1, a, b in zip(times, times[1:], ticks, ticks[1:]) if b <= a]
    if len(times) < 2:
        return Verdict("tick", False, "it was not seen")
    if still:
        return Verdict("tick", False, f"stood still from {still[0][0]:.1f} to {still[0][1]:.1f} s, and {len(still) - 1} times more")
    woke, passed = ticks[-1] - ticks[0], times[-1] - times[0]
    return Verdict("tick", True, f"woke {woke} times in {passed:.0f} s, {woke / passed:.1f} times per s")


def nothing_lost(plays):
    """@param[in] plays  {"who", "lost", "failed"} of each time that a tool played to its end; with "stalled" true its poses came
    too late to behave, or somebody else's may have, and it is not judged"""
    judged = [play for play in plays if not play.get("stalled")]
    stalled = [play for play in plays if play.get("stalled")]
    lost = [f"{play['who']} lost {play['lost']}" for play in judged if play["lost"]]
    failed = [f"{play['who']}: {play['failed']}" for play in judged if play["failed"]]
    left_out = (f"; {len(stalled)} more in scenes that stood still for 50 ms lost {sum(play['lost'] for play in stalled)}: not judged"
                if stalled else "")
    if not judged:
        return Verdict("answers", False, "no tool played to its end without standing still")
    if lost or failed:
        return Verdict("answers", False, "; ".join((lost + failed)[:4]) + f" ({len(lost) + len(failed)} of {len(plays)} plays){left_out}")
    return Verdict("answers", True, f"none lost in {len(judged)} plays of tools{left_out}")
