"""Plays the simulated home into two daemons: what its sensors report, at 20 times real time."""

from __future__ import annotations

import json
import random
import subprocess
import threading
import time
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

from invariants import Violations
from process import Daemon, Gone
from wire import Bus

SPEED = 20  # times real time
NOT_OVER_LCM = 0.1  # of the hall camera's frames: they come late, over HTTP alone
CATCH_UP = 5.0  # s that the play may lag before it gives up catching up (a slow machine)


class Stillness:
    """Either the home goes on, or somebody has it stand still; who asks first comes first."""

    def __init__(self) -> None:
        self._turn, self._moving = threading.Lock(), threading.Lock()

    @contextmanager
    def __call__(self):
        with self._turn:
            self._moving.acquire()
        try:
            yield
        finally:
            self._moving.release()


class Feed:
    """The frames of one second of the home at a time, each frame to both daemons with a durable
    acknowledgement. Those of the hall camera come over LCM first; so what LCM brought is repeated
    over HTTP, what it lost or did not get is late there."""

    def __init__(self, command: list[str], daemons: list[Daemon], buses: list[Bus], seed: int,
                 v: Violations):
        self.simulator = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        self.daemons, self.buses, self.v = daemons, buses, v
        self.doors = {d.name: d.door() for d in daemons}
        self.dice = random.Random(seed)
        self.still = Stillness()
        self.log_length = 0  # distinct frames and events that both daemons have acknowledged
        self.frames = 0
        self.utime = 0
        self.recent: deque[dict] = deque(maxlen=2000)  # acknowledged frames
        self.truth: tuple[int, list] = (0, [])
        self.hall: bytes = b""  # the newest frame_t that was sent over LCM
        self.repeated = 0
        self.ack_ms: deque[float] = deque(maxlen=100_000)
        self.on_truth = lambda: None
        self.query = bytes.fromhex(json.loads(self.simulator.stdout.readline())["query"])
        self._line = json.loads(self.simulator.stdout.readline())
        self._start = self._line["utime"]
        self._pool = ThreadPoolExecutor(len(daemons))

    def home_seconds(self) -> float:
        """Of the home that were played."""
        return max(0.0, (self.utime - self._start) * 1e-6)

    def play(self, seconds: float) -> None:
        """For so long by the clock."""
        begin = due = time.monotonic()
        while (now := time.monotonic()) < begin + seconds:
            if now < due:
                time.sleep(min(due - now, begin + seconds - now))
                continue
            due = max(due + 1 / SPEED, now - CATCH_UP)
            with self.still():
                self._second()

    def _second(self) -> None:
        """One second of the home."""
        end = self._line["utime"] // 1_000_000 + 1
        robot, hall, truth = [], [], None
        while self._line["utime"] // 1_000_000 < end:
            line = self._line
            if "pose" in line:
                self._publish("ANCHORD_POSE", bytes.fromhex(line["pose"]))
            elif "truth" in line:
                truth = (line["utime"], line["truth"])
            elif "lcm" in line:
                hall.append(line["frame"])
                self.hall = bytes.fromhex(line["lcm"])
                if self.dice.random() >= NOT_OVER_LCM:
                    self._publish("ANCHORD_DETECTIONS", self.hall)
            else:
                robot.append(line["frame"])
            text = self.simulator.stdout.readline()
            if not text:
                raise RuntimeError("the simulated home has ended")
            self._line = json.loads(text)
        while robot:
            some = self.dice.randint(1, len(robot))
            self.deliver(robot[:some])
            del robot[:some]
        if hall:
            self.deliver(hall)
        if truth:
            self.truth = truth
            self.on_truth()

    def _publish(self, channel: str, message: bytes) -> None:
        for bus in self.buses:
            bus.publish(channel, message)

    def deliver(self, frames: list[dict]) -> None:
        """To both, until both have acknowledged them."""
        body = json.dumps(frames).encode()
        list(self._pool.map(lambda d: self._deliver_to(d, frames, body), self.daemons))
        self.recent.extend(frames)
        self.frames += len(frames)
        self.log_length += len(frames)
        self.utime = max(self.utime, frames[-1]["utime"])
        self.v.utime = self.utime

    def _deliver_to(self, daemon: Daemon, frames: list[dict], body: bytes) -> None:
        door = self.doors[daemon.name]
        while True:
            daemon.up.wait()
            begin = time.monotonic()
            try:
                status, text = door.ask("POST", "/v1/detections", body)
            except Gone:
                time.sleep(0.002)
                continue
            break
        answer = json.loads(text)
        if daemon is self.daemons[-1]:
            self.ack_ms.append(1e3 * (time.monotonic() - begin))
            self.repeated += answer.get("repeated", 0)
        taken = answer.get("accepted", 0) + answer.get("repeated", 0)
        self.v.hold(
            status == 200 and taken == len(frames),
            "a good frame is refused",
            f"{daemon.name}: {status} {text[:300]!r} to {body[:300]!r}",
        )

    def close(self) -> None:
        self.simulator.kill()
        self.simulator.wait()
