# SPDX-License-Identifier: Apache-2.0
"""Programs that follow the displacement field while forces are measured."""
import json
import signal
import subprocess
import time

from . import processes
from .processes import Failure


class Viewers:
    """`count` palpate-watch; with `hampered` the first is stopped and the second gets a tenth of the time."""

    def __init__(self, setup, count, hampered=False):
        self._setup = setup
        seconds = setup.seconds + 5.0
        command = [setup.bin / "palpate-watch", "--domain", setup.domain, "--seconds", seconds, "--wait", 60, "--json"]
        self._all = [processes.start(command, setup.log("watch"), setup.env, stdout=subprocess.PIPE) for _ in range(count)]
        self._slow = None
        if count > 0:
            time.sleep(1.5)  # for discovery of the server
        if hampered:
            self._all[0].send_signal(signal.SIGSTOP)
            self._slow = processes.Slowed(self._all[1])
        self._well = self._all[2:] if hampered else self._all

    def end(self):
        """@throw Failure when an unhampered viewer received nothing and so was no load"""
        if self._slow is not None:
            self._slow.end()
        seen = []
        for viewer in self._well:
            try:
                text, _ = viewer.communicate(timeout=self._setup.seconds + 30.0)
                seen.append(json.loads(text)["rate_hz"])
            except (subprocess.TimeoutExpired, json.JSONDecodeError) as error:
                raise Failure(f"palpate-watch: {processes.last_line(self._setup.log('watch'))}") from error
        for viewer in self._all:
            processes.end(viewer)
        if any(rate <= 0.0 for rate in seen):
            raise Failure("a viewer received no field")
        return seen
