# SPDX-License-Identifier: Apache-2.0
"""The soak as a table, as JSON, and as a picture by gnuplot."""
import shutil
import statistics
import subprocess
import sys

from latency_report.processes import Failure

from . import judge

WATCHED = ("server", "viewer")
_NAMES = {"memory": "rss", "descriptors": "descriptors", "threads": "threads"}


def verdicts(run):
    """@param[in] run  {"seconds", "samples", "plays", "scenes", "failed", "codes" {process: code or None}}"""
    quiet = [sample for sample in run["samples"] if sample["quiet"]]
    times = [sample["t"] for sample in quiet]
    found = [judge.growth(f"{who} {what}", times, [sample[who][key] for sample in quiet], run["seconds"])
             for who in WATCHED for what, key in _NAMES.items()]
    found += [judge.lives(who, run["codes"][who]) for who in WATCHED]
    found.append(judge.beats([sample["t"] for sample in run["samples"]], [sample["ticks"] for sample in run["samples"]]))
    found.append(judge.nothing_lost(run["plays"]))
    found.append(judge.Verdict("scenes", not run["failed"], run["failed"] or f"{run['scenes']} played"))
    return found


def rows(run, seconds):
    """Figures of each so many seconds. Memory, descriptors and threads: medians of the quiet samples."""
    made = []
    for n in range(max(1, round(run["seconds"] / seconds))):
        last = n == max(1, round(run["seconds"] / seconds)) - 1
        end = float("inf") if last else (n + 1) * seconds
        inside = [sample for sample in run["samples"] if n * seconds <= sample["t"] < end]
        quiet = [sample for sample in inside if sample["quiet"]]
        plays = [play for play in run["plays"] if n * seconds <= play["t"] < end]
        timed = [play for play in plays if "tick_us" in play]
        if not quiet or not timed:
            continue
        row = {"until_s": min(end, run["seconds"]), "scenes": len(timed)}
        for who in WATCHED:
            row[who] = {key: statistics.median(sample[who][key] for sample in quiet) for key in ("rss", "pss", "descriptors", "threads")}
            row[who]["faults"] = sum(inside[-1][who][key] - inside[0][who][key] for key in ("minor_faults", "major_faults"))
        for key in ("pose_to_force_us", "tick_us", "wakeup_us"):
            row[key] = {q: statistics.median(play[key][q] for play in timed) for q in ("p50", "p99")}
            row[key]["max"] = max(play[key]["max"] for play in timed)
        row.update(tick_faults=inside[-1]["tick_faults"] - inside[0]["tick_faults"], ticks=inside[-1]["ticks"] - inside[0]["ticks"],
                   lost_ticks=sum(play["overruns"] for play in timed), lost=sum(play["lost"] for play in plays))
        made.append(row)
    return made


_HEAD = """             server                              viewer                   pose to force, us     tick, us    lost
  until    RSS    PSS  fds thr  faults    RSS    PSS  fds thr    p50    p99     max    p99    max  ticks  answers
"""


def table(run, lines):
    text = _HEAD
    for row in lines:
        s, v, force, tick = row["server"], row["viewer"], row["pose_to_force_us"], row["tick_us"]
        text += (f"{clock(row['until_s'])} {s['rss']:6.1f} {s['pss']:6.1f} {s['descriptors']:4.0f} {s['threads']:3.0f} {s['faults']:7d} "
                 f"{v['rss']:6.1f} {v['pss']:6.1f} {v['descriptors']:4.0f} {v['threads']:3.0f} {force['p50']:6.0f} {force['p99']:6.0f} "
                 f"{force['max']:7.0f} {tick['p99']:6.1f} {tick['max']:6.0f} {row['lost_ticks']:6d} {row['lost']:8d}\n")
    text += ("Memory in MiB, descriptors and threads: medians of the quiet ends of scenes. p50, p99: medians of the scenes. faults: page "
             f"faults of all threads, of the tick {sum(row['tick_faults'] for row in lines)} in all.\n")
    counts = run["counts"]
    text += (f"{run['scenes']} scenes; beside four tools {counts['visitors']} watchers, lists and viewers, {counts['pages']} pages with "
             f"{counts['frames']} frames, {counts['asked']} questions (of them {counts['swaps']} for another organ), of which "
             f"{counts['accepted']} were granted, {counts['wrong']} wrong messages.\n")
    return text


def clock(seconds):
    """h:mm:ss"""
    whole = round(seconds)
    return f"{whole // 3600:d}:{whole // 60 % 60:02d}:{whole % 60:02d}"


_PICTURE = """set terminal svg size 900,800 font 'sans,12' background 'white'
set output '{file}'
set multiplot layout 3,1
set grid
set key left top
set xlabel 'time / min'
$quiet << END
{quiet}
END
$times << END
{times}
END
set ylabel 'memory / MiB'
set yrange [0:*]
plot $quiet using 1:2 with points pt 7 ps 0.4 title 'server, RSS', '' using 1:3 with points pt 7 ps 0.4 title 'PSS', \\
  '' using 1:6 with points pt 7 ps 0.4 title 'viewer, RSS'
set ylabel 'number'
plot $quiet using 1:4 with steps title 'server, descriptors', '' using 1:5 with steps title 'threads', \\
  '' using 1:7 with steps title 'viewer, descriptors', '' using 1:8 with steps title 'threads'
set ylabel 'pose to force / us'
set logscale y
set yrange [*:*]
plot $times using 1:2 with linespoints pt 7 ps 0.4 title 'p50', '' using 1:3 with linespoints pt 7 ps 0.4 title 'p99', \\
  '' using 1:4 with points pt 7 ps 0.4 title 'largest'
"""


def picture(run, file):
    """Writes an SVG, or one line on standard error when gnuplot is missing."""
    if shutil.which("gnuplot") is None:
        print("no figure: gnuplot is not installed (gnuplot-nox)", file=sys.stderr)
        return
    quiet = "\n".join(f"{s['t'] / 60:.4f} {s['server']['rss']:.2f} {s['server']['pss']:.2f} {s['server']['descriptors']} "
                      f"{s['server']['threads']} {s['viewer']['rss']:.2f} {s['viewer']['descriptors']} {s['viewer']['threads']}"
                      for s in run["samples"] if s["quiet"])
    times = "\n".join(f"{p['t'] / 60:.4f} {p['pose_to_force_us']['p50']:.1f} {p['pose_to_force_us']['p99']:.1f} "
                      f"{p['pose_to_force_us']['max']:.1f}" for p in run["plays"] if "pose_to_force_us" in p)
    if not quiet or not times:
        print("no figure: it ended before the first scene did", file=sys.stderr)
        return
    drawn = subprocess.run(["gnuplot"], input=_PICTURE.format(file=file, quiet=quiet, times=times), capture_output=True, text=True,
                           check=False)
    if drawn.returncode != 0:
        raise Failure(f"gnuplot: {drawn.stderr.strip()}")
    print(f"figure: {file}", file=sys.stderr)
