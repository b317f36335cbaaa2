# SPDX-License-Identifier: Apache-2.0
"""tools/check_docs on small repositories: one that is right, and for each kind of finding one that is wrong."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = ROOT / "tools" / "check_docs"

# Citations are put together here, since the checker reads this file too.
DOCS = "docs" + "/"
GUIDE = "DESIGN" + " 3.2"

README = """# Organ

Read [the design](docs/design.md#series), [that heading](#the-picture-of-link-lines), [twice](docs/design.md#parts-1).
![A picture](docs/page.png) and [the folder](core/), [elsewhere](https://example.org/none#no).
The reader is `core/src/reader.cpp`, run `build/bin/organ core/src`; all of `core/*/reader.cpp`.

## The picture of link lines

<!-- link lines: tools/check_docs compares them with CMake -->
```text
server  ──► core  idl
tools   ──► core  server/record
server/record
```

```sh
cat [no link](none.md) docs-of-others
```
"""
ROOMS = """
<!-- rooms: tools/check_docs compares them with the tree and the includes -->

| folder | what it owns | may see |
|---|---|---|
| core/base | numbers | nothing |
| core | reading | nothing |
| core/tick | one tick | core/base |
| server | answers | core/tick |

| another | table | here |
|---|---|---|
"""
DESIGN = "# Design\n\n## Series\n\n## Parts\n\n## Parts\n\n## Wire and latency\n" + ROOMS
SOURCE = f"// The series ({DOCS}design.md, Series, Parts) and its record, as {DOCS}design.md,\n// Series says. {DOCS}design.md, Wire and\n/// latency, Series.\n"
FILES = {
    "README.md": README,
    "docs/design.md": DESIGN,
    "docs/page.png": "\0",
    ".gitignore": "build/\n",
    "CMakeLists.txt": "add_library(options INTERFACE)\n",
    "core/CMakeLists.txt": "add_library(organ_core src/reader.cpp)\n",
    "core/src/reader.cpp": SOURCE,
    "core/base/number.h": "#pragma once\n#include <vector>\n",
    "core/tick/tick.h": '#pragma once\n#include "core/base/number.h"\n',
    "core/tick/tick.cpp": '#include "core/tick/tick.h"\n\n#include "organ/made_list.h"\n',
    "server/include/organ/answer.h": "#pragma once\n",
    "server/src/answer.cpp": '#include "organ/answer.h"\n\n#include "core/tick/tick.h"\n#include "local.h"\n',
    "server/src/local.h": "#pragma once\n",
    "idl/CMakeLists.txt": "add_library(organ_idl STATIC a.c)\nadd_library(organ::idl ALIAS organ_idl)\n",
    "server/CMakeLists.txt": "add_executable(organ-server main.cpp)\n"
    "target_link_libraries(organ-server # idl\n  PRIVATE organ::idl PUBLIC organ_core options)\n",
    "server/record/CMakeLists.txt": "add_library(organ_record a.cpp)\n",
    "tools/CMakeLists.txt": "add_library(solve s.cpp)\nset(LIBS organ_record)\n"
    "target_link_libraries(solve PUBLIC ${LIBS} $<$<CONFIG:Debug>:x> $<BUILD_INTERFACE:organ_core>)\n",
    "tests/CMakeLists.txt": "add_executable(t t.cpp)\ntarget_link_libraries(t PRIVATE solve organ_core)\n",
}


def check_files(changes, *arguments):
    """Runs the checker on FILES with changes, {path: text, None to leave it out}. @return (exit code, lines)"""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in {**FILES, **changes}.items():
            if text is not None:
                path = pathlib.Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
        subprocess.run(["git", "init", "-q", folder], check=True)
        subprocess.run(["git", "-C", folder, "add", "-A"], check=True)
        result = subprocess.run([sys.executable, "-B", str(PROGRAM), "--root", folder, *arguments],
                                capture_output=True, text=True, check=False)
        return result.returncode, (result.stdout + result.stderr).splitlines()


class CheckDocs(unittest.TestCase):
    def expect_finding(self, changes, *beginnings):
        """Exactly these findings, by how their lines begin."""
        code, lines = check_files(changes)
        self.assertEqual(code, 1, lines)
        self.assertEqual(len(lines), len(beginnings) + 1, lines)
        for line, beginning in zip(lines, beginnings):
            self.assertTrue(line.startswith(beginning), f"{line!r} does not begin with {beginning!r}")
        self.assertTrue(lines[-1].endswith(f"{len(beginnings)} findings"), lines)

    def test_a_tree_that_is_right_passes(self):
        code, lines = check_files({})
        self.assertEqual((code, len(lines)), (0, 1), lines)
        self.assertTrue(lines[0].endswith(" 0 findings"), lines)

    def test_finds_a_link_to_no_file(self):
        self.expect_finding({"core/a.md": "\n[there](none.md)\n"}, "core/a.md:2: link to none.md: git tracks no core/none.md")

    def test_finds_an_image_that_is_not_tracked(self):
        self.expect_finding({"core/a.md": "![p](../build/page.png)\n", "build/page.png": "x"},
                            "core/a.md:1: link to ../build/page.png")

    def test_finds_a_link_out_of_the_repository(self):
        self.expect_finding({"core/a.md": "[there](../../other.md)\n"}, "core/a.md:1: link to ../../other.md")

    def test_finds_a_reference_to_no_file(self):
        self.expect_finding({"core/a.md": "[x]\n\n[x]: none.md\n"}, "core/a.md:3: link to none.md")

    def test_finds_an_anchor_without_heading(self):
        self.expect_finding({"core/a.md": "[there](../docs/design.md#seriess)\n[here](#a)\n# B\n"},
                            "core/a.md:1: link to ../docs/design.md#seriess: docs/design.md has no heading #seriess",
                            "core/a.md:2: link to #a: core/a.md has no heading #a")

    def test_finds_a_citation_of_no_file(self):
        self.expect_finding({"core/a.h": f"\n/// see {DOCS}none.md\n", "core/b.ts": f"// {DOCS}decisions/none.md\n"},
                            f"core/a.h:2: cites {DOCS}none.md", f"core/b.ts:1: cites {DOCS}decisions/none.md")

    def test_finds_a_citation_of_no_heading(self):
        self.expect_finding({"core/a.h": f"/// {DOCS}design.md, Series,\n/// Threads\n"},
                            f"core/a.h:2: cites {DOCS}design.md, Threads")
        self.expect_finding({"core/a.h": f"/// {DOCS}design.md, Wire\n"}, f"core/a.h:1: cites {DOCS}design.md, Wire")

    def test_placeholders_are_no_citations(self):
        code, lines = check_files({"core/a.md": f"Cite {DOCS}NAME.md or {DOCS}design.md, Heading.\n"})
        self.assertEqual(code, 0, lines)

    def test_finds_a_citation_of_what_is_outside(self):
        self.expect_finding({"core/a.cmake": f"# as {GUIDE} says\n"}, "core/a.cmake:1: cites DESIGN")

    def test_finds_a_readme_of_more_than_120_lines(self):
        self.expect_finding({"core/README.md": "x\n" * 121}, "core/README.md:121: 121 lines")
        self.assertEqual(check_files({"core/README.md": "x\n" * 120, "core/LONG.md": "x\n" * 300})[0], 0)

    def test_finds_a_path_in_backticks_that_is_not_there(self):
        self.expect_finding({"core/README.md": "`src/reader.cpp` `organ core/src/none.cpp` `core/*/none.cpp`\n"},
                            "core/README.md:1: `core/*/none.cpp`", "core/README.md:1: `core/src/none.cpp`")

    def test_finds_a_path_beside_a_markdown_file_that_is_not_there(self):
        self.expect_finding({"core/README.md": "`src/a.cpp` `src/reader.cpp` `fit/none.h`\n",
                             "idl/a.md": "`src/reader.cpp`, `include/organ`, `organ/none.h`, `organ/answer.h`\n"},
                            "core/README.md:1: `fit/none.h`", "core/README.md:1: `src/a.cpp`",
                            "idl/a.md:1: `include/organ`", "idl/a.md:1: `organ/none.h`", "idl/a.md:1: `src/reader.cpp`")

    def test_finds_the_name_of_no_source(self):
        self.expect_finding({"idl/a.md": "`reader.cpp` `made_list.h` `writer.cpp` `organ.h5`\n"},
                            "idl/a.md:1: `writer.cpp`")

    def test_paths_that_are_no_files_of_ours_pass(self):
        code, lines = check_files({"idl/a.md": "`organ/displacement` `dS/dt` `/dev/null` `build/x.h` `a/b.msh` `core/*/*.h`\n"})
        self.assertEqual(code, 0, lines)

    def test_a_path_may_start_at_its_readme(self):
        code, lines = check_files({"tests/README.md": "`core/a_test.cpp`\n", "tests/core/a_test.cpp": ""})
        self.assertEqual(code, 0, lines)


class LinkLines(unittest.TestCase):
    expect_finding = CheckDocs.expect_finding

    def test_finds_a_link_that_the_picture_lacks(self):
        text = FILES["core/CMakeLists.txt"] + "target_link_libraries(organ_core PRIVATE organ_idl)\n"
        self.expect_finding({"core/CMakeLists.txt": text},
                            "core/CMakeLists.txt:2: organ_core links organ_idl: the picture in README.md lacks core ──► idl")

    def test_finds_an_arrow_that_cmake_lacks(self):
        self.expect_finding({"README.md": README.replace("──► core  idl", "──► core  idl  tools")},
                            "README.md:11: the picture has server ──► tools")

    def test_finds_a_folder_that_is_not_there(self):
        self.expect_finding({"README.md": README.replace("server/record\n```", "rt\nserver/record\n```")},
                            "README.md:13: the picture names rt")

    def test_finds_a_missing_picture(self):
        self.expect_finding({"README.md": "# Organ\n"}, "README.md:1: has no picture of link lines")

    def test_a_folder_of_the_picture_is_a_box_of_its_own(self):
        self.expect_finding({"README.md": README.replace("server/record\n```", "```").replace("server/record", "server")
                             .replace("──► core  server", "──► core")},
                            "tools/CMakeLists.txt:3: solve links organ_record: the picture in README.md lacks tools ──► server")

    def test_sees_through_functions_loops_and_objects(self):
        text = """function(tool NAME)
  cmake_parse_arguments(T "" "LABEL" "LIBRARIES" ${ARGN})
  add_executable(organ-${NAME} main.cpp)
  target_link_libraries(organ-${NAME} PRIVATE ${T_LIBRARIES})
endfunction()
"""
        self.expect_finding({"rt/CMakeLists.txt": text + "tool(a LABEL x LIBRARIES zlib organ_idl)\n"},
                            "rt/CMakeLists.txt:4: organ-a links organ_idl")
        self.expect_finding({"rt/CMakeLists.txt": "foreach(n IN ITEMS a b)\n  add_executable(r-${n} m.cpp)\nendforeach()\n"
                             "target_link_libraries(r-b organ_core)\n"}, "rt/CMakeLists.txt:4: r-b links organ_core")
        self.expect_finding({"rt/CMakeLists.txt": "add_library(r m.cpp)\ntarget_sources(r PRIVATE $<TARGET_OBJECTS:solve>)\n"},
                            "rt/CMakeLists.txt:2: r links solve")

    def test_a_function_of_another_folder_links_where_it_is_called(self):
        self.expect_finding({"cmake/tool.cmake": "function(tool NAME)\n  add_executable(${NAME} m.cpp)\n"
                             "  target_link_libraries(${NAME} PRIVATE organ_core)\nendfunction()\n",
                             "rt/CMakeLists.txt": "tool(organ-rt)\n"},
                            "cmake/tool.cmake:3: organ-rt links organ_core: the picture in README.md lacks rt ──► core")

    def test_prints_the_picture_that_cmake_has(self):
        code, lines = check_files({}, "--picture")
        self.assertEqual((code, lines), (0, ["server ──► core  idl", "tools  ──► core  server/record"]))


class Rooms(unittest.TestCase):
    expect_finding = CheckDocs.expect_finding

    @staticmethod
    def table(old, new):
        """docs/design.md with one row changed, and the number of that row's line."""
        text = DESIGN.replace(old, new)
        assert text != DESIGN
        return {"docs/design.md": text}

    @staticmethod
    def line(row):
        return f"docs/design.md:{DESIGN[:DESIGN.index(row)].count(chr(10)) + 1}: "

    def test_finds_a_missing_table(self):
        self.expect_finding({"docs/design.md": DESIGN.replace("<!-- rooms", "<!-- ")}, "docs/design.md:1: has no table of rooms")

    def test_finds_an_include_of_a_higher_room(self):
        self.expect_finding({"core/base/low.h": '#pragma once\n#include "core/tick/tick.h"\n'},
                            "core/base/low.h:2: includes core/tick/tick.h: the table in docs/design.md does not let core/base "
                            "see core/tick")

    def test_finds_an_include_beside_the_table_however_it_is_written(self):
        for include in ('"core/base/number.h"', '"../base/number.h"', "<core/base/number.h>"):
            self.expect_finding({"core/src/reader.cpp": f"{SOURCE}  # include {include}  // numbers\n"},
                                f"core/src/reader.cpp:4: includes {include[1:-1]}: the table in docs/design.md does not let "
                                "core see core/base")
        self.expect_finding({"core/base/low.h": '#include "organ/answer.h"\n'},
                            "core/base/low.h:1: includes organ/answer.h: the table in docs/design.md does not let core/base "
                            "see server")

    def test_finds_a_row_that_sees_a_row_below_it(self):
        self.expect_finding({**self.table("| numbers | nothing |", "| numbers | core/tick |"),
                             "core/base/low.h": '#include "core/tick/tick.h"\n'},
                            self.line("| core/base") + "the table lets core/base see core/tick, which is no room above it")

    def test_finds_a_row_that_sees_no_room(self):
        self.expect_finding(self.table("| answers | core/tick |", "| answers | core/tick, clock |"),
                            self.line("| server") + "the table lets server see clock, which is no room above it",
                            self.line("| server") + "the table lets server see clock: no file")

    def test_finds_a_room_that_is_seen_by_the_table_only(self):
        self.expect_finding({"core/tick/tick.h": "#pragma once\n"},
                            self.line("| core/tick") + "the table lets core/tick see core/base: no file of core/tick includes")

    def test_finds_sources_without_a_room(self):
        self.expect_finding({"tools/fit/a.cpp": "", "tools/fit/b.cpp": "", "tools/fit/fit.py": ""},
                            "tools/fit/a.cpp:1: lies in no room: the table in docs/design.md has no row for tools/fit")

    def test_finds_a_room_that_is_not_there(self):
        self.expect_finding(self.table("| server |", "| core/none | x | nothing |\n| server |"),
                            self.line("| server") + "the table has a room core/none: git tracks no such folder")

    def test_finds_an_include_of_ours_that_leads_nowhere(self):
        self.expect_finding({"core/tick/tick.cpp": FILES["core/tick/tick.cpp"] + '#include "core/tick/none.h"\n'},
                            "core/tick/tick.cpp:4: includes core/tick/none.h: git tracks no such file")

    def test_finds_a_cycle_of_units(self):
        self.expect_finding({"core/tick/a.h": '#include "core/tick/b.h"\n', "core/tick/b.h": "",
                             "core/tick/b.cpp": '#include "core/tick/b.h"\n#include "core/tick/a.h"\n'},
                            "core/tick/a.h:1: a cycle of includes: core/tick/a.h includes core/tick/b.h, "
                            "core/tick/b.cpp includes core/tick/a.h")

    def test_a_header_below_include_and_its_source_are_one_unit(self):
        self.expect_finding({"server/src/local.h": '#include "organ/answer.h"\n'},
                            "server/src/answer.cpp:4: a cycle of includes: server/src/answer.cpp includes server/src/local.h, "
                            "server/src/local.h includes server/include/organ/answer.h")

    def test_tests_may_include_everything(self):
        code, lines = check_files({"tests/t.cpp": '#include "core/tick/tick.h"\n#include "organ/answer.h"\n'})
        self.assertEqual(code, 0, lines)

    def test_prints_what_rooms_include(self):
        code, lines = check_files({"core/base/low.h": '#include "core/tick/tick.h"\n'}, "--rooms")
        self.assertEqual((code, lines), (0, ["core/base: core/tick", "core: nothing", "core/tick: core/base",
                                             "server: core/tick"]))


class Program(unittest.TestCase):
    def test_refuses_a_folder_that_is_no_repository(self):
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run([sys.executable, "-B", str(PROGRAM), "--root", folder], capture_output=True, text=True,
                                    check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn(folder, result.stderr)

    def test_help_names_the_checks(self):
        result = subprocess.run([sys.executable, "-B", str(PROGRAM), "--help"], capture_output=True, text=True, check=True)
        for word in ("links", "citations", "READMEs", "link lines", "rooms"):
            self.assertIn(word, result.stdout)


if __name__ == "__main__":
    unittest.main()
