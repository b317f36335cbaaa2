#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What each component installs. The build's folder is in PALPATE_BUILD."""
import base64
import collections
import functools
import gzip
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["PALPATE_BUILD"])
PACKAGES = {"programs": "palpate", "solver": "palpate-solver", "library": "libpalpate-haptic0.1", "haptic": "libpalpate-haptic-dev"}

UNIT = r"m|mm|s|N|Hz|kg|Pa|N/m|N s/m|N/s|m/s|bytes|nodes"
# In brackets, "[0.1 - 5 s]", or behind a comma, "how long to wait, s"; what has no unit says that it is a ratio.
WITH_UNIT = rf"\[([^]]* )?({UNIT})\]|, ({UNIT})(?![\w/'])|\b(relative|coefficient|share|interval|per second)\b"


DEBIAN = unittest.skipUnless(shutil.which("dpkg-query") and (BUILD / "build.ninja").exists(), "needs Debian and Ninja")


def run(*command):
    return subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout


def options_of(help_text):
    """The long options of --help: lines of two spaces, then all names of one option."""
    names = re.findall(r"^  (-\S+)", help_text, re.M)
    return {option for name in names for option in re.findall(r"--[a-z0-9-]+", name)}


def subcommands_of(help_text):
    part = re.search(r"^Subcommands:\n(.*?)(\n\n|\Z)", help_text, re.M | re.S)
    return re.findall(r"^  ([a-z][a-z-]*) ", part.group(1), re.M) if part else []


