# SPDX-License-Identifier: Apache-2.0
"""Starts programs, and ends them all when the report ends, however it ends."""
import contextlib
import os
import signal
import struct
import subprocess
import sys
import threading
import time


class Failure(Exception):
    """One line for the user: the program and its error."""


_running = []


def start(command, log, env=None, priority=None, stdout=None):
    """Starts a program in the background; its output goes to `log` (its standard output to `stdout` if given).
    priority: SCHED_FIFO for all of its threads, or None."""
    def before():
        os.setpgid(0, 0)  # so that Ctrl-C reaches this script only
        if priority is not None:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))

    with open(log, "ab") as file:
        try:
            process = subprocess.Popen([str(word) for word in command], env=env, stdin=subprocess.DEVNULL,
                                       stdout=stdout or file, stderr=file, preexec_fn=before)
        except OSError as error:
            raise Failure(f"{command[0]}: {error.strerror}") from error
    process.log = log
    _running.append(process)
    return process


def end(process, patience=8.0):
    """Ends a program by SIGTERM (after waking a stopped one), or by SIGKILL. @return its exit code"""
    if process.poll() is None:
        for number in (signal.SIGCONT, signal.SIGTERM):
            process.send_signal(number)
        try:
            process.wait(patience)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
    if process.stdout is not None:
        process.stdout.close()
    if process in _running:
        _running.remove(process)
    return process.returncode


def end_all():
    for process in list(_running):
        end(process)


def end_on_signals():
    def leave(number, _):
        sys.exit(128 + number)  # the finally clause ends the programs

    signal.signal(signal.SIGTERM, leave)
    signal.signal(signal.SIGHUP, leave)


def output_of(command, log, seconds, env=None, priority=None):
    """Runs a program to its end. @return its standard output. @throw Failure when it fails or takes longer"""
    process = start(command, log, env, priority, stdout=subprocess.PIPE)
    try:
        text, _ = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired as error:
        raise Failure(f"{command[0]} did not end within {seconds:.0f} s; its messages are in {log}") from error
    finally:
        end(process)
    if process.returncode != 0:
        raise Failure(f"{command[0]} ended with code {process.returncode}: {last_line(log)}")
    return text.decode()


def last_line(log):
    with open(log, encoding="utf-8", errors="replace") as file:
        lines = [line.strip() for line in file if line.strip()]
    return lines[-1] if lines else "no message"


@contextlib.contextmanager
def awake():
    """Keeps the processors out of deep sleep for all programs alike. @return whether the system allows it"""
    try:
        file = os.open("/dev/cpu_dma_latency", os.O_WRONLY)
    except OSError:
        yield False
        return
    try:
        os.write(file, struct.pack("i", 0))
        yield True
    finally:
        os.close(file)


class Slowed:
    """A program that gets a tenth of the time: it runs for 10 ms and is stopped for 90 ms."""

    def __init__(self, process):
        self._process = process
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self):
        while not self._over.is_set() and self._process.poll() is None:
            self._process.send_signal(signal.SIGSTOP)
            time.sleep(0.09)
            self._process.send_signal(signal.SIGCONT)
            time.sleep(0.01)

    def end(self):
        self._over.set()
        self._thread.join()


@contextlib.contextmanager
def busy(processors, log):
    """An endless loop on each of these processors."""
    loops = [start(["taskset", "-c", str(cpu), "bash", "-c", "while :; do :; done"], log) for cpu in processors]
    try:
        yield
    finally:
        for loop in loops:
            end(loop)
