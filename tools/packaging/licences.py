# SPDX-License-Identifier: Apache-2.0
"""Licences as SPDX names: of Debian packages, by their copyright files, and of what emscripten links."""
import base64
import functools
import hashlib
import pathlib
import re

# Debian's short names (DEP-5, and spellings beside it) that say the same as a name of SPDX's list.
SPDX = {
    "agpl-3": "AGPL-3.0-only", "apache-2": "Apache-2.0", "apache-2.0": "Apache-2.0", "bsd-2-clause": "BSD-2-Clause",
    "bsd-3-clause": "BSD-3-Clause", "bsd-c3": "BSD-3-Clause", "bsd3": "BSD-3-Clause", "bsl-1.0": "BSL-1.0", "cddl-1.0": "CDDL-1.0",
    "curl": "curl", "epl-2": "EPL-2.0", "expat": "MIT", "ftl": "FTL", "gpl-2": "GPL-2.0-only", "gpl-2+": "GPL-2.0-or-later",
    "gpl-2.0": "GPL-2.0-only", "gpl-2.0+": "GPL-2.0-or-later", "gpl-3": "GPL-3.0-only", "gpl-3+": "GPL-3.0-or-later",
    "gpl-3.0": "GPL-3.0-only", "isc": "ISC", "lgpl-2.1": "LGPL-2.1-only", "lgpl-2.1+": "LGPL-2.1-or-later",
    "lgpl-3+": "LGPL-3.0-or-later", "libpng": "Libpng", "mpl-2": "MPL-2.0", "mpl-2.0": "MPL-2.0", "ncsa": "NCSA",
    "openldap-2.8": "OLDAP-2.8", "sgi-2": "SGI-B-2.0", "zlib": "Zlib",
}
EMSCRIPTEN = pathlib.Path("/usr/share/emscripten/system")


def spdx_name(debian):
    """An expression of SPDX for one of Debian's; none where a part of it has no name there."""
    parts = re.split(r"\s+(or|and)\s+", debian.strip())
    names = [SPDX.get(part.lower()) for part in parts[::2]]
    if None in names:
        return None
    words = [word.upper() for word in parts[1::2]]
    if len(set(words)) > 1:
        return None  # which of them binds more is not said
    return f" {words[0]} ".join(names) if words else names[0]


class Texts:
    """Licences that SPDX has no name for, by their text."""

    def __init__(self):
        self.texts = {}

    def named(self, text, of):
        identity = "LicenseRef-" + hashlib.sha256(text.encode()).hexdigest()[:16]
        self.texts.setdefault(identity, {"licenseId": identity, "extractedText": text, "name": f"copyright file of {of}"})
        return identity

    def document(self):
        return [self.texts[key] for key in sorted(self.texts)]

    def of_debian(self, name):
        """What the package's copyright file says of all files but Debian's own; the whole of it where that has no name, or
        differs from file to file: one source package may hold a library under one licence and programs under another."""
        text = pathlib.Path("/usr/share/doc", name, "copyright").read_text(errors="replace")
        stanzas = re.findall(r"^Files:\s*(.*?)^License:\s*(\S.*?)$", text, re.M | re.S)
        said = {licence.strip() for files, licence in stanzas if not files.startswith("debian/")}
        return (len(said) == 1 and spdx_name(said.pop())) or self.named(text, name)

    def of_npm(self, entry, folder):
        """What the package's entry of the lock file says, or the text that it points at."""
        licence = entry.get("license", "")
        if found := re.fullmatch(r"SEE LICENSE IN (\S+)", licence):
            return self.named((folder / found.group(1)).read_text(), folder.name)
        return licence.strip("()")


def npm_checksum(entry):
    """Of the lock file's integrity, which npm ci compares with what it fetched."""
    algorithm, digest = entry["integrity"].split("-", 1)
    return {"algorithm": algorithm.upper(), "checksumValue": base64.b64decode(digest).hex()}


@functools.cache
def emscripten_libraries():
    """Name, version and licence of what emscripten's linker takes from its own sources."""
    llvm = (EMSCRIPTEN / "lib/libcxx/include/__libcpp_version").read_text().strip()
    llvm = f"{int(llvm) // 1000}.{int(llvm) // 100 % 10}.{int(llvm) % 100}"
    musl = (EMSCRIPTEN / "lib/libc/musl/VERSION").read_text().strip()
    malloc = re.search(r"Version (\d+\.\d+\.\d+)", (EMSCRIPTEN / "lib/dlmalloc.c").read_text()).group(1)
    exception = "Apache-2.0 WITH LLVM-exception"
    return [("musl", musl, "MIT"), ("libc++", llvm, exception), ("libc++abi", llvm, exception), ("compiler-rt", llvm, exception),
            ("dlmalloc", malloc, "CC0-1.0")]
