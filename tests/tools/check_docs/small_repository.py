# SPDX-License-Identifier: Apache-2.0
"""A small repository that tools/check_docs finds nothing wrong with, and what it says of changes to it."""
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
    "core/tick/tick.cpp": '#include "core/tick/tick.h"\n\n#include "palpate/live_parameter_list.h"\n',
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


class Case(unittest.TestCase):
    def expect_finding(self, changes, *beginnings):
        """Exactly these findings, by how their lines begin."""
        code, lines = check_files(changes)
        self.assertEqual(code, 1, lines)
        self.assertEqual(len(lines), len(beginnings) + 1, lines)
        for line, beginning in zip(lines, beginnings):
            self.assertTrue(line.startswith(beginning), f"{line!r} does not begin with {beginning!r}")
        self.assertTrue(lines[-1].endswith(f"{len(beginnings)} findings"), lines)
