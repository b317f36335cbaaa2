# SPDX-License-Identifier: Apache-2.0
"""Sizes in bytes of the 1 kHz types on the wire, from idl/palpate.idl."""
import re

from .processes import Failure

_SIZES = {"boolean": 1, "unsigned long": 4, "long": 4, "unsigned long long": 8, "long long": 8, "double": 8, "float": 4}
_LENGTH = 4  # of an appendable struct, before its members
_LARGEST_ALIGNMENT = 4


def size_of(idl, struct):
    """Bytes of an appendable struct of numbers and arrays of them in XCDR2: each number at a multiple of its size, or of 4.
    @throw Failure when the struct is missing or has other members"""
    body = re.search(r"struct " + struct + r" \{(.*?)\};", idl.read_text(encoding="utf-8"), re.S)
    if body is None:
        raise Failure(f"{idl} has no struct {struct}")
    size = _LENGTH
    for line in body.group(1).splitlines():
        line = line.split("//")[0].strip()
        if not line:
            continue
        member = re.fullmatch(r"(?:@key )?([a-z ]+) \w+(?:\[(\d+)\])?;", line)
        if member is None or member.group(1) not in _SIZES:
            raise Failure(f"{idl}: struct {struct}: '{line}' is not a number")
        number = _SIZES[member.group(1)]
        step = min(number, _LARGEST_ALIGNMENT)
        size = -(-size // step) * step + number * int(member.group(2) or 1)
    return size
