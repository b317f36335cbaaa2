# SPDX-License-Identifier: Apache-2.0
"""Links of Markdown files, and the paths in their backticks; size of READMEs."""
import functools
import posixpath
import re
import urllib.parse

from docs_checks import markdown
from docs_checks.tree import Finding

MOST_README_LINES = 120

ELSEWHERE = re.compile(r"^[a-z][a-z0-9+.-]*:|^//", re.IGNORECASE)
PATH = re.compile(r"^[\w.\-/*?]+$")
SOURCE = re.compile(r"\.(?:h|hpp|c|cc|cpp|py|ts|idl|cmake)$")
INCLUDE = re.compile(r'^\s*#\s*include\s*["<](?:[^">]*/)?([^">/]+)[">]', re.MULTILINE)


def findings(tree):
    for file in tree.files:
        if file.endswith(".md"):
            yield from broken_links(tree, file)
            yield from missing_paths(tree, file)
    for file in tree.named("README.md"):
        yield from long_readme(tree, file)


def broken_links(tree, file):
    for line, target in markdown.targets(tree.text(file)):
        if ELSEWHERE.match(target):
            continue
        path, _, anchor = target.partition("#")
        path = urllib.parse.unquote(path)
        # GitHub takes a leading slash for the top of the repository.
        there = file if not path else posixpath.normpath(
            path.lstrip("/") if path.startswith("/") else posixpath.join(posixpath.dirname(file), path))
        if there == ".":
            there = ""
        if not tree.holds(there):
            yield Finding(file, line, f"link to {target}: git tracks no {there}")
        elif anchor and there.endswith(".md") and urllib.parse.unquote(anchor) not in markdown.anchors(tree.text(there)):
            yield Finding(file, line, f"link to {target}: {there} has no heading #{anchor}")


def long_readme(tree, file):
    lines = len(tree.text(file).splitlines())
    if lines > MOST_README_LINES:
        yield Finding(file, MOST_README_LINES + 1, f"{lines} lines, a README has at most {MOST_README_LINES}")


def missing_paths(tree, file):
    """Words in backticks that are paths: they start with a folder at the top, with src or include, or name a source.

    They lead on from the top, from the file's folder or from an include folder; a name alone is that of a file anywhere.
    What git ignores exists after a build only, and so may a header that a source includes by its name.
    """
    here = posixpath.dirname(file)
    for line, code in markdown.spans(tree.text(file)):
        for word in code.split():
            path = word.strip("\"'(),;:")
            if PATH.match(path) and is_path(tree, path) and not is_there(tree, here, path):
                yield Finding(file, line, f"`{path}` is not in the repository")


def is_path(tree, path):
    if "/" not in path:
        return SOURCE.search(path)
    return path.split("/")[0] in {*tree.top_folders, "src", "include"} or SOURCE.search(path)


def is_there(tree, here, path):
    if re.search(r"[*?]", path):
        return tree.matches(path)
    if "/" not in path and (tree.named(path) or path in included_names(tree)):
        return True
    beside = posixpath.normpath(posixpath.join(here, path))
    return (tree.holds(path) or tree.holds(beside) or tree.matches("include/" + path)
            or tree.ignored(path) or (not beside.startswith("..") and tree.ignored(beside)))


@functools.lru_cache(maxsize=1)
def included_names(tree):
    """Names of the headers that sources include, also of those that a build makes."""
    return {name for file in tree.files if SOURCE.search(file) for name in INCLUDE.findall(tree.text(file))}
