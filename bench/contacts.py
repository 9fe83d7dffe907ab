"""What can be known of who leaves a contact of ants, without tags.

    contacts.py FRAMES.jsonl[.gz] TRUTH.csv [FRAMES TRUTH ...]

Frames and truth as for bench/public.sh ants: truth rows that are not ignored are detections of one ant
alone. Prints Markdown:

- Contacts: two ants that were alone until one frame, were missing for the same time (within 0.6 s of
  each other) and are alone again from one frame on. How often the one is on the side where it came
  from, and how often each model of what happens in between is right about who is who, with the
  information that it has of that, in bits of 1 (-inf for being wrong with certainty is kept off by
  doubting everything by 2 %).
- Names: AssA of an observer that is told for every blob which ants went in and which blobs it parted
  into, and how many of those were one ant, and must only say which of them each one is, once and for
  all as it leaves: the most probable one by its place under the model that walks on, one to one, sizes
  left aside. For various settings of that model, since like shares of right answers have very
  different AssA; and what the same observer has if it guesses. It shows what the places are worth, and
  is no bound: it follows one history, not several.
"""

from __future__ import annotations

import csv
import gzip
import json
import math
import sys
from collections import Counter
from collections.abc import Callable

import numpy as np
from scipy.optimize import linear_sum_assignment

DT = 0.1  # s between frames; lengths here are mm
NOISE = 0.01  # mm^2
Row = list  # of names or places


def read(frames: str, truth: str) -> tuple[list, list]:
    """Per frame: places and diameters of detections; and the names of those that are an ant alone."""
    alone: dict[int, dict] = {}
    with open(truth, newline="") as f:
        for r in csv.DictReader(f):
            if not float(r["ignore"]):
                at = round(float(r["x"]) * 1e6), round(float(r["y"]) * 1e6)
                alone.setdefault(int(r["frame"]), {})[at] = r["id"]
    found, names = [], []
    with gzip.open(frames, "rt") if frames.endswith(".gz") else open(frames) as f:
        for n, line in enumerate(f, 1):
            zs = json.loads(line)["detections"]
            found.append([(np.array(z["position"]) * 1e3, z["attributes"]["size"]["mean"] * 1e3) for z in zs])
            at = [(round(z["position"][0] * 1e6), round(z["position"][1] * 1e6)) for z in zs]
            names.append([alone.get(n, {}).get(a) for a in at])
    return found, names


class Walk:
    """Position and velocity of one ant, the same on both axes: an integrated Ornstein-Uhlenbeck process."""

    def __init__(self, places: list, psd: float):
        self.psd, self.mean, self.cov = psd, np.array([places[0], (0, 0)], float), np.diag([NOISE, 50.0])
        for z in places[1:]:
            self.go(1e-9)
            self.see(z, NOISE)

    def go(self, slows: float) -> None:
        e = math.exp(-slows * DT)
        b = -math.expm1(-slows * DT) / slows if slows > 1e-6 else DT
        f = np.array([[1, b], [0, e]])
        self.mean = f @ self.mean
        self.cov = f @ self.cov @ f.T + self.psd * np.array([[DT**3 / 3, DT**2 / 2], [DT**2 / 2, DT]])

    def see(self, z: np.ndarray, variance: float) -> None:
        gain = self.cov[:, 0] / (self.cov[0, 0] + variance)
        self.mean = self.mean + np.outer(gain, z - self.mean[0])
        self.cov = self.cov - np.outer(gain, self.cov[0])

    def log_density(self, z: np.ndarray) -> float:
        v = self.cov[0, 0] + NOISE
        return -((z - self.mean[0]) ** 2).sum() / 2 / v - math.log(2 * math.pi * v)


