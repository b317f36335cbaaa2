# SPDX-License-Identifier: Apache-2.0
"""The picture of link lines in README.md, held against CMake's.

The picture is the fenced block after MARK, a line `folder ──► folder  folder` for each folder that links others. The
folders it names are its boxes; a target belongs to the innermost box that its folder lies in.
"""
import re

from docs_checks import cmake
from docs_checks.tree import Finding

MARK = "<!-- link lines: tools/check_docs compares them with CMake -->"
ARROW = re.compile(r"\s*(?:──►|->)\s*")
PICTURE = "README.md"
NOT_CODE = {"cmake", "tests", ""}  # compiler flags; tests may link everything


def findings(tree):
    edges = read_picture(tree)
    if edges is None:
        yield Finding(PICTURE, 1, f"has no picture of link lines: a fenced block after {MARK}")
        return
    boxes = boxes_of(edges)
    real = cmake_edges(tree, boxes)
    for (folder, other), link in sorted(real.items()):
        if (folder, other) not in edges:
            yield Finding(link.file, link.line, f"{link.target} links {link.library}: "
                          f"the picture in {PICTURE} lacks {folder} ──► {other}")
    for (folder, other), line in sorted(edges.items()):
        if other is not None and (folder, other) not in real:
            yield Finding(PICTURE, line, f"the picture has {folder} ──► {other}: no target of {folder} links one of {other}")
    for box in sorted(boxes):
        if not tree.holds(box):
            line = next(line for edge, line in edges.items() if box in edge)
            yield Finding(PICTURE, line, f"the picture names {box}: git tracks no such folder")


def read_picture(tree):
    """{(folder, folder it links or None): line of README.md}; None without a picture."""
    if PICTURE not in tree.files or MARK not in tree.text(PICTURE):
        return None
    edges, inside = {}, None
    for number, line in enumerate(tree.text(PICTURE).splitlines(), 1):
        if line.strip() == MARK:
            inside = False
        elif inside is not None and line.startswith("```"):
            if inside:
                return edges
            inside = True
        elif inside and line.strip():
            folder, *others = ARROW.split(line.strip(), maxsplit=1)
            for other in re.split(r"[,\s]+", others[0].strip()) if others else [None]:
                edges[folder, other] = number
    return edges


def boxes_of(edges):
    return {folder for edge in edges for folder in edge if folder is not None}


def cmake_edges(tree, boxes):
    """{(box, box that it links): one link that does}."""
    files = {file: tree.text(file) for file in tree.files
             if file.rsplit("/", 1)[-1] == "CMakeLists.txt" or file.endswith(".cmake")}
    links = cmake.Links({file: text for file, text in files.items() if not file.startswith("tests/")})
    edges = {}
    for link in links.between_targets():
        ends = [box_of(links.folders[name], boxes) for name in (link.target, link.library)]
        if ends[0] != ends[1] and not NOT_CODE.intersection(ends):
            edges.setdefault(tuple(ends), link)
    return edges


def box_of(folder, boxes):
    """The innermost box that holds a folder; its first part where the picture has none."""
    parts = folder.split("/")
    for count in range(len(parts), 0, -1):
        if "/".join(parts[:count]) in boxes:
            return "/".join(parts[:count])
    return parts[0]


def drawn(tree):
    """The picture's lines as CMake has them, with the boxes of the picture that is there."""
    boxes = boxes_of(read_picture(tree) or {})
    edges = cmake_edges(tree, boxes)
    width = max((len(folder) for folder, _ in edges), default=0)
    for folder in sorted({folder for folder, _ in edges}):
        others = sorted(other for first, other in edges if first == folder)
        yield f"{folder:<{width}} ──► {'  '.join(others)}"
