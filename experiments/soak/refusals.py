"""Hostile and broken senders: each is refused, and the belief is what it was."""

from __future__ import annotations

import os
import random
import signal
import socket
import time
from collections.abc import Callable

from bad_input import bad_frames, bad_messages, bad_questions, bad_requests
from pair import Pair
from process import PATIENCE
from wire import Bus, first_fragment, short

HELD_OPEN = 12  # half-open connections at once
OTHERS = ["ANCHORD_EVENT", "ANCHORD_POSE", "ANCHORD_VERIFY_TRIGGER", "ANCHORD_VERIFY_RESULT",
          "ANCHORD_QUERY"]


class Refusals:
    def __init__(self, pair: Pair, buses: list[Bus], dice: random.Random):
        self.pair, self.buses, self.dice = pair, buses, dice
        self.v = pair.v
        self.half_open: list[socket.socket] = []

    # --- Over HTTP ------------------------------------------------------------------------------

    def frames(self) -> None:
        self.pair.at_rest(self._frames)

    def _frames(self) -> None:
        recent = self.pair.feed.recent
        newest = max((f for f in recent if f["sensor"] == recent[-1]["sensor"]),
                     key=lambda f: f["utime"])
        for what, body, wanted in self.dice.sample(bad_frames(newest, self.dice), 6):
            self._expect(what, "POST", "/v1/detections", body, wanted)

    def questions(self) -> None:
        def deed() -> None:
            for method, target, body, wanted in self.dice.sample(bad_questions(), 5):
                self._expect(f"{method} {target}", method, target, body, wanted)

        self.pair.at_rest(deed)

    def _expect(self, what: str, method: str, target: str, body: bytes | None,
                wanted: int) -> None:
        for daemon in self.pair.daemons:
            door = daemon.door()
            status, answer = door.ask(method, target, body)
            door.close()
            self.v.hold(status == wanted and b'"error"' in answer, "bad input",
                        f"{what} is answered {status}, not {wanted}: {answer[:300]!r}")

    def requests(self) -> None:
        """What is no HTTP, or too much of it."""
        for what, request, wanted in bad_requests():
            for daemon in self.pair.daemons:
                with socket.create_connection(("127.0.0.1", daemon.port), PATIENCE) as s:
                    s.sendall(request)
                    answer = s.recv(65536)
                fine = answer.startswith(b"HTTP/1.1 %d " % wanted)
                self.v.hold(fine, "bad HTTP", f"{what} is answered {answer[:200]!r}")

    def half_open_connections(self) -> None:
        """Begins requests that never end; the daemon closes them, or we do."""
        begun = [b"", b"GET /v1/st", b"POST /v1/detections HTTP/1.1\r\nHost: x\r\n",
                 b"POST /v1/detections HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n"
                 b'Content-Length: 100\r\n\r\n{"utime": 1']
        for daemon in self.pair.daemons:
            s = socket.create_connection(("127.0.0.1", daemon.port), PATIENCE)
            s.sendall(self.dice.choice(begun))
            self.half_open.append(s)
        while len(self.half_open) > HELD_OPEN:
            self.half_open.pop(0).close()

    # --- Over LCM -------------------------------------------------------------------------------

    def messages(self) -> None:
        """Bytes that are no frames, and no events, poses, triggers, results, questions."""
        def deed() -> None:
            good = self.pair.feed.hall
            for bus in self.buses:
                for message in bad_messages(good, self.dice):
                    bus.publish("ANCHORD_DETECTIONS", message)
                for channel in OTHERS:
                    bus.publish(channel, self.dice.randbytes(40))
                    bus.publish(channel, good)
            time.sleep(0.05)

        self.pair.at_rest(deed)

    # From here on to the shaken one alone: liblcm keeps what it gets, or dies.

    def deadly_fragment(self) -> None:
        """liblcm 1.3.1 adds offset and size in 32 bits and writes 4 GiB behind the message."""
        fragment = first_fragment("ANCHORD_DETECTIONS", 1024, 0xFFFFFFF0)
        self._expect_new_child(lambda _: self.buses[0].raw(fragment))

    def fragment_flood(self) -> None:
        """Messages of 15 MB that never become whole, each from elsewhere."""
        for number in range(200):
            with Bus.socket() as sender:
                self.buses[0].raw(first_fragment("ANCHORD_DETECTIONS", 15 << 20, 0, number), sender)

    def channel_flood(self) -> None:
        for number in range(5000):
            self.buses[0].raw(short(f"{self.dice.random()}{number:040}", b""))
            if number % 100 == 99:
                time.sleep(0.002)

    def kill_child(self) -> None:
        self._expect_new_child(
            lambda child: signal.pidfd_send_signal(os.pidfd_open(child), signal.SIGKILL))

    def _expect_new_child(self, deed: Callable[[int], None]) -> None:
        daemon = self.pair.shaken
        child = daemon.child()
        if not child:  # it dies often
            return
        deed(child)
        door = daemon.door()
        give_up = time.monotonic() + PATIENCE
        while daemon.child() in (0, child) or not door.status()["lcm"]["receiving"]:
            if time.monotonic() > give_up:
                self.v.tell("anchord-lcm", "is not started again")
                break
            time.sleep(0.01)
        door.close()
