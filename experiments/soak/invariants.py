"""What must hold of every answer, whatever happens."""

from __future__ import annotations

import json
import math
import struct
import threading
import time

SLACK = 1e-6  # sums of rounded doubles
LATENESS = 2_000_000  # us by which a frame may be late: world.max_lateness of home.json


class Violations:
    """Counts what does not hold, and says so in a line each, with what repeats it."""

    def __init__(self, seed: int, most_told: int = 50):
        self.seed, self.most_told = seed, most_told
        self.begin = time.monotonic()
        self.utime = 0  # of the home, as far as it has been played
        self.kinds: dict[str, int] = {}
        self.checked = 0
        self._lock = threading.Lock()

    def tell(self, kind: str, detail: str) -> None:
        with self._lock:
            self.kinds[kind] = self.kinds.get(kind, 0) + 1
            if sum(self.kinds.values()) > self.most_told:
                return
            elapsed = time.monotonic() - self.begin
            print(
                f"VIOLATION {kind}: {detail[:2000]} (--seed {self.seed}, {elapsed:.1f} s from the "
                f"start, home's utime {self.utime})",
                flush=True,
            )

    def hold(self, condition: bool, kind: str, detail: str) -> bool:
        """Notes a check; tells if it fails."""
        self.checked += 1
        if not condition:
            self.tell(kind, detail)
        return condition

    def count(self) -> int:
        return sum(self.kinds.values())


def is_probability(p: object) -> bool:
    return isinstance(p, (int, float)) and -SLACK <= p <= 1 + SLACK


def positive_definite(covariance: list[float]) -> bool:
    """Row-major 3 x 3: finite, symmetric, all leading minors above 0."""
    if len(covariance) != 9 or not all(isinstance(v, (int, float)) for v in covariance):
        return False
    a, b, c, d, e, f, g, h, i = covariance
    if not all(map(math.isfinite, covariance)):
        return False
    scale = SLACK * max(a, e, i)
    if abs(b - d) > scale or abs(c - g) > scale or abs(f - h) > scale:
        return False
    minor = a * e - b * d
    return a > 0 and minor > 0 and a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) > 0


def check_density(o: dict, where: str, v: Violations) -> None:
    position = o["position"]
    v.hold(len(position) == 3 and all(map(math.isfinite, position)), "position", f"{where}: {o}")
    v.hold(positive_definite(o["covariance"]), "covariance", f"{where}: {o}")


def check_objects(body: bytes, v: Violations) -> dict:
    answer = json.loads(body)
    for o in answer["objects"]:
        v.hold(is_probability(o["p"]), "probability", f"objects: {o}")
        check_density(o, "objects", v)
        v.hold(o["last_seen"] <= answer["utime"], "last_seen", f"objects: {o}")
        for name, symbols in o["attributes"].items():
            if "mean" not in symbols:
                total = sum(symbols.values())
                fine = all(map(is_probability, symbols.values())) and total <= 1 + 1e-3
                v.hold(fine, "attribute", f"objects: {o['id']} {name} {symbols}")
    return answer


def check_where(body: bytes, v: Violations) -> dict:
    answer = json.loads(body)
    for o in answer["answers"]:
        v.hold(is_probability(o["p"]) and is_probability(o["match"]), "probability", f"where: {o}")
        check_density(o, "where", v)
        for place in o["places"]:
            v.hold(is_probability(place["p"]), "probability", f"where: {o}")
    for place in answer["undetected"]:
        v.hold(0 <= place["expected"] < 1e3, "undetected", f"where: {place}")
    return answer


def check_count(body: bytes, v: Violations) -> dict:
    answer = json.loads(body)
    d = answer["distribution"]
    v.hold(all(map(is_probability, d)), "probability", f"count: {answer}")
    v.hold(abs(sum(d) - 1) < SLACK, "distribution", f"count sums to {sum(d)}: {answer}")
    mean = sum(n * p for n, p in enumerate(d))
    v.hold(abs(mean - answer["expected"]) < 1e-3 * (1 + mean), "expected", f"count: {answer}")
    return answer


def check_hypotheses(body: bytes, v: Violations) -> dict:
    answer = json.loads(body)
    ps = [w["p"] for w in answer["worlds"]]
    v.hold(all(map(is_probability, ps)) and sum(ps) <= 1 + SLACK, "hypotheses", f"{ps}")
    # The first is the world that is shown: it may keep names that are less probable than others.
    v.hold(ps[1:] == sorted(ps[1:], reverse=True), "hypotheses", f"not in order: {ps}")
    return answer


class Names:
    """Names count up: one that was not among all anchors a poll ago is larger than any that was.
    Only a late frame may bring one back that was let go: within that time, and as what it was."""

    def __init__(self) -> None:
        self.known: set[str] = set()
        self.most: dict[str, int] = {}
        self.gone: dict[str, int] = {}  # since which utime, those of late
        self.utime = 0

    def follow(self, answer: dict, v: Violations) -> None:
        """Of all anchors (min_p=0), the polls in order of time."""
        names = {o["id"] for o in answer["objects"] if not o["id"].startswith("new-")}
        fresh: dict[str, int] = {}
        # Between two polls nobody knows what was there: it may have come back with the first of
        # the frames between them.
        self.gone = {n: since for n, since in self.gone.items() if self.utime - since <= LATENESS}
        for name in self.known - names:
            self.gone[name] = answer["utime"]
        back = (names - self.known) & self.gone.keys()
        for name in names - self.known - back:
            kind, _, number = name.rpartition("-")
            v.hold(
                int(number) > self.most.get(kind, 0),
                "name",
                f"{name} is new, but {kind}-{self.most.get(kind, 0)} was given before",
            )
            fresh[kind] = max(fresh.get(kind, 0), int(number))
        for kind, number in fresh.items():
            self.most[kind] = max(self.most.get(kind, 0), number)
        for name in back:
            del self.gone[name]
        self.known, self.utime = names, answer["utime"]


class Worlds:
    """ANCHORD_WORLD of one daemon: counted up within a run, never back in time."""

    def __init__(self, v: Violations):
        self.v = v
        self.begin_again()
        self.heard = 0

    def begin_again(self) -> None:
        self.seq = self.utime = 0

    def hear(self, message: bytes) -> None:
        utime, seq = struct.unpack("!qq", message[8:24])
        self.heard += 1
        if seq == 1:
            self.begin_again()  # a new run
        self.v.hold(seq > self.seq, "world seq", f"{seq} after {self.seq}")
        self.v.hold(utime >= self.utime, "world utime", f"{utime} after {self.utime}")
        self.seq, self.utime = seq, utime
