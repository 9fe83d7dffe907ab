"""What is taken beside frames: frames sent again, events, verification tasks, questions over LCM;
by both daemons with the same result."""

from __future__ import annotations

import json
import random
import struct
import threading
from collections.abc import Callable

from pair import Pair
from wire import Bus, text

Answers = list[tuple[int, dict]]


class Taken:
    def __init__(self, pair: Pair, buses: list[Bus], query: bytes, dice: random.Random):
        self.pair, self.buses, self.query, self.dice = pair, buses, query, dice
        self.v, self.feed = pair.v, pair.feed

    def frames_again(self) -> None:
        """Nothing that was acknowledged is lost: it is known."""
        def deed() -> None:
            some = self.dice.sample(list(self.feed.recent), min(20, len(self.feed.recent)))
            some.sort(key=lambda f: f["utime"])
            for answer in self._both(lambda _: "/v1/detections", lambda _: some):
                self.v.hold(answer == (200, {"accepted": 0, "repeated": len(some)}),
                            "an acknowledged frame is lost", str(answer))

        self.pair.at_rest(deed)

    def event(self) -> None:
        with self.feed.still():
            self.pair.compare()
            objects = self._objects()
            if objects:
                self._event(objects)
            self.pair.compare()

    def _event(self, objects: list[dict]) -> None:
        one = self.dice.choice([o for o in objects if o["p"] > 0.9] or objects)
        kind = self.dice.choice(["named", "named", "moved", "grasped", "removed", "dropped"])
        event = {"utime": self.feed.utime, "event": kind, "object": one["id"]}
        if kind == "named":
            event["name"] = f"my {one['id']}"
        elif kind == "moved":
            event["position"] = one["position"]
        elif kind in ("removed", "dropped"):
            event["object"] = objects[-1]["id"]  # the least probable one
        answers = self._tell(event)
        if kind == "named" and self.dice.random() < 0.5:
            self._tell({"utime": self.feed.utime, "event": "undone"}, answers)
        elif kind == "grasped":
            self._tell({"utime": self.feed.utime, "event": "placed", "object": one["id"],
                        "position": one["position"]})

    def _tell(self, event: dict, undo: Answers | None = None) -> Answers:
        def body(i: int) -> dict:  # the two logs may number it differently
            return {**event, "number": undo[i][1]["number"]} if undo else event

        answers = self._both(lambda _: "/v1/events", body)
        self.v.hold(all(status == 200 for status, _ in answers), "an event", f"{event}: {answers}")
        self.feed.log_length += answers[0][1].get("accepted", 0)
        return answers

    def verification(self) -> None:
        """A planner demands a look; somebody answers it, or it is taken back."""
        with self.feed.still():
            objects = [o for o in self._objects() if o["p"] > 0.3]
            if not objects:
                return
            one = self.dice.choice(objects)
            answers = self._both(lambda _: "/v1/verifications", lambda _: {"object": one["id"]})
            if not self.v.hold(all(status == 201 for status, _ in answers), "a trigger",
                               str(answers)):
                return
            ids = [task["id"] for _, task in answers]
            if all(task["state"] == "issued" for _, task in answers):
                result = self._result(one)
                answers = self._both(lambda i: f"/v1/verifications/{ids[i]}/result",
                                     lambda _: result)
                fine = all(status == 200 for status, _ in answers)
                self.v.hold(fine, "a result", f"{result}: {answers}")
                self.feed.log_length += fine and result["outcome"] != "occluded"
                self.feed.frames += fine and result["outcome"] == "found"
            else:  # a robot whose pose is not known is not sent
                for daemon, number in zip(self.pair.daemons, ids):
                    door = daemon.door()
                    status, body = door.ask("DELETE", f"/v1/verifications/{number}")
                    door.close()
                    self.v.hold(status == 200, "a task", f"{status} {body[:300]!r}")
            self.pair.compare()

    def _result(self, one: dict) -> dict:
        outcome = self.dice.choice(["found", "missing", "occluded"])
        if outcome != "found":
            return {"outcome": outcome, "utime": self.feed.utime, "sensor": "kinect"}
        detection = {"position": one["position"], "object": one["id"], "score": 0.95,
                     "covariance": [1e-3, 0, 0, 0, 1e-3, 0, 0, 0, 1e-3]}
        frame = {"utime": self.feed.utime + 1, "sensor": "verifier", "detections": [detection]}
        return {"outcome": outcome, "frame": frame}

    def question_over_lcm(self) -> None:
        """The same answer as over HTTP, to the byte."""
        heard, came = {}, threading.Event()
        number = self.dice.randrange(1, 1 << 60)

        def hear(message: bytes) -> None:
            if struct.unpack("!q", message[8:16])[0] == number:
                status, size = struct.unpack("!ii", message[16:24])
                heard.update(status=status, body=message[24 : 24 + size - 1])
                came.set()

        target = "/v1/count?class=" + self.dice.choice(["cup", "person", "unicorn"])
        with self.feed.still():
            self.buses[-1].handlers["ANCHORD_ANSWER"] = hear
            for _ in range(20):  # LCM may lose messages
                message = self.query + struct.pack("!q", number) + text(target)
                self.buses[-1].publish("ANCHORD_QUERY", message)
                if came.wait(0.5):
                    break
            door = self.pair.steady.door()
            status, body = door.ask("GET", target)
            door.close()
        self.v.hold(heard == {"status": status, "body": body}, "over LCM",
                    f"{target}: {heard}, over HTTP {status} {body[:300]!r}")

    def _objects(self) -> list[dict]:
        """That have names, the most probable first."""
        door = self.pair.steady.door()
        objects = json.loads(door.get("/v1/objects"))["objects"]
        door.close()
        return [o for o in objects if not o["id"].startswith("new-")]

    def _both(self, target: Callable[[int], str], body: Callable[[int], object]) -> Answers:
        answers = []
        for i, daemon in enumerate(self.pair.daemons):
            door = daemon.door()
            answers.append(door.post(target(i), body(i)))
            door.close()
        statuses = [status for status, _ in answers]
        self.v.hold(statuses[0] == statuses[1], "answers differ", f"{target(0)}: {answers}")
        return answers
