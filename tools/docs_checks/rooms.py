# SPDX-License-Identifier: Apache-2.0
"""The table of rooms in docs/design.md, held against the tree and its includes.

Most targets have the top of the repository as include folder, so that any header compiles there. The table after MARK
says who may include whom: a row `| folder | what it owns | may see |` for each room. A file belongs to the innermost
room that its folder lies in. A room sees rooms above it in the table only, so rooms cannot form a cycle.
"""
import posixpath
import re
from typing import NamedTuple

from docs_checks.tree import Finding

MARK = "<!-- rooms: tools/check_docs compares them with the tree and the includes -->"
TABLE = "docs/design.md"
FOLDERS = ("core", "tools", "server", "rt", "idl", "clients")  # tests may include everything
SOURCES = (".h", ".hh", ".hpp", ".hxx", ".h.in", ".inc", ".inl", ".ipp", ".tpp",
           ".c", ".cc", ".cpp", ".cxx", ".cppm", ".ixx")
# What a build makes, by the name in includes: the room that it counts to, or None where every room may include it.
MADE = {
    "palpate.h": "idl",
    "palpate/idl/status_flag_list.h": "idl",
    "palpate/core/status_flag_list.h": "core/base",
    "palpate/live_parameter_list.h": None,
    "palpate_haptic_flags.h": "clients/haptic",
    "tools/examine/certify/report/page_template.h": "tools/examine/certify",
}
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)')
# What may hold a comment's beginning without being one, then the comment; only raw strings and comments are blanked.
TOKEN = re.compile(r'(?P<blank>R"(?P<end>[^()\s]*)\(.*?\)(?P=end)"|/\*.*?\*/)|"(?:\\.|[^"\\\n])*"'
                   r"|(?<![0-9A-Fa-f])'(?:\\.[^'\n]*|[^'\\\n])'|//[^\n]*", re.DOTALL)
NOTHING = "nothing"


class Row(NamedTuple):
    line: int
    folder: str
    sees: list


class Include(NamedTuple):
    file: str
    line: int
    name: str   # as written
    found: str  # the tracked file that it means, or where one that a build makes would lie; None: neither


def findings(tree):
    rows = read_table(tree)
    if not rows:
        yield Finding(TABLE, 1, f"has no table of rooms: rows `| folder | what it owns | may see |` after {MARK}")
        return
    rooms = by_folder(rows)
    includes = includes_of(tree)
    yield from unfit_rows(tree, rows)
    yield from homeless(tree, rooms)
    yield from astray(tree, includes, rooms)
    yield from wrong_includes(includes, rooms)
    yield from unused(includes, rooms)
    yield from cycles(includes)


def read_table(tree):
    """The rows in their order; none without a table."""
    rows, inside = [], None
    for number, line in enumerate(tree.text(TABLE).splitlines() if TABLE in tree.files else [], 1):
        if line.strip() == MARK:
            inside = -2  # the table's head and the line below it
        elif inside is not None and line.startswith("|"):
            inside += 1
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            if inside > 0 and len(cells) == 3:
                sees = [name.strip(" `") for name in cells[2].split(",")]
                rows.append(Row(number, cells[0].strip("`"), [name for name in sees if name not in ("", NOTHING)]))
        elif inside is not None and inside > -2:
            break
    return rows


def by_folder(rows):
    """{folder: row}; the first of two rows of a folder counts."""
    rooms = {}
    for row in rows:
        rooms.setdefault(row.folder, row)
    return rooms


def room_of(file, rooms):
    """The innermost room that holds a file, or None."""
    folder = posixpath.dirname(file)
    while folder and folder not in rooms:
        folder = posixpath.dirname(folder)
    return folder or None


def sources(tree):
    return [file for file in tree.files if file.split("/")[0] in FOLDERS and file.endswith(SOURCES)]


def without_comments(text):
    """Without /* comments */ and raw strings; lines keep their numbers."""
    return TOKEN.sub(lambda match: "\n" * match[0].count("\n") if match["blank"] else match[0], text)


def includes_of(tree):
    """All #include lines of the sources but those of the system, of other libraries and of what is made for all rooms."""
    files = set(tree.files)
    exported = {file.split("/include/", 1)[1]: file for file in tree.files if "/include/" in file}
    ours = {*FOLDERS, *(name.split("/")[0] for name in exported)}
    result = []
    for file in sources(tree):
        for number, line in enumerate(without_comments(tree.text(file)).splitlines(), 1):
            if not (match := INCLUDE.match(line)):
                continue
            quoted, name = match[1] is not None, match[1] or match[2]
            found = next((place for place in places_of(name, file if quoted else None, exported) if place in files), None)
            if found is None and name in MADE:
                if MADE[name]:
                    result.append(Include(file, number, name, f"{MADE[name]}/{posixpath.basename(name)}"))
            elif found or quoted or ("/" in name and name.split("/")[0] in ours):
                result.append(Include(file, number, name, found))
    return result


