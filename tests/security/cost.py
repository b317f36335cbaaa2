#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What signed and encrypted topics cost: one server for each kind of protection, each on a domain of its own, measured in turn
by palpate-latency, so that the machine's other work meets all of them. Prints medians over the rounds, us."""
import argparse
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = ROOT / "build/release/bin"
# metadata (submessages), data (payload), rtps (messages); the first is what palpate-security makes
PROTECTIONS = {
    "submessages encrypted": ("ENCRYPT", "NONE", "NONE"),
    "submessages signed": ("SIGN", "NONE", "NONE"),
    "payload encrypted": ("NONE", "ENCRYPT", "NONE"),
    "submessages, and messages signed": ("ENCRYPT", "NONE", "SIGN"),
}
FIGURES = ("pose_to_force_less_wait_us", "force_out_us", "tick_us")


def run(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def make(folder, kinds):
    """Identities for each protection, whose governance the authority signs as palpate-security does."""
    authority = folder / "authority"
    run(BIN / "palpate-security", "init", "--folder", authority)
    for role in ("server", "driver"):
        run(BIN / "palpate-security", "issue", role, role, "--folder", authority)
    signed = (authority / "governance.p7s").read_text()
    document = signed[signed.index("<?xml"):signed.index("</dds>") + 7].replace("\r", "")
    for kind in kinds:
        for name, value in zip(("metadata", "data", "rtps"), PROTECTIONS[kind]):
            document = re.sub(f"<{name}_protection_kind>[A-Z]*", f"<{name}_protection_kind>{value}", document)
        plain, out = folder / "governance.xml", folder / "governance.p7s"
        plain.write_text(document)
        run("openssl", "smime", "-sign", "-text", "-in", plain, "-out", out, "-signer", authority / "permissions_authority.pem",
            "-inkey", authority / "private/permissions_authority.key")
        for role in ("server", "driver"):
            shutil.copytree(authority / "issued" / role, folder / kind / role)
            shutil.copy(out, folder / kind / role / "governance.p7s")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("model", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=10.0, help="of each measurement")
    parser.add_argument("--rounds", type=int, default=6)
    parser.add_argument("--domain", type=int, default=60, help="the first of five")
    arguments = parser.parse_args()
    os.environ["CYCLONEDDS_URI"] = subprocess.run(
        ["bash", "-c", f"source {ROOT}/tools/common.sh; use_loopback; printf %s \"$CYCLONEDDS_URI\""],
        check=True, capture_output=True, text=True).stdout
    model = arguments.model.resolve()
    kinds = ["none", *PROTECTIONS]
    found = {kind: [] for kind in kinds}
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        make(folder, PROTECTIONS)

        def words(kind, role):
            domain = ["--domain", str(arguments.domain + kinds.index(kind))]
            return domain if kind == "none" else [*domain, "--security", str(folder / kind / role)]

        servers = [subprocess.Popen([BIN / "palpate-server", "--model", model, "--listen-first", "0", *words(kind, "server")],
                                    stderr=subprocess.DEVNULL) for kind in kinds]
        try:
            for _ in range(arguments.rounds):
                for kind in kinds:
                    done = subprocess.run([BIN / "palpate-latency", "--seconds", str(arguments.seconds), "--json",
                                           *words(kind, "driver")], check=True, stdout=subprocess.PIPE, text=True)
                    found[kind].append(json.loads(done.stdout))
        finally:
            for server in servers:
                server.terminate()
            for server in servers:
                server.wait()
    print(f"{'p50 / p99, us':34}", *(f"{figure:>28}" for figure in FIGURES), "  lost")
    for kind, reports in found.items():
        middle = [f"{statistics.median(r[f]['p50'] for r in reports):.0f} / "
                  f"{statistics.median(r[f]['p99'] for r in reports):.0f}" for f in FIGURES]
        print(f"{kind:34}", *(f"{text:>28}" for text in middle), f"{sum(r['lost'] for r in reports):6}")


if __name__ == "__main__":
    main()
