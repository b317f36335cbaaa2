#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the constants of C++, C and the viewer's page from the list of status flags in palpate.idl.

    status_flags.py palpate.idl OUT PAGE

OUT/palpate/core/status_flag_list.h   constants, words and log texts, without DDS
OUT/palpate/idl/status_flag_list.h    the same constants beside the generated types
OUT/palpate_haptic_flags.h            constants for C, installed beside palpate_haptic.h
PAGE                                  TypeScript module of the page

palpate.idl describes the format above its first flag. A file whose text does not change is not written.
"""
import json
import re
import sys
from pathlib import Path
from typing import NamedTuple, Optional

CONSTANT = re.compile(r"\s*const unsigned long FLAG_(\w+) = (\d+);\s*// (.+)")
DETAIL = re.compile(r"\s*//   (word|page|log) +(.+)")


class Flag(NamedTuple):
    name: str  # as in the IDL, e.g. STALE_POSE
    bit: int
    meaning: str
    word: str
    page: str
    fault: bool
    log: Optional[str]

    @property
    def constant(self) -> str:
        return "k" + "".join(part.capitalize() for part in self.name.split("_"))


def fail(line_number: int, text: str) -> None:
    sys.exit(f"palpate.idl:{line_number}: {text}")


def flag_of(number: int, match: re.Match, details: dict) -> Flag:
    name, bit, meaning = match[1], int(match[2]), match[3]
    if "page" not in details:
        fail(number, f"FLAG_{name} has no line 'page'")
    fault, page = re.fullmatch(r"(fault: )?(.+)", details["page"]).groups()
    word = details.get("word", name.lower().replace("_", "-"))
    return Flag(name, bit, meaning, word, page, fault is not None, details.get("log"))


def read(path: Path) -> list:
    flags = []
    lines = path.read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines, 1):
        match = CONSTANT.fullmatch(line)
        if not match:
            if re.match(r"\s*const unsigned long FLAG_", line):
                fail(number, "a flag is 'const unsigned long FLAG_NAME = bit;  // meaning'")
            continue
        details = {}
        for below in lines[number:]:
            detail = DETAIL.fullmatch(below)
            if not detail:
                break
            details[detail[1]] = detail[2]
        flag = flag_of(number, match, details)
        if flag.bit != 1 << len(flags):
            fail(number, f"FLAG_{flag.name} is {flag.bit}, expected the next bit, {1 << len(flags)}")
        flags.append(flag)
    return flags


def quoted(text: Optional[str]) -> str:
    return "nullptr" if text is None else json.dumps(text)


HEAD = "SPDX-License-Identifier: Apache-2.0"
MADE = "Made from idl/palpate.idl by idl/status_flags.py."


def core_header(flags: list) -> str:
    constants = "".join(
        f"/// {f.meaning}\ninline constexpr std::uint32_t {f.constant} = {f.bit};\n" for f in flags)
    rows = "".join(f"    {{{f.constant}, {quoted(f.word)}, {quoted(f.log)}}},\n" for f in flags)
    return (f"// {HEAD}\n// {MADE}\n#pragma once\n\n#include <array>\n#include <cstdint>\n\nnamespace palpate {{\n\n"
            f"{constants}\n/// One bit of ToolResult::flags.\nstruct StatusFlag {{\n  std::uint32_t bit;\n"
            "  const char* word;  ///< what programs print\n"
            "  const char* log;   ///< what the server logs when the flag appears; null: nothing\n};\n"
            f"/// All flags, lowest bit first.\ninline constexpr std::array<StatusFlag, {len(flags)}> kStatusFlags{{{{\n"
            f"{rows}}}}};\n\n}}  // namespace palpate\n")


def idl_header(flags: list) -> str:
    constants = "".join(f"/// {f.meaning}\ninline constexpr std::uint32_t {f.constant} = palpate_FLAG_{f.name};\n"
                        for f in flags)
    rows = "".join(f"    {{{f.constant}, {quoted(f.word)}}},\n" for f in flags)
    return (f"// {HEAD}\n// {MADE}\n#pragma once\n\n#include <palpate.h>\n\n#include <array>\n#include <cstdint>\n"
            "#include <utility>\n\n/// Bits of ToolForce::flags.\nnamespace palpate::dds::flag {\n\n"
            f"{constants}\n/// All flags and what programs print for them, lowest bit first.\n"
            f"inline constexpr std::array<std::pair<std::uint32_t, const char*>, {len(flags)}> kWords{{{{\n"
            f"{rows}}}}};\n\n}}  // namespace palpate::dds::flag\n")


def c_header(flags: list) -> str:
    width = max(len(f"{f.name} = {f.bit}") for f in flags) + 1
    rows = "".join(
        "  PALPATE_HAPTIC_FLAG_" + (f"{f.name} = {f.bit}" + ("," if f is not flags[-1] else "")).ljust(width)
        + f" /* {f.meaning} */\n" for f in flags)
    return (f"/* {HEAD} */\n/* {MADE} */\n#ifndef PALPATE_HAPTIC_FLAGS_H\n#define PALPATE_HAPTIC_FLAGS_H\n\n"
            f"/* Bits of palpate_haptic_force.flags. */\nenum {{\n{rows}}};\n\n#endif\n")


def page_module(flags: list) -> str:
    def text(value: str) -> str:
        return "'" + value.replace("\\", "\\\\").replace("'", "\\'") + "'"

    rows = "".join(f"  {{ bit: {f.bit}, name: {text(f.name)}, words: {text(f.page)}, severe: {str(f.fault).lower()} }},\n"
                   for f in flags)
    constants = "".join(f"export const FLAG_{f.name} = {f.bit};\n" for f in flags)
    return (f"// {HEAD}\n// {MADE}\n{constants}\n/** All flags, lowest bit first, in words for people. */\n"
            "export const FLAGS: readonly { bit: number; name: string; words: string; severe: boolean }[] = [\n"
            f"{rows}];\n")


def write(path: Path, text: str) -> None:
    if path.exists() and path.read_text(encoding="utf-8") == text:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def main() -> None:
    source, out, page = (Path(argument) for argument in sys.argv[1:4])
    flags = read(source)
    write(out / "palpate/core/status_flag_list.h", core_header(flags))
    write(out / "palpate/idl/status_flag_list.h", idl_header(flags))
    write(out / "palpate_haptic_flags.h", c_header(flags))
    write(page, page_module(flags))


main()
