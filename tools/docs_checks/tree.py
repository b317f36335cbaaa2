# SPDX-License-Identifier: Apache-2.0
"""The files that git tracks, and their text."""
import functools
import pathlib
import subprocess
from typing import NamedTuple


class Finding(NamedTuple):
    file: str
    line: int
    what: str


class TreeError(RuntimeError):
    """The folder cannot be read as a repository; the text names it."""


class Tree:
    """@throw TreeError when root is not the top of a git repository"""

    def __init__(self, root):
        self.root = pathlib.Path(root).resolve()
        # A file that is tracked and was deleted is not part of the tree any more.
        self.files = [name for name in self._git("ls-files", "-z").split("\0") if name and (self.root / name).is_file()]
        if not self.files:
            raise TreeError(f"{self.root}: git tracks no file there")
        self._paths = {""}
        for name in self.files:
            self._paths.add(name)
            self._paths.update(str(parent) for parent in pathlib.PurePosixPath(name).parents if str(parent) != ".")
        self.top_folders = {name.split("/")[0] for name in self.files if "/" in name}

    def holds(self, path):
        """Whether a tracked file or a folder of one has this path."""
        return path.rstrip("/") in self._paths

    def matches(self, pattern):
        """Whether a file or folder matches a pattern with * or ?."""
        return any(pathlib.PurePosixPath(path).match(pattern) for path in self._paths if path)

    def ignored(self, path):
        """Whether git ignores it: it exists after a build only."""
        return subprocess.run(["git", "-C", str(self.root), "check-ignore", "-q", path], check=False).returncode == 0

    def named(self, name):
        """Files of this name, in whatever folder."""
        return [file for file in self.files if file.rsplit("/", 1)[-1] == name]

    @functools.lru_cache(maxsize=None)
    def text(self, file):
        """Empty for a file that is not text."""
        data = (self.root / file).read_bytes()
        if b"\0" in data:
            return ""
        return data.decode("utf-8", errors="replace")

    def _git(self, *arguments):
        try:
            return subprocess.run(["git", "-C", str(self.root), *arguments], check=True, capture_output=True,
                                  text=True).stdout
        except (OSError, subprocess.CalledProcessError) as error:
            reason = getattr(error, "stderr", None) or str(error)
            raise TreeError(f"{self.root}: git {arguments[0]}: {reason.strip()}") from error


def line_of(text, offset):
    """Number of the line that an offset lies in, from 1."""
    return text.count("\n", 0, offset) + 1
