# SPDX-License-Identifier: Apache-2.0
"""Links of Markdown files; size and paths of READMEs."""
import posixpath
import re
import urllib.parse

from docs_checks import markdown
from docs_checks.tree import Finding

MOST_README_LINES = 120

ELSEWHERE = re.compile(r"^[a-z][a-z0-9+.-]*:|^//", re.IGNORECASE)
PATH = re.compile(r"^[\w.\-/*?]+$")


def findings(tree):
    for file in tree.files:
        if file.endswith(".md"):
            yield from broken_links(tree, file)
    for file in tree.named("README.md"):
        yield from long_readme(tree, file)
        yield from missing_paths(tree, file)


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
    """Words in backticks that start with a folder at the top of the repository.

    They are paths from the top or from the README's folder. What git ignores exists after a build only, and is skipped.
    """
    here = posixpath.dirname(file)
    for line, code in markdown.spans(tree.text(file)):
        for word in code.split():
            path = word.strip("\"'(),;:")
            if "/" not in path or path.split("/")[0] not in tree.top_folders or not PATH.match(path):
                continue
            there = tree.matches if re.search(r"[*?]", path) else tree.holds
            if not there(path) and not there(posixpath.join(here, path)) and not tree.ignored(path):
                yield Finding(file, line, f"`{path}` is not in the repository")
