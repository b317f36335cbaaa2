#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What is wrong with a report's page, one line each: page_faults.py REPORT.html. Elements must nest, links lead somewhere in the
page, pictures be whole SVGs with a text beside them, no text be missing, and nothing be loaded from elsewhere."""
import base64
import html.parser
import re
import sys
import xml.etree.ElementTree

TEXTS = {"title", "h1", "h2", "h3", "p", "li", "th", "td", "caption", "figcaption", "pre", "code"}
VOID = {"meta", "link", "img", "br", "hr", "input"}
PICTURE = "data:image/svg+xml;base64,"
NO_NUMBER = re.compile(r"(?<![a-z])(?:nan|inf|NaN|Infinity)(?![a-z])")  # in a path too: "M1.0 nanH3"


class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.open, self.faults, self.ids, self.links = [], [], set(), []
        self.said = []  # in each open element, whether there is text

    def fault(self, text):
        self.faults.append(f"line {self.getpos()[0]}: {text}")

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        if len(values) != len(attributes):
            self.fault(f"<{tag}> repeats an attribute")
        if "id" in values and values["id"] in self.ids:
            self.fault(f"id {values['id']} is there twice")
        self.ids.add(values.get("id"))
        if tag not in VOID:
            self.open.append(tag)
            self.said.append(False)
        if tag in ("script", "iframe", "object", "link") or any(name.startswith("on") for name in values):
            self.fault(f"<{tag} {values}> runs or loads something")
        if tag == "a":
            self.links.append(values.get("href", ""))
        if tag == "img":
            self.picture(values)

    def handle_startendtag(self, tag, attributes):
        self.fault(f"<{tag}/> closes itself")

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.fault(f"</{tag}> closes nothing")
        elif not self.said.pop() and tag in TEXTS:
            self.fault(f"<{tag}> is empty")

    def handle_data(self, data):
        if data.strip():
            self.said = [True] * len(self.said)

    def picture(self, values):
        source = values.get("src", "")
        if not values.get("alt"):
            self.fault("a picture has no text beside it")
        if not source.startswith(PICTURE):
            self.fault(f"a picture is elsewhere: {source[:60]}")
            return
        root = xml.etree.ElementTree.fromstring(base64.b64decode(source[len(PICTURE):], validate=True))
        if not root.tag.endswith("svg"):
            self.fault(f"a picture is <{root.tag}>")
        for element in root.iter():
            for text in (element.text, element.tail, *element.attrib.values()):
                for word in NO_NUMBER.findall(text or ""):
                    self.fault(f"a picture's <{element.tag.rpartition('}')[2]}> has {word}")


def main(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    page = Page()
    page.feed(text)
    page.close()
    page.faults += [f"<{tag}> stays open" for tag in page.open]
    page.faults += [f"link to {href} leads nowhere" for href in page.links if href[1:] not in page.ids or href[:1] != "#"]
    if not text.startswith("<!DOCTYPE html>"):
        page.faults.append("no doctype")
    if "url(" in text:
        page.faults.append("a style loads something")
    print("\n".join(page.faults), end="")


main(sys.argv[1])
