#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes from the lists of palpate.idl, status flags and live parameters, what C++, C and the viewer's page need.

    make_lists.py palpate.idl OUT PAGE

OUT/palpate/core/status_flag_list.h   flags: constants, words and log texts, without DDS
OUT/palpate/idl/status_flag_list.h    the same constants beside the generated types
OUT/palpate_haptic_flags.h            flags for C, installed beside palpate_haptic.h
OUT/palpate/live_parameter_list.h     live parameters: fields, ranges, options and help, without DDS
PAGE                                  flags for the page, a TypeScript module

palpate.idl describes the format above each list. A file whose text does not change is not written.
"""
import json
import re
import sys
from pathlib import Path
from typing import NamedTuple, Optional

DETAIL = re.compile(r"\s*//   (word|page|log|range|key|option|help) +(.+)")
RANGE = re.compile(r"(\S+) to (\S+?)(?: ([^,]+))?(, or inf|, or 0)?")


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


def flag_of(number: int, name: str, bit: int, meaning: str, details: dict) -> Flag:
    if "page" not in details:
        fail(number, f"FLAG_{name} has no line 'page'")
    fault, page = re.fullmatch(r"(fault: )?(.+)", details["page"]).groups()
    word = details.get("word", name.lower().replace("_", "-"))
    return Flag(name, bit, meaning, word, page, fault is not None, details.get("log"))


class Parameter(NamedTuple):
    name: str  # as in the IDL, e.g. FRICTION
    bit: int
    meaning: str
    low: str
    high: str
    unit: str
    beyond: str  # "or inf", "or 0" or nothing
    key: str
    option: str
    help: str

    @property
    def field(self) -> str:
        return self.name.lower()

    @property
    def constant(self) -> str:
        return "k" + "".join(part.capitalize() for part in self.name.split("_"))

    @property
    def range(self) -> str:
        beyond = {"or inf": " or inf", "or 0": ", or 0: the model's own"}.get(self.beyond, "")
        return (self.unit + ", " if self.unit else "") + f"{self.low} to {self.high}" + beyond

    @property
    def json(self) -> str:
        unit = self.unit.replace(" ", "").replace("/", "_per_")
        return self.option.replace("-", "_") + ("_" + unit if unit else "")


def parameter_of(number: int, name: str, bit: int, meaning: str, details: dict) -> Parameter:
    for wanted in ("range", "key", "option", "help"):
        if wanted not in details:
            fail(number, f"PARAMETER_{name} has no line '{wanted}'")
    match = RANGE.fullmatch(details["range"])
    if not match:
        fail(number + 1, "a range is 'LOW to HIGH UNIT', then ', or inf' or ', or 0' if that is allowed too")
    low, high, unit, beyond = match.groups()
    return Parameter(name, bit, meaning, low, high, unit or "", (beyond or "").removeprefix(", "), details["key"],
                     details["option"], details["help"])


def read(path: Path, prefix: str, make) -> list:
    """The constants PREFIX_NAME of the file, in its order, with the lines below each."""
    constant = re.compile(rf"\s*const unsigned long {prefix}_(\w+) = (\d+);\s*// (.+)")
    entries = []
    lines = path.read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines, 1):
        match = constant.fullmatch(line)
        if not match:
            if re.match(rf"\s*const unsigned long {prefix}_", line):
                fail(number, f"expected 'const unsigned long {prefix}_NAME = bit;  // meaning'")
            continue
        details = {}
        for below in lines[number:]:
            detail = DETAIL.fullmatch(below)
            if not detail:
                break
            details[detail[1]] = detail[2]
        entry = make(number, match[1], int(match[2]), match[3], details)
        if entry.bit != 1 << len(entries):
            fail(number, f"{prefix}_{entry.name} is {entry.bit}, expected the next bit, {1 << len(entries)}")
        entries.append(entry)
    if not entries:
        fail(0, f"no constant {prefix}_")
    return entries


def quoted(text: Optional[str]) -> str:
    return "nullptr" if text is None else json.dumps(text)


HEAD = "SPDX-License-Identifier: Apache-2.0"
MADE = "Made from idl/palpate.idl by idl/make_lists.py."


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


def parameter_header(parameters: list) -> str:
    fields = "".join(f"  T {p.field}{{}};  ///< {p.meaning}\n" for p in parameters)
    rows = "".join(
        f"    {{{p.bit}, {quoted(p.field)}, {p.low}, {p.high}, {quoted(p.unit)}, "
        f"{str(p.beyond == 'or inf').lower()}, {str(p.beyond == 'or 0').lower()},\n     {quoted(p.key)}, "
        f"{quoted('--' + p.option)}, {quoted(p.json)}, {quoted(p.help + ', ' + p.range)}}},\n" for p in parameters)
    bits = "".join(f"/// {p.meaning}\ninline constexpr std::uint32_t {p.constant} = {p.bit};\n" for p in parameters)
    members = ", ".join(f"&T::{p.field}" for p in parameters)
    return (f"// {HEAD}\n// {MADE}\n#pragma once\n\n#include <array>\n#include <cstddef>\n#include <cstdint>\n\n"
            "namespace palpate {\n\n/// One value for each live parameter.\ntemplate <class T>\nstruct LiveFields {\n"
            f"{fields}\n  [[nodiscard]] bool operator==(const LiveFields&) const = default;\n}};\n\n"
            "/// What there is to say of a live parameter.\nstruct LiveParameterInfo {\n"
            "  std::uint32_t bit;  ///< of ParameterRequest.fields\n"
            "  const char* name;   ///< of the field\n"
            "  double low;\n  double high;\n"
            "  const char* unit;       ///< empty: none\n"
            "  bool may_be_infinite;   ///< infinity switches it off\n"
            "  bool zero_is_models;    ///< 0 stands for the model's own\n"
            "  const char* key;        ///< in the server's configuration file\n"
            "  const char* option;     ///< of palpate-server and palpate-parameters\n"
            "  const char* json;       ///< key in what palpate-parameters prints\n"
            "  const char* help;       ///< what it is, unit and range\n};\n\n"
            "/// All of them, in the order of their bits.\n"
            f"inline constexpr std::array<LiveParameterInfo, {len(parameters)}> kLiveParameters{{{{\n{rows}}}}};\n\n"
            "/// The fields of these names in a structure that has them, in the same order.\n"
            f"template <class T>\ninline constexpr std::array kLiveFields{{{members}}};\n\n"
            "}  // namespace palpate\n\n/// Bits of ParameterRequest::fields.\nnamespace palpate::dds::parameter {\n\n"
            f"{bits}inline constexpr std::uint32_t kAll = {sum(p.bit for p in parameters)};\n\n"
            "}  // namespace palpate::dds::parameter\n")


def write(path: Path, text: str) -> None:
    if path.exists() and path.read_text(encoding="utf-8") == text:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def main() -> None:
    source, out, page = (Path(argument) for argument in sys.argv[1:4])
    flags = read(source, "FLAG", flag_of)
    parameters = read(source, "PARAMETER", parameter_of)
    write(out / "palpate/core/status_flag_list.h", core_header(flags))
    write(out / "palpate/idl/status_flag_list.h", idl_header(flags))
    write(out / "palpate_haptic_flags.h", c_header(flags))
    write(out / "palpate/live_parameter_list.h", parameter_header(parameters))
    write(page, page_module(flags))


main()