class Ride(Walk):
    """Where the blob is, and how far an ant is from there: mm in the place of a velocity."""

    def __init__(self, walk: Walk, reach: float):
        x, v = walk.mean[0], walk.cov[0, 0]
        self.mean = np.array([x, 0 * x])
        self.cov = np.array([[v + reach**2, -(reach**2)], [-(reach**2), reach**2]])
        self.reach = reach

    def go(self, stir: float) -> None:
        k = np.diag([1, math.exp(-stir * DT)])
        self.mean, self.cov = k @ self.mean, k @ self.cov @ k
        self.cov += np.diag([DT, (1 - k[1, 1] ** 2) * self.reach**2])  # position_psd 1 mm^2/s

    def log_density(self, z: np.ndarray) -> float:
        v = self.cov.sum() + NOISE
        return -((z - self.mean.sum(axis=0)) ** 2).sum() / 2 / v - math.log(2 * math.pi * v)


def near(found: list, frame: int, at: np.ndarray) -> np.ndarray:
    return min((z for z, _ in found[frame]), key=lambda z: ((z - at) ** 2).sum())


def walks(reach: float, slows: float, psd: float) -> Callable:
    def through(found: list, places: list, last: int, first: int) -> Walk:
        walk, at = Walk(places[-12:], psd), places[-1]
        for frame in range(last + 1, first):
            walk.go(slows)
            at = near(found, frame, at)
            walk.see(at, NOISE + reach**2)
        walk.go(slows)
        return walk

    return through


def rides(reach: float, stir: float) -> Callable:
    def through(found: list, places: list, last: int, first: int) -> Walk:
        ride = Ride(Walk(places[-12:], 20), reach)
        for frame in range(last + 1, first):
            ride.go(stir)
            ride.see(near(found, frame, ride.mean[0]), NOISE)
        return ride

    return through


def tracklets(found: list, names: list) -> list[tuple[str, int, list]]:
    """Name, first frame, places: as long as an ant is alone without a gap; in order of the first frame."""
    out: list = []
    running: dict[str, tuple] = {}
    for frame, (places, row) in enumerate(zip(found, names)):
        now = {n: z for n, (z, _) in zip(row, places) if n}
        running = {n: t for n, t in running.items() if n in now}
        for n, z in now.items():
            if n not in running:
                running[n] = (n, frame, [])
                out.append(running[n])
            running[n][2].append(z)
    return out


def contacts(found: list, names: list) -> list:
    """(last frame, places) before, and first place after, of both; with the frame in which they part."""
    before: dict[str, tuple] = {}
    parting: dict[int, list] = {}
    for name, first, places in tracklets(found, names):
        if name in before:
            parting.setdefault(first, []).append((*before[name], places[0]))
        before[name] = (first + len(places) - 1, places)
    out = []
    for frame, some in parting.items():
        for i, a in enumerate(some):
            for b in some[:i]:
                apart, gap = np.hypot(*(a[2] - b[2])), frame - 1 - max(a[0], b[0])
                if apart < 8 and gap <= 40 and abs(a[0] - b[0]) <= 6:
                    out.append((frame, a, b, gap))
    return out


def table_of_contacts(clips: list) -> None:
    meetings = [(found, *c) for found, names in clips for c in contacts(found, names)]
    models = {
        "walks on: reach 5 mm, velocity lost in 0.5 s": walks(5, 2, 20),
        "walks on: reach 5 mm, constant velocity": walks(5, 1e-9, 20),
        "rides along: reach 2.5 mm, side lost in 3.3 s": rides(2.5, 0.3),
    }
    spans = [(1, 3), (4, 6), (7, 20), (21, 40)]
    print("| | " + " | ".join(f"{a / 10} to {b / 10} s" for a, b in spans) + " | all | bits |")
    print("| --- |" + " ---: |" * (len(spans) + 2))

    def row(label: str, right: list[bool], bits: float | None) -> None:
        cells = []
        for low, high in [*spans, (1, 40)]:
            some = [r for r, m in zip(right, meetings) if low <= m[4] <= high]
            cells.append(f"{sum(some)} of {len(some)}")
        print(f"| {label} | " + " | ".join(cells) + (" | |" if bits is None else f" | {bits:.2f} |"))

    side = [float((a[1][-1] - b[1][-1]) @ (a[2] - b[2])) > 0 for _, _, a, b, _ in meetings]
    row("on the side where they came from", side, None)
    for label, through in models.items():
        odds = []
        for found, frame, a, b, _ in meetings:
            pa, pb = (through(found, p[1], p[0], frame) for p in (a, b))
            odds.append(pa.log_density(a[2]) + pb.log_density(b[2]) - pa.log_density(b[2]) - pb.log_density(a[2]))
        bits = [math.log2(2 * (0.01 + 0.98 / (1 + math.exp(-max(-30, min(30, o)))))) for o in odds]
        row(label, [o > 0 for o in odds], float(np.mean(bits)))


