# SPDX-License-Identifier: Apache-2.0
"""tools/fuzz on targets that are wrong: a script in the place of a program, and a small program with libFuzzer in it."""
import contextlib
import importlib.machinery
import importlib.util
import io
import pathlib
import shutil
import subprocess
import sys
import tempfile
import types
import unittest

PROGRAM = pathlib.Path(__file__).resolve().parents[3] / "tools" / "fuzz"

# Unless it is RIGHT, it takes memory for an input that begins with M, and aborts at one that begins with C.
TWIN = """
#include <cstddef>
#include <cstdint>
#include <cstdlib>
volatile char* room;
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
#ifndef RIGHT
  if (size > 0 && data[0] == 'M') { room = new char[300 << 20]; room[0] = 1; delete[] room; }
  if (size > 0 && data[0] == 'C') std::abort();
#endif
  return 0;
}
"""


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        loader = importlib.machinery.SourceFileLoader("fuzz", str(PROGRAM))
        self.fuzz = importlib.util.module_from_spec(importlib.util.spec_from_loader("fuzz", loader))
        loader.exec_module(self.fuzz)
        self.fuzz.ROOT, self.fuzz.SEEDS, self.fuzz.BUILD = self.root, self.root / "seeds", self.root / "build"
        self.fuzz.CRASHES = self.fuzz.BUILD / "crashes"
        self.program = self.fuzz.BUILD / "fuzz" / "twin"
        self.program.parent.mkdir(parents=True)
        self.seeds = self.fuzz.SEEDS / "twin"
        self.seeds.mkdir(parents=True)
        (self.seeds / "good").write_bytes(b"good")

    def run_target(self, seconds=0, runs=0):
        """@return exit code, and what was said"""
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            code = self.fuzz.run("twin", types.SimpleNamespace(seconds=seconds, runs=runs))
        return code, said.getvalue()


class Script(Case):
    def write(self, text):
        self.program.write_text("#!/bin/sh\n" + text, encoding="utf-8")
        self.program.chmod(0o755)

    def test_a_program_that_does_nothing_does_not_pass(self):
        self.write("exit 0")
        for limit in ({"seconds": 1}, {"runs": 9}):
            code, said = self.run_target(**limit)
            self.assertEqual(code, 3)
            self.assertIn("ended after 0 runs", said)

    def test_a_program_that_only_reads_its_corpus_does_not_pass(self):
        self.write("echo '#25 INITED cov: 1 ft: 1'; echo stat::number_of_executed_units: 25")
        code, said = self.run_target(seconds=1)
        self.assertEqual(code, 3)
        self.assertIn("ended after 25 runs, expected more than the inputs it read (25)", said)

    def test_a_program_that_ran_on_passes(self):
        self.write("echo '#25 INITED cov: 1 ft: 1'; echo stat::number_of_executed_units: 26")
        self.assertEqual(self.run_target(seconds=1)[0], 0)

    def test_seconds_are_of_processor_time(self):
        self.write("trap 'echo stat::number_of_executed_units: 3; exit 0' USR1; sleep 1; echo '#2 INITED'; while :; do :; done")
        code, said = self.run_target(seconds=1)
        self.assertEqual(code, 0, said)
        self.assertLess(int(said.split(" runs")[1].split()[0]), 4, said)  # runs in a second of processor time

    def test_names_what_was_written_also_when_it_was_there_before(self):
        self.fuzz.CRASHES.mkdir()
        crash = self.fuzz.CRASHES / "twin-crash-1"
        crash.write_bytes(b"x")
        self.write(f"echo 'Test unit written to {crash.parent}/twin-slow-unit-2'; echo 'Test unit written to {crash}'; exit 77")
        code, said = self.run_target(seconds=1)
        self.assertEqual(code, 1)
        self.assertIn("again: build/fuzz/fuzz/twin build/crashes/twin-crash-1", said)
        self.assertIn("cp build/crashes/twin-crash-1 tests/fuzz/corpus/twin/crash_WHAT", said)
        self.assertNotIn("slow-unit-2\n  as", said)

    def test_leaves_no_temporary_files_of_the_run_before(self):
        self.write("mktemp -d; exit 1")
        for _ in range(2):
            self.run_target(seconds=1)
        self.assertEqual(len(list((self.fuzz.BUILD / "temporary/twin").iterdir())), 1)

    def test_inputs_fit_into_the_corpus(self):
        (self.seeds / "long").write_bytes(bytes(1700))
        self.assertEqual(self.fuzz.longest("twin"), 2048)
        for file in self.seeds.iterdir():
            file.unlink()
        self.assertEqual(self.fuzz.longest("twin"), 128)


@unittest.skipUnless(shutil.which("clang++-22"), "needs clang-22")
class LibFuzzer(Case):
    def build_twin(self, *options):
        source = self.root / "twin.cpp"
        source.write_text(TWIN, encoding="utf-8")
        built = subprocess.run(["clang++-22", "-fsanitize=fuzzer,address", *options, source, "-o", self.program], capture_output=True,
                               text=True, check=False)
        if built.returncode != 0:
            self.skipTest("needs libclang-rt-22-dev: " + built.stderr)

    def test_finds_what_aborts_and_what_takes_memory(self):
        self.build_twin()
        for seed, kind in ((b"C", "crash"), (b"M", "oom")):
            (self.seeds / "bad").write_bytes(seed)
            for _ in range(2):  # the second time the file is there
                code, said = self.run_target(seconds=5)
                self.assertEqual(code, 1, said)
                self.assertIn(f"again: build/fuzz/fuzz/twin build/crashes/twin-{kind}-", said)

    def test_finds_what_no_seed_does(self):
        self.build_twin()
        (self.seeds / "good").write_bytes(b"B")
        self.assertEqual(self.run_target(seconds=60)[0], 1)

    def test_ends_when_its_time_is_over(self):
        self.build_twin("-DRIGHT")
        code, said = self.run_target(seconds=1)
        self.assertEqual(code, 0, said)


class CommandLine(unittest.TestCase):
    def call(self, *words):
        return subprocess.run([sys.executable, "-B", str(PROGRAM), *words], capture_output=True, text=True, check=False)

    def test_refuses_numbers_below_1(self):
        for option in ("--seconds", "--runs", "--keep", "--jobs"):
            done = self.call("stl", option, "0")
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"argument {option}: invalid positive value: '0'", done.stderr)

    def test_refuses_what_is_no_target(self):
        done = self.call("stl", "stll")
        self.assertEqual(done.returncode, 2)
        self.assertIn("stll is no target (--list)", done.stderr)


if __name__ == "__main__":
    unittest.main()
