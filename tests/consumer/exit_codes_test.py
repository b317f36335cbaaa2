#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A command line that cannot be used ends every program with exit code 2 and one line that names the option. The build's
folder is in PALPATE_BUILD."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = pathlib.Path(os.environ["PALPATE_BUILD"]) / "bin"

# A tetrahedron of 0.1 m; facing outward.
STL = "solid t\n" + "".join(
    "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in corners) + "endloop\nendfacet\n"
    for corners in ([(0, 0, 0), (0, 0.1, 0), (0.1, 0, 0)], [(0, 0, 0), (0.1, 0, 0), (0, 0, 0.1)],
                    [(0, 0, 0), (0, 0, 0.1), (0, 0.1, 0)], [(0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)])) + "endsolid t\n"
MESH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 0.1 0 0
3 0 0.1 0
4 0 0 0.1
$EndNodes
$Elements
1
1 4 2 1 1 1 2 3 4
$EndElements
"""
CASE = "[mesh]\nfile = 'a.msh'\n[model]\nmodes = 20\n"

# (the words of a command line of which one value is wrong, what the line on standard error names)
IMPORT = ["palpate-organ", "import", "-o", "o.msh"]
WRONG = [
    (["palpate-organ", "liver", "-o", "o.msh", "--element-size", "8"], "--element-size"),
    (["palpate-organ", "liver", "-o", "o.msh", "--inner-size", "0.001"], "--inner-size"),
    (["palpate-organ", "paper-liver", "-o", "o.msh", "--element-size", "0.1"], "--element-size"),
    (["palpate-organ", "paper-liver", "-o", "o.msh", "--element-order", "3"], "--element-order"),
    (["palpate-organ", "beam", "-o", "none/o.msh"], "--output"),
    ([*IMPORT, "a.stl", "--fixed", "nonsense"], "--fixed nonsense"),
    ([*IMPORT, "a.stl", "--fixed", "group:rim"], "--fixed group:rim"),
    ([*IMPORT, "a.msh", "--fixed", "box:5,5,5,6,6,6"], "--fixed"),
    ([*IMPORT, "a.msh", "--fixed", "lowest-z:0.99999"], "--fixed"),
    ([*IMPORT, "a.stl", "--scale", "0"], "--scale"),
    ([*IMPORT, "a.stl", "--scale", "2", "--unit", "mm"], "--unit and --scale"),
    ([*IMPORT, "a.stl", "--unit", "inch"], "--unit"),
    ([*IMPORT, "a.stl", "--part", "9"], "--part 9"),
    ([*IMPORT, "a.stl", "--element-size", "8"], "--element-size"),
    ([*IMPORT, "a.stl", "--element-size", "1e-5"], "--max-nodes"),
    ([*IMPORT, "a.stl", "--growth", "9"], "--growth"),
    ([*IMPORT, "a.stl", "--dry-run", "--picture", "none/p.svg"], "--picture"),
    ([*IMPORT, "a.msh", "--repair"], "--repair"),
    ([*IMPORT, "a.msh", "--part", "1"], "--part"),
    ([*IMPORT, "a.msh", "--element-size", "0.01"], "--element-size"),
    ([*IMPORT, "a.msh", "--fixed", "group:rim"], "--fixed group:rim"),
    (["palpate-solve", "a.msh", "--method", "foo"], "--method"),
    (["palpate-solve", "a.msh", "--law", "foo"], "--law"),
    (["palpate-solve", "a.msh", "--target", "phone"], "--target phone"),
    (["palpate-solve", "a.msh", "--order", "3", "--travel", "0.004"], "--travel"),
    (["palpate-solve", "a.msh", "--modes", "20", "--field-error", "0.1"], "--field-error"),
    (["palpate-solve", "a.msh", "--load-direction", "up"], "--load-direction up"),
    (["palpate-solve", "a.msh", "--load", "1"], "load.magnitude"),
    (["palpate-solve", "case.toml", "--size-limit", "1e7"], "target.size_limit"),
    (["palpate-solve", "a.msh", "--method", "series-force", "--dry-run"], "--dry-run"),
    (["palpate-solve", "a.msh", "-o", "none/x.h5"], "--output"),
    (["palpate-solve", "a.msh", "-o", "x.xdmf"], "--output"),
    (["palpate-solve", "a.msh", "--template", "-o", "a.msh"], "would replace the input"),
    (["palpate-solve", "--template", "-o", "none/case.toml"], "--output"),
    (["palpate-solve", "a.msh", "--scratch", "none"], "--scratch"),
    (["palpate-solve", "--batch", ".", "--worker", "3/2"], "--worker 3/2"),
    (["palpate-solve", "a.msh", "--worker", "1/2"], "--worker"),
    (["palpate-solve", "--batch", ".", "-o", "a.msh"], "--output"),
    (["palpate-solve", "--batch", ".", "--travel", "0.004", "--order", "3"], "--travel"),
    (["palpate-query", "none.h5", "--node", "1"], "--displacement"),
    (["palpate-query", "none.h5", "--node", "1", "--displacement", "1,2"], "--displacement"),
    (["palpate-query", "none.h5", "--node", "1", "--force", "up"], "--force"),
    (["palpate-query", "none.h5", "--node", "1", "--force", "0,0,1e200"], "--force"),
    (["palpate-query", "none.h5", "--node", "1", "--load-level", "nan"], "--load-level"),
    (["palpate-query", "none.h5", "--at", "here", "--displacement", "0,0,0"], "--at"),
    (["palpate-query", "none.h5", "--at", "0,0,0", "--displacement", "0,0,0", "--unit", "inch"], "--unit"),
    (["palpate-query", "none.h5", "--node", "1", "--force", "0,0,1", "--tool2", "2:0,0,0"], "--tool2"),
    (["palpate-query", "none.h5", "--node", "1", "--displacement", "0,0,1", "--tool2", "2:0,0"], "--tool2"),
    (["palpate-query", "none.h5", "--node", "1", "--displacement", "0,0,1", "--tool2", "2:0,0,0", "--ccx", "c.inp"], "--ccx"),
    (["palpate-query", "none.h5", "--node", "1", "--displacement", "0,0,1", "--field", "none/f.vtu"], "--field"),
    (["palpate-query", "none.h5", "--batch", "t.csv", "-o", "none/a.csv"], "-o"),
    (["palpate-query", "none.h5", "--batch", "t.csv", "--newton"], "--batch"),
    (["palpate-certify", "none.h5", "--seed", "-1"], "--seed"),
    (["palpate-certify", "none.h5", "--plot", "none/p.svg"], "--plot"),
    (["palpate-inspect", "a.h5", "b.h5"], "b.h5"),
    (["palpate-fit", "--model", "none.h5", "--measured", "m.csv", "--at", "0,0"], "--at"),
    (["palpate-fit", "--model", "none.h5", "--measured", "m.csv", "--node", "1", "--deepest", "nan"], "--deepest"),
    (["palpate-fit", "--model", "none.h5", "--measured", "m.csv", "--node", "1", "--plot", "none/p.svg"], "--plot"),
    (["palpate-feel", "contrast", "a.h5", "b.h5", "--map", "map.png"], "--map"),
    (["palpate-bench", "--cpu", "1000000"], "--cpu"),
    (["palpate-reproduce", "arm"], "arm"),
    (["palpate-reproduce", "rod", "--rod-elements", "0"], "--rod-elements"),
    (["palpate-server", "--model", "none.h5", "--device", "phone"], "phone"),
    (["palpate-server", "--model", "none.h5", "--json"], "--json"),
    (["palpate-replay", "none.rec"], "--model"),
    (["palpate-tool", "--script", "dance"], "--script"),
    (["palpate-tool", "--at", "0,0"], "--at"),
    (["palpate-device", "--hand", "1,2"], "--hand"),
    (["palpate-device", "--plot", "none/p.svg"], "--plot"),
    (["palpate-latency", "--assert", "nonsense"], "--assert"),
    (["palpate-latency", "--tool", "2", "--tools", "3"], "--tools"),
    (["palpate-viewer", "--listen", "nowhere"], "--listen"),
    (["palpate-viewer", "--token-file", "none"], "--token-file"),
    (["palpate-viewer", "--page", "none"], "--page"),
    (["palpate-watch", "--vtk", "surface.png"], "--vtk"),
    (["palpate-parameters", "--tool", "7"], "--tool"),
    (["palpate-list", "--timeout", "0"], "--timeout"),
    (["palpate-security", "issue", "king", "desk"], "role"),
]


def run(words, folder):
    return subprocess.run([PROGRAMS / words[0], *words[1:]], cwd=folder, capture_output=True, text=True, timeout=60, check=False)


def numbers_of(help_text):
    """The options of --help that take a number."""
    return re.findall(r"^  (?:-\w,)?(--[a-z0-9-]+) (?:FLOAT|INT|UINT)\b", help_text, re.M)


class ExitCodes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        for name, text in {"a.stl": STL, "a.msh": MESH, "case.toml": CASE}.items():
            (cls.folder / name).write_text(text)
        table = (ROOT / "README.md").read_text().split("## The programs")[1].split("<!-- samples")[0]
        cls.programs = sorted(set(re.findall(r"`(palpate-[a-z]+)`", table)))

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def refuses(self, words, name):
        with self.subTest(" ".join(words)):
            result = run(words, self.folder)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertRegex(result.stderr, rf"\A{words[0]}: [^\n]*\n\Z")
            self.assertIn(name, result.stderr)
            self.assertEqual(result.stdout, "")

    def test_every_program_is_in_the_table(self):
        self.assertEqual(sorted({words[0] for words, _ in WRONG}), self.programs)

    def test_a_wrong_value_ends_with_2(self):
        before = sorted(self.folder.iterdir())
        for words, name in WRONG:
            self.refuses(words, name)
        self.assertEqual(sorted(self.folder.iterdir()), before)

    def test_a_word_in_the_place_of_a_number_ends_with_2(self):
        for program in self.programs:
            text = run([program, "--help"], self.folder).stdout
            commands = re.findall(r"^  ([a-z][a-z-]*) ", text.split("\nSubcommands:\n")[1], re.M) if "\nSubcommands:\n" in text else []
            for words in [[program], *([program, command] for command in commands)]:
                for option in numbers_of(run([*words, "--help"], self.folder).stdout):
                    self.refuses([*words, option, "many"], option)

    def test_a_file_that_is_not_there_ends_with_1(self):
        for words in (["palpate-solve", "none.msh"], ["palpate-solve", "--batch", "none"], ["palpate-inspect", "none.h5"], [*IMPORT, "none.stl"],
                      ["palpate-query", "none.h5", "--node", "1", "--displacement", "0,0,0"]):
            with self.subTest(" ".join(words)):
                self.assertEqual(run(words, self.folder).returncode, 1)


if __name__ == "__main__":
    unittest.main()