def links(before: list, after: list, was: Row, now: Row) -> set[tuple[int, int]]:
    """Which blob of a frame is, or is in, which of the next."""
    out = {(was.index(n), j) for j, n in enumerate(now) if n and n in was}
    a = [i for i in range(len(before)) if i not in {i for i, _ in out}]
    b = [j for j in range(len(after)) if j not in {j for _, j in out}]
    if a and b:
        d = np.array([[np.hypot(*(before[i][0] - after[j][0])) for j in b] for i in a])
        out |= {(a[i], b[j]) for i, j in zip(*linear_sum_assignment(np.minimum(d, 1e3))) if d[i, j] < 2.5}
    edge = lambda x, y: np.hypot(*(x[0] - y[0])) - y[1] / 2  # noqa: E731
    out |= {(i, min(range(len(after)), key=lambda j: edge(before[i], after[j])))
            for i in range(len(before)) if i not in {i for i, _ in out}}  # fmt: skip
    out |= {(min(range(len(before)), key=lambda i: edge(after[j], before[i])), j)
            for j in range(len(after)) if j not in {j for _, j in out}}  # fmt: skip
    return out


class Observer:
    """Told who goes into which blob and what parts, it says who leaves."""

    def __init__(self, reach: float, slows: float, unseen: float, guess: np.random.Generator | None = None):
        self.reach, self.slows, self.unseen, self.guess = reach, slows, unseen, guess
        self.right = self.answers = self.named = 0

    def value(self, walk: Walk | None, z: np.ndarray) -> float:
        if self.guess is not None:
            return float(self.guess.random())
        return self.unseen if walk is None else walk.log_density(z)

    def watch(self, found: list, names: list) -> list[tuple[str, str, int]]:
        """(true name, its name, frames) of every tracklet."""
        inside: list[list] = [[] for _ in found[0]]  # per blob: (name given, walk or None)
        true: dict[str, str] = {}  # who a name stands for
        alone: dict[str, tuple[str, list]] = {}  # by the true name: the name given, where it went
        spans: Counter = Counter()
        for frame, (blobs, row) in enumerate(zip(found, names)):
            if frame:
                inside = self.follow(found, names, frame, inside, true, alone)
            else:
                for i, n in enumerate(row):
                    if n:
                        inside[i] = [(self.new(n, true), None)]
            for i, n in enumerate(row):
                if n:
                    given = inside[i][0][0]
                    if n not in alone or alone[n][0] != given:
                        alone[n] = (given, [])
                    alone[n][1].append(blobs[i][0])
                    spans[n, given] += 1
            alone = {n: a for n, a in alone.items() if n in row}
        return [(n, given, k) for (n, given), k in spans.items()]

    def new(self, name: str, true: dict) -> str:
        self.named += 1
        true[f"x{self.named}"] = name
        return f"x{self.named}"

    def follow(self, found: list, names: list, frame: int, inside: list, true: dict, alone: dict) -> list:
        pairs = links(found[frame - 1], found[frame], names[frame - 1], names[frame])
        out: list[list] = [[] for _ in found[frame]]
        left = set(range(len(out)))
        while left:
            after, before, grown = {left.pop()}, set(), True
            while grown:
                size = len(after) + len(before)
                before |= {i for i, j in pairs if j in after}
                after |= {j for i, j in pairs if i in before}
                grown = len(after) + len(before) > size
            left -= after
            self.part(found, names, frame, sorted(before), sorted(after), inside, out, true, alone)
        return out

    def part(self, found, names, frame, before, after, inside, out, true, alone) -> None:
        was, now, blobs = names[frame - 1], names[frame], found[frame]
        if len(before) == len(after) == 1 and was[before[0]] and was[before[0]] == now[after[0]]:
            out[after[0]] = inside[before[0]]
            return
        pool = []
        for i in before:
            for given, walk in inside[i]:
                if was[i]:  # it was alone until now
                    walk = Walk(alone[was[i]][1][-12:], 20)
                if walk is not None:
                    walk.go(self.slows)
                pool.append((given, walk))
        singles, joint = [j for j in after if now[j]], [j for j in after if not now[j]]
        if singles:
            worth = np.array([[self.value(w, blobs[j][0]) for _, w in pool] +
                              [self.unseen if j == k else -1e6 for k in singles] for j in singles])  # fmt: skip
            taken = set()
            for r, c in zip(*linear_sum_assignment(worth, maximize=True)):
                j, who = singles[r], now[singles[r]]
                given = pool[c][0] if c < len(pool) else self.new(who, true)
                if any(true[g] == who for g, _ in pool):
                    self.answers, self.right = self.answers + 1, self.right + (true[given] == who)
                # Whoever goes by another's name leaves that one its own: it is told who is inside.
                for other in [g for g in true if true[g] == who and g != given]:
                    true[other] = true[given]
                true[given] = who
                out[j] = [(given, None)]
                taken.add(c)
            pool = [p for c, p in enumerate(pool) if c not in taken]
        for given, walk in pool if joint else []:
            at = max(joint, key=lambda j: blobs[j][1])
            if walk is not None:
                at = min(joint, key=lambda j: np.hypot(*(walk.mean[0] - blobs[j][0])) - blobs[j][1] / 2)
                walk.see(blobs[at][0], NOISE + self.reach**2)
            out[at].append((given, walk))


