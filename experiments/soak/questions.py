"""Asks a daemon without pause, checks each answer, and times it."""

from __future__ import annotations

import json
import random
import threading
import time
from collections import deque

from invariants import (
    Names,
    Violations,
    check_count,
    check_density,
    check_hypotheses,
    check_objects,
    check_where,
    is_probability,
)
from process import Daemon, Gone

PAUSE = 0.02  # s between two questions to one daemon
EVERYTHING = 1.0  # s between two looks at all anchors
PLACES = ["kitchen", "living_room", "hall", "bedroom", "bathroom", "study", "kitchen_table"]
CLASSES = ["cup", "mug", "glass", "book", "person", "cat", "keys", "fruit"]
COLORS = ["red", "green", "blue", "white", "black"]


class Asker(threading.Thread):
    """One thread, one daemon."""

    def __init__(self, daemon: Daemon, seed: int, v: Violations):
        super().__init__(daemon=True)
        self.target, self.v = daemon, v
        self.dice = random.Random(seed)
        self.names = Names()
        self.ids: list[str] = []
        self.utime = 0
        self.asked = 0
        self.latency_ms: deque[float] = deque(maxlen=100_000)
        self.ended = threading.Event()
        self._everything = 0.0

    def run(self) -> None:
        door = self.target.door()
        generation = 0
        while not self.ended.is_set():
            self.target.up.wait(0.1)
            if self.target.generation != generation:
                generation, self.utime = self.target.generation, 0
            try:
                self._ask(door)
            except Gone as gone:
                # Only who was killed may fail to answer.
                if self.target.up.is_set() and self.target.generation == generation:
                    time.sleep(0.05)
                    fine = not self.target.up.is_set() or self.target.generation != generation
                    self.v.hold(fine or self.ended.is_set(), "no answer", str(gone))
            except (KeyError, ValueError, TypeError, RuntimeError) as error:
                self.v.tell("answer", f"{self.target.name}: {error!r}")
            time.sleep(PAUSE)

    def _ask(self, door) -> None:
        if time.monotonic() >= self._everything:
            self._everything = time.monotonic() + EVERYTHING
            answer = check_objects(self._time(door, "/v1/objects?min_p=0"), self.v)
            self._follow(answer)
            self.names.follow(answer, self.v)
            self.ids = [o["id"] for o in answer["objects"] if o["p"] > 0.5]
            return
        pick = self.dice.randrange(7)
        if pick == 0:
            a_class, color = self.dice.choice(CLASSES), self.dice.choice(COLORS)
            self._follow(check_where(self._time(door, f"/v1/where?class={a_class}"), self.v))
            target = f"/v1/where?class={a_class}&color={color}"
            self._follow(check_where(self._time(door, target), self.v))
        elif pick == 1:
            place = self.dice.choice(PLACES)
            target = f"/v1/count?class={self.dice.choice(CLASSES)}&place={place}"
            self._follow(check_count(self._time(door, target), self.v))
        elif pick == 2:
            target = f"/v1/objects?class={self.dice.choice(CLASSES)}"
            self._follow(check_objects(self._time(door, target), self.v))
        elif pick == 3:
            self._follow(check_hypotheses(self._time(door, "/v1/hypotheses"), self.v))
        elif pick == 4 and self.ids:
            self._one(door, self.dice.choice(self.ids))
        elif pick == 5:
            status = json.loads(self._time(door, "/v1/status"))
            self.v.hold(status["expected_count"] >= 0, "expected_count", str(status))
            self._follow(status)
        else:
            self._time(door, "/metrics")

    def _one(self, door, name: str) -> None:
        status, body = door.ask("GET", f"/v1/objects/{name}")
        self.asked += 1
        if status == 404:  # it has gone since
            return
        o = json.loads(body)
        self.v.hold(status == 200 and is_probability(o["p"]), "object", f"{status} {body[:500]!r}")
        check_density(o, "object", self.v)

    def _time(self, door, target: str) -> bytes:
        begin = time.monotonic()
        body = door.get(target)
        self.latency_ms.append(1e3 * (time.monotonic() - begin))
        self.asked += 1
        return body

    def _follow(self, answer: dict) -> None:
        self.v.hold(
            answer["utime"] >= self.utime,
            "utime goes back",
            f"{self.target.name}: {answer['utime']} after {self.utime}",
        )
        self.utime = answer["utime"]
