#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Bill of materials, SPDX 2.3 as JSON: what palpate's packages link, as the loader finds it.

Usage: sbom.py STAGE BUILD VERSION > palpate.spdx.json
STAGE/PACKAGE holds the files of each package as installed, BUILD is the folder that Ninja built them in. Versions are
those of the Debian packages that the libraries and headers come from; the page's are those of package-lock.json, with its
checksums. Compilers, CMake, Ninja and npm's build tools are there as well.
"""
import functools
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import time

from licences import Texts, emscripten_libraries, npm_checksum

WEB = pathlib.Path("clients/viewer/web")
BUILD_TOOLS = ("g++-12", "gcc-12", "binutils", "cmake", "ninja-build", "cyclonedds-tools", "emscripten")

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def spdx_id(*names):
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", "-".join(names).replace("+", ".plus"))


def is_elf(path):
    return path.is_file() and not path.is_symlink() and path.open("rb").read(4) == b"\x7fELF"


@functools.cache
def needed(path):
    """The sonames that a program or library asks for itself."""
    return re.findall(r"\(NEEDED\).*\[(.*)\]", run("readelf", "--dynamic", "--wide", str(path)))


def libraries(path):
    """Soname -> file, of all that the loader brings in."""
    return {name: os.path.realpath(file) for name, file in re.findall(r"(\S+) => (/\S+)", run("ldd", str(path)))}


@functools.cache
def owners():
    """File -> Debian package, for all libraries and headers."""
    found = {}
    for line in run("dpkg-query", "--search", "*/lib/*.so*", "*/include/*").splitlines():
        if line.startswith("diversion by "):
            continue
        names, file = line.split(": ", 1)
        file = "/usr" + file if file.startswith("/lib") else file  # Debian's /lib is a link
        found[file] = names.split(",")[0].split(":")[0]
    return found


def package(identity, name, version, licence, **more):
    return {"SPDXID": identity, "name": name, "versionInfo": version, "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "licenseConcluded": "NOASSERTION", "licenseDeclared": licence, "copyrightText": "NOASSERTION"} | more


def reference(locator):
    return [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": locator}]


class Bill:
    def __init__(self):
        self.packages, self.files, self.relations, self.licences = {}, {}, set(), Texts()

    def relate(self, one, kind, other):
        self.relations.add((one, kind, other))

    def debian(self, name):
        """The SPDX id of an installed Debian package, which is noted."""
        identity = spdx_id("deb", name)
        if identity not in self.packages:
            version, architecture = run("dpkg-query", "--show", "--showformat=${Version}\n${Architecture}\n;", name).split(";")[0].split()
            self.packages[identity] = package(identity, name, version, self.licences.of_debian(name),
                                              externalRefs=reference(f"pkg:deb/debian/{name}@{version}?arch={architecture}"))
        return identity

    def links(self, identity, path, loaded):
        """Notes what `path` links, and what that links in turn."""
        for soname in needed(path):
            file = loaded.get(soname)
            if file is None or not (owner := owners().get(file)):
                continue  # the loader itself, or a library of ours
            linked = self.debian(owner)
            if identity != linked and (identity, "DYNAMIC_LINK", linked) not in self.relations:
                self.relate(identity, "DYNAMIC_LINK", linked)
            if file not in self.seen:
                self.seen.add(file)
                self.links(linked, file, loaded)

    def ours(self, folder, version):
        """One package of ours with its programs."""
        licence = "Apache-2.0"
        if folder.name == "palpate-solver":
            licence += " AND GPL-2.0-or-later AND GPL-3.0-or-later"
        identity = spdx_id(folder.name)
        self.packages[identity] = package(identity, folder.name, version, licence)
        self.relate("SPDXRef-DOCUMENT", "DESCRIBES", identity)
        for path in filter(is_elf, sorted(folder.rglob("*"))):
            name = str(path.relative_to(folder))
            program = spdx_id("File", name)
            content = path.read_bytes()
            self.files[program] = {"SPDXID": program, "fileName": "./" + name, "fileTypes": ["BINARY"], "checksums": [
                {"algorithm": algorithm.upper(), "checksumValue": hashlib.new(algorithm, content).hexdigest()}
                for algorithm in ("sha1", "sha256")],
                "licenseConcluded": "NOASSERTION", "licenseInfoInFiles": ["NOASSERTION"], "copyrightText": "NOASSERTION"}
            self.relate(identity, "CONTAINS", program)
            self.seen = set()
            self.links(program, path, libraries(path))

    def headers(self, build):
        """Packages whose headers were compiled in: some libraries are nothing else."""
        lines = run("ninja", "-C", str(build), "-t", "deps").splitlines()
        read = {os.path.normpath(build / line.strip()) for line in set(lines) if line.startswith("    ")}
        for name in sorted({owners()[file] for file in read if file in owners()}):
            self.relate(self.debian(name), "BUILD_DEPENDENCY_OF", spdx_id("palpate"))

    def page(self, stage):
        """What the page holds of npm, and of emscripten's libraries, which core as WebAssembly is linked with."""
        for name, version, licence in emscripten_libraries() if any(stage.rglob("*.wasm")) else []:
            identity = spdx_id("emscripten", name)
            self.packages[identity] = package(identity, name, version, licence)
            self.relate(spdx_id("palpate"), "STATIC_LINK", identity)
            self.relate(self.debian("emscripten"), "CONTAINS", identity)
        lock = json.loads((ROOT / WEB / "package-lock.json").read_text())
        for path, entry in lock["packages"].items():
            if not path or not (ROOT / WEB / path).exists():
                continue  # the page itself; what only other processors need
            name = path.rpartition("node_modules/")[2]
            identity = spdx_id("npm", name, entry["version"])
            self.packages[identity] = package(identity, name, entry["version"], self.licences.of_npm(entry, ROOT / WEB / path),
                                              checksums=[npm_checksum(entry)],
                                              externalRefs=reference(f"pkg:npm/{name.replace('@', '%40')}@{entry['version']}"))
            if entry.get("dev"):
                self.relate(identity, "BUILD_TOOL_OF", spdx_id("palpate"))
            else:
                self.relate(spdx_id("palpate"), "CONTAINS", identity)

    def tools(self):
        """What makes the programs and is in none of them."""
        installed = set(run("dpkg-query", "--show", "--showformat=${Package}\n").split())
        for name in BUILD_TOOLS:
            if name in installed:
                self.relate(self.debian(name), "BUILD_TOOL_OF", spdx_id("palpate"))

    def document(self, version):
        body = {"hasExtractedLicensingInfos": self.licences.document(),
                "packages": [self.packages[key] for key in sorted(self.packages)],
                "files": [self.files[key] for key in sorted(self.files)],
                "relationships": [{"spdxElementId": one, "relationshipType": kind, "relatedSpdxElement": other}
                                  for one, kind, other in sorted(self.relations)]}
        digest = hashlib.sha256(json.dumps(body).encode()).hexdigest()
        created = time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", time.time())))
        return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"palpate-{version}",
                "documentNamespace": f"https://palpate.invalid/spdx/{digest}",
                "creationInfo": {"created": time.strftime("%Y-%m-%dT%H:%M:%SZ", created), "creators": ["Tool: sbom.py"]}} | body


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    stage, build, version = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    bill = Bill()
    for folder in sorted(stage.iterdir()):
        bill.ours(folder, version)
    bill.headers(build)
    bill.page(stage)
    bill.tools()
    json.dump(bill.document(version), sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
