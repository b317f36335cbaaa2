# SPDX-License-Identifier: Apache-2.0
"""The server and the viewer that are soaked, and where on the organ tools play."""
import atexit
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import time

from latency_report import processes
from latency_report.processes import Failure

from . import samples

PROGRAMS = ("palpate-server", "palpate-viewer", "palpate-latency", "palpate-tool", "palpate-device", "palpate-watch",
            "palpate-parameters", "palpate-list")
# Of a field's readers none shows more than 60 a second. With each tick they would cost a machine more than all else does here.
SURFACE_RATE = 60
LOGS = ("server", "viewer", "tools", "hostile", "visitors", "questions", "asked")


class Stage:
    """@throw Failure naming a missing program or file, or saying why the server does not begin"""

    def __init__(self, options, tools):
        self.bin, self.out, self.rate = options.bin, options.output, options.rate
        self.hostile = None if options.no_hostile else options.bin.parent / "tests/hostile_peer"
        for file in [options.model, *options.swap, *(self.bin / name for name in PROGRAMS), *([self.hostile] if self.hostile else [])]:
            if not file.exists():
                raise Failure(f"{file} is not there: tools/demo makes the default model, a build the programs")
        self.out.mkdir(parents=True, exist_ok=True)
        for name in LOGS:
            self.log(name).unlink(missing_ok=True)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="models-", dir=self.out))
        atexit.register(shutil.rmtree, self.folder, ignore_errors=True)
        self.env = dict(os.environ, CYCLONEDDS_URI=_shell(tools, 'use_loopback; printf %s "$CYCLONEDDS_URI"'))
        self.domain = _shell(tools, "free_domain").strip()
        self.models = self._folder_of_models([options.model, *options.swap])
        self.server = processes.start([self.bin / "palpate-server", "--model", options.model, "--models", self.folder,
                                       "--domain", self.domain, "--rate", options.rate, "--surface-rate", SURFACE_RATE],
                                      self.out / "server.log", self.env)
        try:
            self.top, self.places, self.tip_radius = self._look_at_the_organ()
        except Failure as error:
            if self.server.poll() is not None:
                raise Failure(f"palpate-server: {processes.last_line(self.log('server'))}") from error
            raise
        self.modulus = self.asked(["palpate-parameters"], 20.0)["youngs_modulus_Pa"]
        self.tick = samples.thread_named(self.server.pid, "tick")
        if self.tick is None:
            raise Failure("palpate-server has no tick thread")
        self.viewer, self.port = self._start_viewer()

    def ask_for(self, model):
        """Again where another one is on its way. @throw Failure when the server does not take it"""
        for tries_left in range(7, -1, -1):
            try:
                self.asked(["palpate-parameters", "--model", model, "--wait", 10], 20.0)
                return
            except Failure:
                if tries_left == 0 or self.server.poll() is not None:
                    raise
                time.sleep(0.5)

    def _folder_of_models(self, files):
        """Names within the server's folder of models; a link that leads out of it would be refused."""
        names = [f"{i}.h5" for i in range(len(files))]
        for name, file in zip(names, files):
            try:
                os.link(file, self.folder / name)
            except OSError:
                shutil.copy(file, self.folder / name)
        return names

    def log(self, name):
        return self.out / f"{name}.log"

    def command(self, words):
        """A program of palpate on this domain, with --json."""
        return [self.bin / words[0], "--domain", self.domain, "--json", *words[1:]]

    def asked(self, words, seconds):
        """What a program says with --json. @throw Failure when it fails"""
        return json.loads(processes.output_of(self.command(words), self.log("asked"), seconds, self.env))

    def _look_at_the_organ(self):
        """Presses once, while the surface is written. @return the highest place with its normal, three more for other tools, the
        tip's radius"""
        surface = self.out / "surface.vtk"
        watch = processes.start(self.command(["palpate-watch", "--seconds", 2, "--wait", 60, "--vtk", surface]), self.log("asked"),
                                self.env, stdout=subprocess.DEVNULL)
        pressed = self.asked(["palpate-tool", "--seconds", 2, "--wait", 60], 90.0)
        watch.wait(90.0)
        processes.end(watch)
        top = pressed["position"]
        points = [p for p in points_of(surface) if p[2] > 0.5 * top[2]]
        places = apart(points, top, 3)
        return (top, pressed["normal"]), places, pressed["tip_radius"]

    def touch(self):
        """Where a tip's centre just touches the organ from above, m."""
        (position, normal) = self.top
        return [p + self.tip_radius * n for p, n in zip(position, normal)]

    def _start_viewer(self):
        """Its page is a word: no browser comes. @return the process and its port"""
        page = self.out / "page"
        page.mkdir(exist_ok=True)
        (page / "index.html").write_text("<!doctype html><title>soak</title>", encoding="utf-8")
        viewer = self.a_viewer(page, self.out / "viewer.json")
        for _ in range(200):
            time.sleep(0.1)
            said = (self.out / "viewer.json").read_text(encoding="utf-8")
            if said.endswith("\n"):
                return viewer, json.loads(said)["port"]
            if viewer.poll() is not None:
                break
        raise Failure(f"palpate-viewer does not listen: {processes.last_line(self.log('viewer'))}")

    def a_viewer(self, page, said):
        with open(said, "wb") as file:
            return processes.start(self.command(["palpate-viewer", "--port", 0, "--page", page]), self.log("viewer"), self.env,
                                   stdout=file)


def points_of(vtk):
    """The points of a VTK file in words, as palpate-watch writes it."""
    words = iter(pathlib.Path(vtk).read_text(encoding="utf-8").partition("POINTS ")[2].split())
    count = int(next(words))
    next(words)  # the numbers' type
    return [tuple(float(next(words)) for _ in range(3)) for _ in range(count)]


def apart(points, first, count):
    """Places far from the first, and from each other."""
    chosen = [tuple(first)]
    for _ in range(count):
        chosen.append(max(points, key=lambda p: min(sum((a - b) ** 2 for a, b in zip(p, q)) for q in chosen)))
    return chosen[1:]


def _shell(tools, command):
    result = subprocess.run(["bash", "-c", f"source {tools}/common.sh; {command}"], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise Failure(f"tools/common.sh: {result.stderr.strip()}")
    return result.stdout