def places_of(name, file, exported):
    """Where an include of this name may lead: beside the file, if it is in quotes, from the top, src of the file's target
    or a folder include/."""
    if file:
        yield posixpath.normpath(posixpath.join(posixpath.dirname(file), name))
    yield posixpath.normpath(name)
    if file and "/src/" in file:
        yield f"{file.split('/src/', 1)[0]}/src/{name}"
    yield exported.get(name)


def unfit_rows(tree, rows):
    above = {}
    for line, folder, sees in rows:
        if folder in above:
            yield Finding(TABLE, line, f"the table has a second row of {folder}, after line {above[folder]}")
        if not tree.holds(folder):
            yield Finding(TABLE, line, f"the table has a room {folder}: git tracks no such folder")
        for other in sees:
            if other not in above:
                yield Finding(TABLE, line, f"the table lets {folder} see {other}, which is no room above it")
        above.setdefault(folder, line)


def homeless(tree, rooms):
    seen = set()
    for file in sources(tree):
        folder = posixpath.dirname(file)
        if folder not in seen and room_of(file, rooms) is None:
            seen.add(folder)
            yield Finding(file, 1, f"lies in no room: the table in {TABLE} has no row for {folder}")


def astray(tree, includes, rooms):
    """Includes that the table cannot judge."""
    for file, line, name, found in includes:
        if found is None:
            yield Finding(file, line, f"includes {name}: git tracks no such file, and no build makes it (MADE in rooms.py)")
        elif room_of(found, rooms) is None:
            yield Finding(file, line, f"includes {name}: {found} lies in no room of the table in {TABLE}")
        elif tree.holds(found) and not found.endswith(SOURCES):
            yield Finding(file, line, f"includes {name}: what {found} includes is not read; give it an ending of a source")


def wrong_includes(includes, rooms):
    for include, room, other in between_rooms(includes, rooms):
        if other not in rooms[room].sees:
            yield Finding(include.file, include.line,
                          f"includes {include.name}: the table in {TABLE} does not let {room} see {other}")


def unused(includes, rooms):
    used = {(room, other) for _, room, other in between_rooms(includes, rooms)}
    for folder, room in rooms.items():
        for other in room.sees:
            if (folder, other) not in used:
                yield Finding(TABLE, room.line, f"the table lets {folder} see {other}: no file of {folder} includes one of it")


def between_rooms(includes, rooms):
    """(include, room of its file, room of what it means) where these are two rooms."""
    for include in includes:
        room = room_of(include.file, rooms)
        other = room_of(include.found, rooms) if include.found else None
        if room and other and room != other:
            yield include, room, other


def unit_of(file):
    """What a header and its source have in common: the path without its ending, include/.../ and src/."""
    return re.sub(r"/(?:src|include(?:/\w+)*)/", "/", posixpath.splitext(file)[0])


def cycles(includes):
    """A finding for each group of units that reach each other: the shortest way round in it."""
    edges = {}
    for include in includes:
        if include.found and unit_of(include.found) != unit_of(include.file):
            edges.setdefault(unit_of(include.file), {}).setdefault(unit_of(include.found), include)
    backwards = {}
    for unit, others in edges.items():
        for other in others:
            backwards.setdefault(other, {})[unit] = None
    seen = set()
    for unit in sorted(edges):
        group = set() if unit in seen else reached(unit, edges) & reached(unit, backwards)
        seen |= group
        if group:
            way = min((way_round(member, edges) for member in sorted(group)), key=len)
            steps = ", ".join(f"{include.file} includes {include.found}" for include in way)
            yield Finding(way[0].file, way[0].line, f"a cycle of includes: {steps}")


def reached(unit, edges):
    """The units that one leads to; itself only where a way leads back."""
    found, front = set(), [unit]
    while front:
        for other in edges.get(front.pop(), {}):
            if other not in found:
                found.add(other)
                front.append(other)
    return found


def way_round(unit, edges):
    """The includes of a shortest cycle through a unit that is on one."""
    ways = {unit: []}
    front = [unit]
    while True:
        following = []
        for at in front:
            for other, include in edges.get(at, {}).items():
                if other == unit:
                    return [*ways[at], include]
                if other not in ways:
                    ways[other] = [*ways[at], include]
                    following.append(other)
        front = following


def drawn(tree):
    """What each room of the table includes, as lines `folder: folder, folder`."""
    rooms = by_folder(read_table(tree))
    used = {(room, other) for _, room, other in between_rooms(includes_of(tree), rooms)}
    for folder in rooms:
        yield f"{folder}: {', '.join(other for other in rooms if (folder, other) in used) or NOTHING}"
