# SPDX-License-Identifier: Apache-2.0
"""What links what, read from the CMakeLists.txt: no configuring, all branches of an if() at once.

Followed: target_link_libraries and $<TARGET_OBJECTS:...> with variables of set() and foreach(), and functions and
macros of the repository with their arguments. Options and generator expressions are seen through.
"""
import itertools
import posixpath
import re
from typing import NamedTuple

TOKEN = re.compile(r'\s+|#[^\n]*|"(?:\\.|[^"\\])*"|[()]|[^\s()"#]+')
VARIABLE = re.compile(r"\$\{(\w+)\}")
OBJECTS = re.compile(r"\$<TARGET_OBJECTS:([^>]+)>")
INNER = re.compile(r"\$<[\w_]+:([^<>$]+)>")
KEYWORDS = {"PUBLIC", "PRIVATE", "INTERFACE"}


class Command(NamedTuple):
    file: str
    line: int
    name: str
    arguments: list  # of texts; a quoted one keeps its spaces


class Link(NamedTuple):
    file: str
    line: int
    target: str
    library: str


def commands(file, text):
    """Every command of a file, in order."""
    at, line, depth, found = 0, 1, 0, []
    name = None
    while at < len(text):
        token = TOKEN.match(text, at)
        if token is None:  # a quote that is not closed: CMake refuses the file
            return found
        word = token.group(0)
        if word == "(":
            depth += 1
            if depth == 1:
                found.append(Command(file, name[1], name[0].lower(), []))
        elif word == ")":
            depth -= 1
        elif not word.isspace() and not word.startswith("#"):
            if depth == 0:
                name = (word, line)
            else:
                found[-1].arguments.append(word[1:-1] if word.startswith('"') else word)
        line += word.count("\n")
        at = token.end()
    return found


def expanded(text, variables):
    """A text with its variables replaced: one for each value that they may have."""
    names = list(dict.fromkeys(name for name in VARIABLE.findall(text) if name in variables))
    for values in itertools.product(*(variables[name] for name in names)):
        known = dict(zip(names, values))
        yield VARIABLE.sub(lambda found: known.get(found.group(1), found.group(0)), text)


class Links:
    """@param files  {path: text} of CMakeLists.txt and .cmake files"""

    def __init__(self, files):
        self.folders = {}  # of each target
        self.links = []
        self._aliases = {}
        self._functions = {}
        bodies = {file: self._without_functions(commands(file, text)) for file, text in files.items()}
        for file, body in bodies.items():
            self._run(body, posixpath.dirname(file), {})

    def between_targets(self):
        """Links whose both ends are targets of the repository."""
        for link in self.links:
            library = self._aliases.get(link.library, link.library)
            target = self._aliases.get(link.target, link.target)
            if library in self.folders and target in self.folders:
                yield Link(link.file, link.line, target, library)

    def _without_functions(self, body):
        """Remembers functions and macros by their names; returns the other commands."""
        outside, function = [], None
        for command in body:
            if command.name in ("function", "macro"):
                function = self._functions.setdefault(command.arguments[0].lower(), (command.arguments[1:], []))
            elif command.name in ("endfunction", "endmacro"):
                function = None
            elif function is not None:
                function[1].append(command)
            else:
                outside.append(command)
        return outside

    def _run(self, body, folder, variables, depth=0):
        for command in body:
            words = [value for word in command.arguments for text in expanded(word, variables)
                     for value in text.split(";") if value]
            if command.name == "set" and words:
                variables.setdefault(words[0], []).extend(words[1:])
            elif command.name == "foreach" and words:
                variables[words[0]] = [word for word in words[1:] if word not in ("IN", "ITEMS", "LISTS")]
            elif command.name == "cmake_parse_arguments":
                self._parse_arguments(command, variables)
            elif command.name in ("add_library", "add_executable"):
                self._add(command, folder, variables)
            elif command.name == "target_link_libraries":
                self._link(command, variables)
            elif command.name == "target_sources":
                for target in expanded(command.arguments[0], variables):
                    for library in OBJECTS.findall(" ".join(words)):
                        self.links.append(Link(command.file, command.line, target, library))
            elif command.name in self._functions and depth < 8:
                names, inner = self._functions[command.name]
                given = {name: [word] for name, word in zip(names, words)}
                given["ARGN"], given["ARGV"] = words[len(names):], words
                self._run(inner, folder, given, depth + 1)

    def _add(self, command, folder, variables):
        for name in expanded(command.arguments[0], variables):
            if command.arguments[1:2] == ["ALIAS"]:
                self._aliases[name] = command.arguments[2]
            elif "IMPORTED" not in command.arguments:
                self.folders[name] = folder

    def _link(self, command, variables):
        for target in expanded(command.arguments[0], variables):
            for word in command.arguments[1:]:
                for text in expanded(word, variables):
                    for library in re.split(r"[;\s]+", text):
                        while inner := INNER.fullmatch(library):
                            library = inner.group(1)
                        if library not in KEYWORDS:
                            self.links.append(Link(command.file, command.line, target, library))

    @staticmethod
    def _parse_arguments(command, variables):
        """PREFIX_NAME for every word that follows NAME among the function's arguments."""
        prefix, switches, single, several = command.arguments[:4]
        names, key = set(re.split(r"[;\s]+", f"{switches};{single};{several}")), None
        for word in variables.get("ARGN", variables.get("ARGV", [])):
            if word in names:
                key = word
            elif key is not None:
                variables.setdefault(f"{prefix}_{key}", []).append(word)
