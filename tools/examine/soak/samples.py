# SPDX-License-Identifier: Apache-2.0
"""What the kernel says of a process."""
import os
import pathlib

_PAGE = os.sysconf("SC_PAGE_SIZE")
_MIB = 1024.0 * 1024.0


def _text(path):
    try:
        return path.read_text(encoding="utf-8")
    except OSError:  # it has ended
        return ""


def _fields(pid, task=None):
    """The fields of /proc/PID/stat after the name, which may hold anything."""
    folder = pathlib.Path(f"/proc/{pid}") if task is None else pathlib.Path(f"/proc/{pid}/task/{task}")
    return _text(folder / "stat").rpartition(")")[2].split()


def thread_named(pid, name):
    """@return the id of the first thread of that name, or None"""
    tasks = pathlib.Path(f"/proc/{pid}/task")
    found = (task.name for task in sorted(tasks.iterdir()) if _text(task / "comm").strip() == name)
    return next(found, None)


def wakes(pid, task):
    """How often a thread went to sleep of its own will: once a tick. @return None when it has ended"""
    for line in _text(pathlib.Path(f"/proc/{pid}/task/{task}/status")).splitlines():
        if line.startswith("voluntary_ctxt_switches:"):
            return int(line.split()[1])
    return None


def faults(pid, task=None):
    """Page faults of a process, or of one of its threads: (without, with a disk)"""
    fields = _fields(pid, task)
    return (int(fields[7]), int(fields[9])) if fields else (0, 0)


def of_process(pid):
    """Memory in MiB, descriptors, threads, page faults. @return None when it has ended"""
    folder = pathlib.Path(f"/proc/{pid}")
    fields, pages = _fields(pid), _text(folder / "statm").split()
    if not fields or not pages or fields[0] == "Z":
        return None
    rollup = {line.split(":")[0]: line.split()[1] for line in _text(folder / "smaps_rollup").splitlines()[1:]}
    try:
        descriptors = len(os.listdir(folder / "fd"))
    except OSError:
        return None
    return {"rss": int(pages[1]) * _PAGE / _MIB, "pss": int(rollup.get("Pss", 0)) / 1024.0, "descriptors": descriptors,
            "threads": int(fields[17]), "minor_faults": int(fields[7]), "major_faults": int(fields[9])}
