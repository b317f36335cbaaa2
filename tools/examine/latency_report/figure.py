# SPDX-License-Identifier: Apache-2.0
"""The report as a picture: p50 and p99 of each row, side by side, by gnuplot."""
import shutil
import subprocess
import sys

from . import tables
from .processes import Failure

_HEAD = """set terminal svg size 900,520 font 'sans,12' background 'white'
set output '{file}'
set style data histograms
set style histogram clustered gap 1.5
set style fill solid 0.8 border -1
set logscale y
set grid ytics
set ylabel 'time / us'
set xtics rotate by -35 scale 0
set key top left
set bmargin 9
$data << END
{data}
END
plot {curves}
"""
_COLOURS = ("#9ecae1", "#3182bd", "#fdbe85", "#e6550d")


def _script(results, file):
    lines = []
    for row in tables.ROWS:
        found = [tables.at(one, row[1]) for one in results.values()]
        if any(one is None for one in found):
            continue
        numbers = " ".join(f"{one[key]:.3f}" for one in found for key in ("p50", "p99"))
        lines.append(f'"{row[0].strip()}" {numbers}')
    names = [f"{tables.STATES[state]}, {key}" for state in results for key in ("p50", "p99")]
    curves = ", ".join(f"$data using {i + 2}{':xtic(1)' if i == 0 else ''} lc rgb '{_COLOURS[i]}' title '{name}'"
                       for i, name in enumerate(names))
    return _HEAD.format(file=file, data="\n".join(lines), curves=curves)


def write(setup, results):
    """Writes report.svg, or one line on standard error when gnuplot is missing."""
    if shutil.which("gnuplot") is None:
        print("no figure: gnuplot is not installed (gnuplot-nox)", file=sys.stderr)
        return
    file = setup.out / "report.svg"
    drawn = subprocess.run(["gnuplot"], input=_script(results, file), capture_output=True, text=True, check=False)
    if drawn.returncode != 0:
        raise Failure(f"gnuplot: {drawn.stderr.strip()}")
    print(f"figure: {file}", file=sys.stderr)
