# SPDX-License-Identifier: Apache-2.0
"""Citations in any text: `docs/NAME.md`, also in docs/decisions, and `docs/NAME.md, Heading, Heading`.

The words NAME and Heading themselves stand for any, and are not looked up.
"""
import re

from docs_checks import markdown
from docs_checks.tree import Finding, line_of

DOCUMENT = re.compile(r"(?<![\w/.\-])docs/(?:[\w\-]+/)*[\w\-]+\.md\b")
# Between two words of a citation; a comment's next line may hold the second.
GAP = r"[ \t]*(?:\n[ \t]*(?://[/!]?|\*|#|>)?[ \t]*)?"
WORD = re.compile(rf",{GAP}([A-Z][a-z]+)\b")
OUTSIDE = re.compile(r"\b(?:DESIGN|STYLE) [0-9]")


def findings(tree):
    for file in tree.files:
        text = tree.text(file)
        yield from missing_documents(tree, file, text)
        for found in OUTSIDE.finditer(text):
            yield Finding(file, line_of(text, found.start()),
                          f"cites {found.group(0)}, which is not in the repository; docs/design.md is")


def missing_documents(tree, file, text):
    for found in DOCUMENT.finditer(text):
        document = found.group(0)
        if document.endswith("/NAME.md"):
            continue
        if not tree.holds(document):
            yield Finding(file, line_of(text, found.start()), f"cites {document}, which git does not track")
            continue
        known = heading_pattern(["Heading", *markdown.headings(tree.text(document))])
        at = found.end()
        while word := WORD.match(text, at):
            heading = known.match(text, word.start(1))
            if heading is None:
                yield Finding(file, line_of(text, word.start(1)),
                              f"cites {document}, {word.group(1)}: no heading of that name")
                break
            at = heading.end()


def heading_pattern(headings):
    """Any of the headings, the longest first, over line breaks."""
    longest_first = sorted(headings, key=len, reverse=True)
    return re.compile("|".join(GAP.join(map(re.escape, heading.split())) + r"\b" for heading in longest_first if heading))
