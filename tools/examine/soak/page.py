# SPDX-License-Identifier: Apache-2.0
"""A page of palpate-viewer without a browser: takes frames over a WebSocket and acknowledges them (clients/viewer/PROTOCOL.md)."""
import base64
import json
import os
import socket
import struct
import threading
import time

_FRAME = 2  # kind of a message that asks for an acknowledgement


class Page:
    """Looks for `seconds`, then goes: as a page does that closes, or without a word. `frames`: how many it took."""

    def __init__(self, port, seconds, polite):
        self.frames, self.failed = 0, ""
        self._thread = threading.Thread(target=self._run, args=(port, seconds, polite), daemon=True)
        self._thread.start()

    def join(self, seconds):
        self._thread.join(seconds)

    def alive(self):
        return self._thread.is_alive()

    def _run(self, port, seconds, polite):
        try:
            with socket.create_connection(("127.0.0.1", port), timeout=10.0) as link, link.makefile("rb") as incoming:
                self._enter(link, incoming, port)
                end = time.monotonic() + seconds
                while time.monotonic() < end:
                    self._take(link, incoming)
                if polite:
                    link.sendall(_masked(0x8, struct.pack(">H", 1000)))
        except OSError as error:
            self.failed = str(error)

    @staticmethod
    def _enter(link, incoming, port):
        key = base64.b64encode(os.urandom(16)).decode()
        host = f"127.0.0.1:{port}"
        link.sendall((f"GET /ws HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                      f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n"
                      "Sec-WebSocket-Protocol: palpate.viewer.v1\r\n\r\n").encode())
        status = incoming.readline()
        while incoming.readline().strip():
            pass
        if b" 101 " not in status:
            raise OSError(f"the viewer answered {status.decode(errors='replace').strip()}")

    def _take(self, link, incoming):
        first, second = _exactly(incoming, 2)
        length = second & 0x7F
        if length == 126:
            length = struct.unpack(">H", _exactly(incoming, 2))[0]
        elif length == 127:
            length = struct.unpack(">Q", _exactly(incoming, 8))[0]
        message = _exactly(incoming, length)
        if first & 0xF == 0x8:
            raise OSError(f"the viewer shut the page out: {message[2:].decode(errors='replace')}")
        if first & 0xF == 0x9:
            link.sendall(_masked(0xA, message))
        elif first & 0xF == 0x2 and length >= 8 and struct.unpack("<I", message[:4])[0] == _FRAME:
            self.frames += 1
            link.sendall(_masked(0x1, json.dumps({"type": "ack", "seq": struct.unpack("<I", message[4:8])[0]}).encode()))


def _exactly(incoming, count):
    data = incoming.read(count)
    if len(data) != count:
        raise OSError("the viewer hung up")
    return data


def _masked(kind, data):
    """A frame as clients send them; shorter than 126 bytes."""
    mask = os.urandom(4)
    return struct.pack(">BB", 0x80 | kind, 0x80 | len(data)) + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(data))
