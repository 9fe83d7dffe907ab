"""LCM's datagrams, with nothing but the standard library: what a program on the bus may send, good
or bad, and what the daemon publishes. (lcm/docs/content/udp-multicast-protocol.md of LCM 1.3.)"""

from __future__ import annotations

import socket
import struct
import threading
from collections.abc import Callable

GROUP = "239.255.76.67"
SHORT, FRAGMENT = 0x4C433032, 0x4C433033  # "LC02", "LC03"


def short(channel: str, payload: bytes) -> bytes:
    """A whole message in one datagram."""
    return struct.pack("!II", SHORT, 1) + channel.encode() + b"\0" + payload


def first_fragment(channel: str, size: int, offset: int, number: int = 1) -> bytes:
    """The first of 300 fragments of a message of `size` bytes, said to lie at `offset`."""
    head = struct.pack("!IIIIHH", FRAGMENT, number, size, offset, 0, 300)
    return head + channel.encode() + b"\0" + bytes(32)


def text(value: str) -> bytes:
    """A string as LCM encodes it."""
    raw = value.encode() + b"\0"
    return struct.pack("!i", len(raw)) + raw


class Bus:
    """One LCM network: sends datagrams, and hears messages on a thread of its own."""

    def __init__(self, port: int):
        self.port = port
        self._out = self.socket()
        self._in = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._in.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._in.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        self._in.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
        self._in.bind((GROUP, port))
        member = socket.inet_aton(GROUP) + socket.inet_aton("0.0.0.0")
        self._in.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
        self.handlers: dict[str, Callable[[bytes], None]] = {}

    @property
    def url(self) -> str:
        return f"udpm://{GROUP}:{self.port}?ttl=0"

    @staticmethod
    def socket() -> socket.socket:
        """To send from; each is a sender of its own to whoever listens."""
        out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        return out

    def raw(self, datagram: bytes, sender: socket.socket | None = None) -> None:
        """Sends bytes as they are. What the kernel has no room for is lost, as LCM loses it."""
        try:
            (sender or self._out).sendto(datagram, (GROUP, self.port))
        except OSError:
            pass

    def publish(self, channel: str, payload: bytes) -> None:
        self.raw(short(channel, payload))

    def listen(self) -> None:
        threading.Thread(target=self._hear, daemon=True).start()

    def _hear(self) -> None:
        while True:
            datagram = self._in.recv(65536)
            if len(datagram) < 9 or struct.unpack("!I", datagram[:4])[0] != SHORT:
                continue
            end = datagram.find(b"\0", 8)
            handler = self.handlers.get(datagram[8:end].decode(errors="replace"))
            if handler:
                handler(datagram[end + 1 :])


def multicast_works() -> bool:
    """Whether this machine (or network namespace) has a multicast route."""
    try:
        with Bus.socket() as out:
            out.sendto(b"?", (GROUP, 9))
        return True
    except OSError:
        return False
