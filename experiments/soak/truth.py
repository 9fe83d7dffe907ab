"""What is believed, held against what is really there."""

from __future__ import annotations

import json
import math

from invariants import Violations
from pair import Pair

NEAR = 1.0  # m: an object is taken for a real one of the same class that is no further off
EVERY = 6  # truths between two looks: one minute of the home
SETTLED = 1800  # s of the home before the belief must be about right


class Truth:
    """Held against the steady daemon's belief now and then."""

    def __init__(self, pair: Pair, v: Violations):
        self.pair, self.feed, self.v = pair, pair.feed, v
        self.door = pair.steady.door()
        self.looks = 0
        self.sums: dict[str, float] = {}
        self.settled = 0
        pair.feed.on_truth = self.look

    def look(self) -> None:
        self.looks += 1
        if self.looks % EVERY:
            return
        real = self.feed.truth[1]
        objects = json.loads(self.door.get("/v1/objects"))["objects"]
        people = json.loads(self.door.get("/v1/count?class=person"))
        believed = [o for o in objects if o["p"] >= 0.5]
        found = matched(real, believed)
        here = sum(1 for name, _ in real if name == "person")
        now = {
            "real": len(real),
            "found": found,
            "believed": len(believed),
            "expected": sum(o["p"] for o in objects),
            "people": here,
            "people expected": people["expected"] + people["undetected"],
            "people's error": abs(people["expected"] + people["undetected"] - here),
        }
        if self.feed.home_seconds() < SETTLED:
            return
        self.settled += 1
        for name, value in now.items():
            self.sums[name] = self.sums.get(name, 0.0) + value
        self.v.hold(0.4 * len(real) < now["expected"] < 1.6 * len(real), "expected number",
                    f"{now['expected']:.1f} are expected, {len(real)} are there")
        self.v.hold(now["people's error"] < 4, "people",
                    f"{now['people expected']:.1f} are expected, {here} are there")

    def means(self) -> dict[str, float]:
        return {name: value / self.settled for name, value in self.sums.items()}


def matched(real: list, believed: list[dict]) -> int:
    """How many real objects have a believed one of their class near them, each for one only."""
    pairs = sorted(
        (distance, i, k)
        for i, (name, position) in enumerate(real)
        for k, o in enumerate(believed)
        if (distance := math.dist(position, o["position"])) < NEAR
        and max(o["attributes"]["class"].items(), key=lambda s: s[1])[0] == name
    )
    taken_real, taken_believed = set(), set()
    for _, i, k in pairs:
        if i not in taken_real and k not in taken_believed:
            taken_real.add(i)
            taken_believed.add(k)
    return len(taken_real)
