# SPDX-License-Identifier: Apache-2.0
"""What the checks read of Markdown: headings, links, code spans. Fenced blocks hold none of these."""
import re

FENCE = re.compile(r"^ {0,3}(`{3,}|~{3,})")
HEADING = re.compile(r"^ {0,3}#{1,6}\s+(.*?)(?:\s+#+)?\s*$")
SPAN = re.compile(r"(?<!`)(`+)(?!`)(.+?)(?<!`)\1(?!`)")
LINK = re.compile(r"\]\(\s*<?([^()\s<>]*(?:\([^()\s]*\)[^()\s<>]*)*)>?(?:\s+[\"'(][^)]*)?\)")
REFERENCE = re.compile(r"^ {0,3}\[[^\]]+\]:\s*<?(\S+?)>?(?:\s|$)")
HTML = re.compile(r"""<(?:a|img)\b[^>]*?\b(?:href|src)\s*=\s*["']([^"']+)["']""")
ANCHOR = re.compile(r"""<[a-z]+\b[^>]*?\b(?:name|id)\s*=\s*["']([^"']+)["']""")


def prose(text):
    """(number, line) of the lines outside fenced blocks."""
    fence = None
    for number, line in enumerate(text.splitlines(), 1):
        found = FENCE.match(line)
        if fence is None and found:
            fence = found.group(1)
        elif fence is not None:
            if found and found.group(1).startswith(fence) and not line.strip().strip(fence[0]):
                fence = None
        else:
            yield number, line


def headings(text):
    """Texts of the headings, without their marks."""
    return [found.group(1) for _, line in prose(text) if (found := HEADING.match(line))]


def anchors(text):
    """What may follow # in a link to this text: GitHub's slugs of its headings, and anchors written as HTML."""
    found, seen = set(), {}
    for heading in headings(text):
        plain = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        found.add(slug if count == 0 else f"{slug}-{count}")
    for _, line in prose(text):
        found.update(ANCHOR.findall(line))
    return found


def targets(text):
    """(line, target) of every link and image."""
    for number, line in prose(text):
        bare = SPAN.sub(lambda span: " " * len(span.group(0)), line)
        for pattern in (LINK, REFERENCE, HTML):
            for found in pattern.finditer(bare):
                yield number, found.group(1)


def spans(text):
    """(line, code) of every code span."""
    for number, line in prose(text):
        for found in SPAN.finditer(line):
            yield number, found.group(2)