class Components(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.stage = pathlib.Path(cls.scratch.name)
        for component, package in PACKAGES.items():  # DESTDIR: below the stage whatever the build was configured for
            run("env", f"DESTDIR={cls.stage / package}", "cmake", "--install", BUILD, "--component", component)
        cls.programs = sorted(cls.stage.rglob("bin/*"))

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def files(self, package):
        """Their paths on the machine that they would be installed on."""
        return {"/" + str(path.relative_to(self.stage / package)) for path in (self.stage / package).rglob("*") if not path.is_dir()}

    def file(self, package, ending):
        found = [file for file in self.files(package) if file.endswith(ending)]
        self.assertEqual(len(found), 1, f"{ending}: {found}")
        return found[0]

    def reader(self):
        return self.stage / "palpate" / self.file("palpate", "/libexec/palpate/palpate-read-model")[1:]

    def commands(self):
        """(program, words after it, --help) of each program and subcommand."""
        for program in self.programs:
            text = run(program, "--help")
            yield program, [], text
            for subcommand in subcommands_of(text):
                yield program, [subcommand], run(program, subcommand, "--help")

    def test_scripts_for_slurm_are_installed(self):
        for name in ("solve.sbatch", "batch.sbatch"):
            installed = self.file("palpate-solver", f"/share/doc/palpate-solver/examples/{name}")
            self.assertEqual((self.stage / "palpate-solver" / installed[1:]).read_text(), (ROOT / "tools/make/solve/slurm" / name).read_text())

    def test_programs_of_the_readme_are_installed(self):
        table = (ROOT / "README.md").read_text().split("## The programs")[1].split("<!-- samples")[0]
        named = set(re.findall(r"`(palpate-[a-z]+)`", table)) - {"palpate-bench"}  # built for developers only
        self.assertEqual({path.name for path in self.programs}, named)

    def test_no_file_is_in_two_components(self):
        count = collections.Counter(file for package in PACKAGES.values() for file in self.files(package))
        self.assertEqual([file for file, n in count.items() if n > 1], [])

    def test_the_solver_is_what_links_gpl_libraries(self):
        for program in self.programs:
            with self.subTest(program=program.name):
                gpl = re.search("gmsh|cholmod|umfpack", run("ldd", program)) is not None
                self.assertEqual(gpl, program.is_relative_to(self.stage / "palpate-solver"))

    def test_model_is_parsed_by_the_program_that_is_installed_for_it(self):
        with tempfile.TemporaryDirectory() as folder:
            model = pathlib.Path(folder, "model.h5")
            model.write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(64))
            inspect = [self.stage / "palpate" / self.file("palpate", "/bin/palpate-inspect")[1:], model]
            said = subprocess.run(inspect, capture_output=True, text=True)
            self.assertIn("the file is truncated or damaged", said.stderr)
            reader = self.reader()
            kept = reader.rename(reader.with_suffix(".kept"))
            said = subprocess.run(inspect, capture_output=True, text=True)
            kept.rename(reader)
            self.assertIn(f"no process can be started to parse it, {reader}: No such file or directory", said.stderr)

    def test_library_is_apart_from_its_headers(self):
        self.file("libpalpate-haptic0.1", "/libpalpate_haptic.so.0.1.0")
        self.assertFalse(any(file.endswith(".h") for file in self.files("libpalpate-haptic0.1")))
        for ending in ("/palpate_haptic.h", "/haptic_tool.h", "/palpate_haptic_flags.h", "/libpalpate_haptic.so", "/palpate-haptic.pc",
                       "/palpateConfig.cmake", "/driver_template/CMakeLists.txt", "/driver_template/driver.cpp", "/palpate.idl"):
            self.file("libpalpate-haptic-dev", ending)

    def test_unit_starts_what_is_installed_as_its_own_user(self):
        self.file("palpate", "/lib/udev/rules.d/60-palpate-cpu-latency.rules")
        unit = (self.stage / "palpate" / self.file("palpate", "/lib/systemd/system/palpate-server.service")[1:]).read_text()
        command = re.search(r"^ExecStart=(\S+) --config (\S+)", unit, re.M)
        self.assertEqual(command.group(1), self.file("palpate", "/bin/palpate-server"))
        self.assertEqual(command.group(2), self.file("palpate", "/palpate/server.toml"))
        for line in ("User=palpate", "LimitRTPRIO=90", "LimitMEMLOCK=infinity", "ProtectSystem=strict", "NoNewPrivileges=yes"):
            self.assertRegex(unit, f"(?m)^{line}$")
        for settings in (ROOT / "tools/packaging/palpate/conffiles").read_text().split():
            self.file("palpate", settings)

    def test_unit_has_the_prefix_that_is_chosen_at_the_installation(self):
        with tempfile.TemporaryDirectory() as stage:
            run("env", f"DESTDIR={stage}", "cmake", "--install", BUILD, "--component", "programs", "--prefix", "/opt/organ")
            unit = pathlib.Path(stage + "/opt/organ/lib/systemd/system/palpate-server.service").read_text()
            command = re.search(r"^ExecStart=(\S+) --config (\S+)", unit, re.M)
            self.assertEqual(command.group(1), "/opt/organ/bin/palpate-server")
            for path in command.groups():
                self.assertTrue(pathlib.Path(stage + path).is_file(), path)
            # --help names the file beside the program that runs
            self.assertIn(command.group(2), "".join(run(stage + "/opt/organ/bin/palpate-server", "--help").split()))

    @unittest.skipUnless(shutil.which("help2man"), "no man pages without help2man")
    def test_man_pages_hold_every_option(self):
        for program, words, text in self.commands():
            with self.subTest(program=program.name, words=words):
                page = program.parents[1] / "share/man/man1" / ("-".join([program.name] + words) + ".1.gz")
                page = gzip.decompress(page.read_bytes()).decode().replace("\\-", "-")
                self.assertRegex(page, r"(?m)^\.SH NAME\n" + "-".join([program.name] + words) + " - .{20}")
                self.assertLessEqual(options_of(text), set(re.findall(r"--[a-z0-9-]+", page)))

    def test_help_ends_with_an_example_and_the_exit_codes(self):
        for program, words, text in self.commands():
            with self.subTest(program=program.name, words=words):
                self.assertRegex(text, r"\nExit codes: 0 done, 1 failed, 2 [^\n]*, 3 [^\n]*\n*\Z")
                self.assertRegex(text, r"\nExample: " + " ".join([program.name, *words]) + r"[^\n]*\n")

    def test_help_of_a_number_has_its_unit_and_its_default(self):
        for program, words, text in self.commands():
            for option in re.split(r"\n(?=  -)", text)[1:]:
                option = " ".join(option.split("\n\n")[0].split())
                if " FLOAT" not in option:
                    continue
                with self.subTest(program=program.name, words=words, option=option):
                    self.assertRegex(option, WITH_UNIT)
                    self.assertRegex(option, r"=\S|default|leave out|what a client|writes no certificate|new value")

    def test_completion_lists_every_option(self):
        for program, words, text in self.commands():
            with self.subTest(program=program.name, words=words):
                script = program.parents[1] / "share/bash-completion/completions" / program.name
                offered = self.completed(script, program, [*words, "--"])
                self.assertEqual(offered, options_of(text))
                self.assertIn("--help", offered)
                if not words and subcommands_of(text):
                    self.assertEqual(self.completed(script, program, [""]), set(subcommands_of(text)))
                self.assertRegex(run("bash", "-c", f"source {script}; complete -p {program.name}"), "_palpate")

    def completed(self, script, program, words):
        return set(run("bash", "-c", 'source "$1"; COMP_WORDS=("${@:2}"); COMP_CWORD=$(($# - 2)); _palpate "$2"; '
                       'printf "%s\\n" "${COMPREPLY[@]}"', "-", script, program, *words).split())

    @classmethod
    @functools.cache
    def bill(cls):
        return json.loads(run(sys.executable, ROOT / "tools/packaging/sbom.py", cls.stage, BUILD, "1.2.3"))

    @DEBIAN
    def test_bill_of_materials_names_what_is_linked(self):
        bill = self.bill()
        self.assertEqual(bill["spdxVersion"], "SPDX-2.3")
        things = bill["packages"] + bill["files"]
        names = {thing["SPDXID"]: thing.get("fileName", thing.get("name")) for thing in things} | {"SPDXRef-DOCUMENT": "document"}
        self.assertEqual(len(names), len(things) + 1)
        linked = collections.defaultdict(set)
        for relation in bill["relationships"]:
            one, other = names[relation["spdxElementId"]], names[relation["relatedSpdxElement"]]
            if relation["relationshipType"] == "DYNAMIC_LINK":
                linked[one].add(other)
        of = {path.name: linked["./" + str(path.relative_to(self.stage / package))]
              for package in PACKAGES.values() for path in self.programs if path.is_relative_to(self.stage / package)}
        self.assertEqual(len(of), len(self.programs))
        self.assertLessEqual({"libddsc0debian", "libc6"}, of["palpate-server"])
        self.assertNotIn("libhdf5-103-1", of["palpate-server"])
        self.assertLessEqual({"libhdf5-103-1", "libseccomp2"}, linked["./" + str(self.reader().relative_to(self.stage / "palpate"))])
        self.assertFalse(any("gmsh" in name or "cholmod" in name for name in of["palpate-server"]))
        self.assertIn("libcholmod3", of["palpate-solve"])
        self.assertLessEqual({"libcli11-dev", "libeigen3-dev", "three", *PACKAGES.values()}, set(names.values()))
        sums = {entry["checksumValue"] for file in bill["files"] for entry in file["checksums"]}
        for program in self.programs:
            self.assertIn(hashlib.sha256(program.read_bytes()).hexdigest(), sums)

    @DEBIAN
    def test_bill_of_materials_has_each_library_that_the_loader_finds(self):
        names = {thing["name"] for thing in self.bill()["packages"]}
        libraries = {os.path.realpath(file) for program in self.programs if program.read_bytes()[:4] == b"\x7fELF"
                     for file in re.findall(r"=> (/\S+)", run("ldd", program))}
        for library in sorted(library for library in libraries if not library.startswith((str(BUILD), str(self.stage)))):
            owner = subprocess.run(["dpkg-query", "--search", f"*{library.removeprefix('/usr')}"], capture_output=True, text=True)
            self.assertIn(owner.stdout.split(":")[0], names, library)

    @DEBIAN
    def test_bill_of_materials_states_each_licence(self):
        bill = self.bill()
        texts = {entry["licenseId"]: entry["extractedText"] for entry in bill["hasExtractedLicensingInfos"]}
        self.assertTrue(all(len(text) > 100 for text in texts.values()))
        stated = {thing["name"]: thing["licenseDeclared"] for thing in bill["packages"]}
        for name, licence in stated.items():
            for part in re.split(r" (?:AND|OR|WITH) ", licence):
                if part.startswith("LicenseRef-"):
                    self.assertIn(part, texts, name)
                else:
                    self.assertRegex(part, r"^[A-Za-z0-9.+-]+$", name)
                    self.assertNotIn(part, ("NOASSERTION", "NONE"), name)
        self.assertEqual(stated["libtomlplusplus3"], "MIT")
        self.assertIn("GPL-2", texts[stated["libcholmod3"]])  # its supernodal part, though most of the sources are LGPL
        self.assertIn("GCC RUNTIME LIBRARY EXCEPTION", texts[stated["libgcc-s1"]].upper())

    def named(self, kind):
        """Pairs of names in a relation."""
        bill = self.bill()
        names = {thing["SPDXID"]: thing["name"] for thing in bill["packages"]}
        return {(names.get(relation["spdxElementId"]), names.get(relation["relatedSpdxElement"]))
                for relation in bill["relationships"] if relation["relationshipType"] == kind}

    @DEBIAN
    def test_bill_of_materials_has_what_builds_and_what_the_page_is_linked_with(self):
        self.assertLessEqual({("cmake", "palpate"), ("ninja-build", "palpate"), ("g++-12", "palpate")}, self.named("BUILD_TOOL_OF"))
        page = any(self.stage.rglob("*.wasm"))
        self.assertEqual(page, {("palpate", "musl"), ("palpate", "libc++")} <= self.named("STATIC_LINK"))

    @DEBIAN
    def test_bill_of_materials_has_the_checksums_that_npm_compares(self):
        lock = json.loads((ROOT / "clients/viewer/web/package-lock.json").read_text())["packages"]
        sums = {(thing["name"], thing["versionInfo"]): thing["checksums"][0]["checksumValue"]
                for thing in self.bill()["packages"] if "checksums" in thing}
        for path, entry in lock.items():
            if not path:
                continue
            name = path.rpartition("node_modules/")[2]
            self.assertRegex(entry["integrity"], r"^sha512-[A-Za-z0-9+/]{86}==$", name)
            if (found := sums.get((name, entry["version"]))) is not None:
                self.assertEqual(found, base64.b64decode(entry["integrity"].removeprefix("sha512-")).hex())
        if (ROOT / "clients/viewer/web/node_modules").exists():
            self.assertLessEqual({"three", "jsfive", "pako", "@noble/hashes", "vite", "typescript"}, {name for name, _ in sums})


if __name__ == "__main__":
    unittest.main()
