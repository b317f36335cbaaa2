# SPDX-License-Identifier: Apache-2.0
"""The table of rooms in docs/design.md, held against the tree and its includes.

core and tools share the top of the repository as include folder, so that any header compiles anywhere there. The table
after MARK says who may include whom: a row `| folder | what it owns | may see |` for each room. A file belongs to the
innermost room that its folder lies in. A room sees rooms above it in the table only, so rooms cannot form a cycle.
"""
import posixpath
import re
from typing import NamedTuple

from docs_checks.tree import Finding

MARK = "<!-- rooms: tools/check_docs compares them with the tree and the includes -->"
TABLE = "docs/design.md"
FOLDERS = ("core", "tools", "server", "rt", "idl", "clients")  # tests may include everything
SOURCES = (".h", ".hpp", ".c", ".cc", ".cpp")
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)')
NOTHING = "nothing"


class Room(NamedTuple):
    line: int
    sees: list


class Include(NamedTuple):
    file: str
    line: int
    name: str   # as written
    found: str  # the tracked file that it means, or None


def findings(tree):
    rooms = read_table(tree)
    if rooms is None:
        yield Finding(TABLE, 1, f"has no table of rooms: rows `| folder | what it owns | may see |` after {MARK}")
        return
    includes = includes_of(tree)
    yield from unfit_rows(tree, rooms)
    yield from homeless(tree, rooms)
    yield from unresolved(includes)
    yield from wrong_includes(includes, rooms)
    yield from unused(includes, rooms)
    yield from cycles(includes)


def read_table(tree):
    """{folder: Room} in the order of the rows; None without a table. The first of two rows of a folder counts."""
    if TABLE not in tree.files or MARK not in tree.text(TABLE):
        return None
    rooms, inside = {}, None
    for number, line in enumerate(tree.text(TABLE).splitlines(), 1):
        if line.strip() == MARK:
            inside = -2  # the table's head and the line below it
        elif inside is not None and line.startswith("|"):
            inside += 1
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            if inside > 0 and len(cells) == 3:
                sees = [name.strip(" `") for name in cells[2].split(",")]
                rooms.setdefault(cells[0].strip("`"), Room(number, [name for name in sees if name not in ("", NOTHING)]))
        elif inside is not None and inside > -2:
            break
    return rooms


def room_of(file, rooms):
    """The innermost room that holds a file, or None."""
    folder = posixpath.dirname(file)
    while folder and folder not in rooms:
        folder = posixpath.dirname(folder)
    return folder or None


def sources(tree):
    return [file for file in tree.files if file.split("/")[0] in FOLDERS and file.endswith(SOURCES)]


def includes_of(tree):
    """All #include lines of the sources; what is neither tracked nor under one of FOLDERS is left out."""
    files = set(tree.files)
    exported = {file.split("/include/", 1)[1]: file for file in tree.files if "/include/" in file}
    result = []
    for file in sources(tree):
        for number, line in enumerate(tree.text(file).splitlines(), 1):
            if not (match := INCLUDE.match(line)):
                continue
            name = match.group(1) or match.group(2)
            places = (posixpath.normpath(posixpath.join(posixpath.dirname(file), name)), posixpath.normpath(name),
                      exported.get(name))
            found = next((place for place in places[0 if match.group(1) else 1:] if place in files), None)
            if found or ("/" in name and name.split("/")[0] in FOLDERS):
                result.append(Include(file, number, name, found))
    return result


def unfit_rows(tree, rooms):
    above = set()
    for folder, room in rooms.items():
        if not tree.holds(folder):
            yield Finding(TABLE, room.line, f"the table has a room {folder}: git tracks no such folder")
        for other in room.sees:
            if other not in above:
                yield Finding(TABLE, room.line, f"the table lets {folder} see {other}, which is no room above it")
        above.add(folder)


def homeless(tree, rooms):
    seen = set()
    for file in sources(tree):
        folder = posixpath.dirname(file)
        if folder not in seen and room_of(file, rooms) is None:
            seen.add(folder)
            yield Finding(file, 1, f"lies in no room: the table in {TABLE} has no row for {folder}")


def unresolved(includes):
    for include in includes:
        if include.found is None:
            yield Finding(include.file, include.line, f"includes {include.name}: git tracks no such file")


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
    rooms = read_table(tree) or {}
    used = {(room, other) for _, room, other in between_rooms(includes_of(tree), rooms)}
    for folder in rooms:
        yield f"{folder}: {', '.join(other for other in rooms if (folder, other) in used) or NOTHING}"