def association(spans: list[list[tuple[str, str, int]]]) -> float:
    """HOTA's AssA where every detection is right: frames are pairs of a true and a given name."""
    total = good = 0.0
    for clip in spans:
        true, given = Counter(), Counter()
        for n, g, k in clip:
            true[n] += k
            given[g] += k
        total += sum(k for _, _, k in clip)
        good += sum(k * k / (true[n] + given[g] - k) for n, g, k in clip)
    return 100 * good / total


def table_of_names(clips: list) -> None:
    print("\n| told who is in which blob | right | AssA |\n| --- | ---: | ---: |")
    settings = [(f"reach {r} mm, velocity lost in {1 / s:.1f} s", (r, s, u, None))
                for r in (2.5, 5) for s in (2, 3) for u in (-8, -12)]  # fmt: skip
    settings += [(f"guesses, seed {n}", (5, 2, -12, np.random.default_rng(n))) for n in range(3)]
    for label, (reach, slows, unseen, guess) in settings:
        observer = Observer(reach, slows, unseen, guess)
        spans = [observer.watch(*clip) for clip in clips]
        more = "" if guess else f", unseen {unseen}"
        print(f"| {label}{more} | {observer.right} of {observer.answers} | {association(spans):.1f} |")


def main() -> None:
    if len(sys.argv) < 3 or len(sys.argv) % 2 == 0:
        sys.exit(__doc__)
    clips = [read(f, t) for f, t in zip(sys.argv[1::2], sys.argv[2::2])]
    table_of_contacts(clips)
    table_of_names(clips)


if __name__ == "__main__":
    main()
