# SPDX-License-Identifier: Apache-2.0
"""tools/check_docs on small repositories: one that is right, and for each kind of finding one that is wrong."""
import subprocess
import sys
import tempfile
import unittest

from small_repository import DOCS, FILES, GUIDE, PROGRAM, README, Case, check_files


class CheckDocs(Case):
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
        self.expect_finding({"idl/a.md": "`reader.cpp` `live_parameter_list.h` `writer.cpp` `organ.h5`\n"},
                            "idl/a.md:1: `writer.cpp`")

    def test_paths_that_are_no_files_of_ours_pass(self):
        code, lines = check_files({"idl/a.md": "`organ/displacement` `dS/dt` `/dev/null` `build/x.h` `a/b.msh` `core/*/*.h`\n"})
        self.assertEqual(code, 0, lines)

    def test_a_path_may_start_at_its_readme(self):
        code, lines = check_files({"tests/README.md": "`core/a_test.cpp`\n", "tests/core/a_test.cpp": ""})
        self.assertEqual(code, 0, lines)


class LinkLines(Case):
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
