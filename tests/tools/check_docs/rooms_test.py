# SPDX-License-Identifier: Apache-2.0
"""tools/check_docs on the table of rooms: for each kind of finding a small repository that is wrong."""
import unittest

from small_repository import DESIGN, FILES, SOURCE, Case, check_files


class Rooms(Case):
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

    def test_finds_an_include_that_leads_out_of_all_rooms(self):
        tests = {"tests/core/plate.h": "", "tests/include/organ/plate.h": ""}
        for include, file in (('"tests/core/plate.h"', "tests/core/plate.h"), ("<tests/core/plate.h>", "tests/core/plate.h"),
                              ('"../../tests/core/plate.h"', "tests/core/plate.h"),
                              ('"organ/plate.h"', "tests/include/organ/plate.h"), ('"README.md"', "README.md")):
            self.expect_finding({**tests, "core/base/low.h": f"#include {include}\n"},
                                f"core/base/low.h:1: includes {include[1:-1]}: {file} lies in no room of the table")

    def test_finds_includes_in_quotes_that_nothing_makes(self):
        for include in ('"none.h"', '"organ/none.h"', '"vector/none.h"', "<organ/none.h>"):
            self.expect_finding({"core/base/low.h": f"#include {include}\n"},
                                f"core/base/low.h:1: includes {include[1:-1]}: git tracks no such file")
        code, lines = check_files({"core/base/low.h": "#include <vector>\n#include <vector/none.h>\n"})
        self.assertEqual(code, 0, lines)

    def test_finds_a_bare_name_from_the_src_of_another_target(self):
        self.expect_finding({"core/base/low.h": '#include "local.h"\n'}, "core/base/low.h:1: includes local.h: git tracks no such")
        code, lines = check_files({"server/src/part/deep.cpp": '#include "local.h"\n'})
        self.assertEqual(code, 0, lines)

    def test_what_a_build_makes_counts_to_a_room(self):
        row = self.table("| server |", "| idl | the wire | nothing |\n| server |")
        for name in ("palpate.h", "palpate/idl/status_flag_list.h"):
            for include in (f'"{name}"', f"<{name}>"):
                self.expect_finding({**row, "core/base/low.h": f"#include {include}\n"},
                                    f"core/base/low.h:1: includes {name}: the table in docs/design.md does not let core/base see idl")
        code, lines = check_files({"core/base/low.h": '#include "palpate/core/status_flag_list.h"\n'})
        self.assertEqual(code, 0, lines)

    def test_finds_a_second_row_of_a_folder(self):
        row = "| core/tick | one tick | core/base |\n"
        self.expect_finding(self.table(row, row + "| core/tick | again | core/base, server |\n"),
                            f"docs/design.md:{int(self.line(row).split(':')[1]) + 1}: the table has a second row of core/tick",
                            f"docs/design.md:{int(self.line(row).split(':')[1]) + 1}: the table lets core/tick see server")

    def test_reads_sources_of_all_endings(self):
        files = sorted(f"core/base/low.{ending}" for ending in
                       ("c", "cc", "cppm", "cxx", "h.in", "hh", "hpp", "hxx", "inc", "inl", "ipp", "ixx", "tpp"))
        self.expect_finding({file: '#include "core/tick/tick.h"\n' for file in files},
                            *(f"{file}:1: includes core/tick/tick.h: the table" for file in files))
        self.expect_finding({"core/base/low.h": '#include "core/base/low.txt"\n', "core/base/low.txt": ""},
                            "core/base/low.h:1: includes core/base/low.txt: what core/base/low.txt includes is not read")

    def test_includes_in_comments_and_raw_strings_are_none(self):
        text = '/* as in\n#include "core/tick/tick.h"\n*/\nauto s = R"x(\n#include "core/tick/tick.h"\n)x";\n'
        code, lines = check_files({"core/base/low.h": text})
        self.assertEqual(code, 0, lines)
        for before in ('auto s = "/*";', "// as in tick/*.h", "auto c = '\"'; auto s = \"/*\";", "auto n = 1'000; // /*"):
            self.expect_finding({"core/base/low.h": f'{before}\n/**/ #include "core/tick/tick.h" /* */\n'},
                                "core/base/low.h:2: includes core/tick/tick.h: the table")

    def test_finds_a_cycle_of_units(self):
        self.expect_finding({"core/tick/a.h": '#include "core/tick/b.h"\n', "core/tick/b.h": "",
                             "core/tick/b.cpp": '#include "core/tick/b.h"\n#include "core/tick/a.h"\n'},
                            "core/tick/a.h:1: a cycle of includes: core/tick/a.h includes core/tick/b.h, "
                            "core/tick/b.cpp includes core/tick/a.h")

    def test_names_the_shortest_of_cycles_that_meet(self):
        includes = {"a": "b", "b": "cd", "c": "a", "d": "b"}
        self.expect_finding({f"core/tick/{name}.h": "".join(f'#include "{other}.h"\n' for other in others)
                             for name, others in includes.items()},
                            "core/tick/b.h:2: a cycle of includes: core/tick/b.h includes core/tick/d.h, core/tick/d.h includes")

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


if __name__ == "__main__":
    unittest.main()
