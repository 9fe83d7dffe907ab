"""How far probabilities can be taken at their word: of what is claimed with p in each tenth, the
share that is true.

    reliability.py OUT.svg < SEQUENCES

SEQUENCES, a line each: SET RADIUS SEEN WORLD.jsonl TRUTH.csv INDEX.csv, the world's lines made with
anchor-replay --all. Prints Markdown; writes the diagram.

What is counted, in every frame of the index:
- things: anchors last seen at most SEEN seconds ago (the truth may cover only what is in view; inf:
  all). A thing is claimed to be within RADIUS of where the best world shows it, or, if that does
  not, of the mean of its marginal density; p is the probability that it exists times the mass there
  of a normal density with that covariance. Claims of p >= 0.05 count.
- anchors closer together than a tenth of RADIUS are one thing as far as they are expected to be
  less than 1.5 objects, which is nearer to one than to two: names that compete for it. Its p is the
  sum of theirs, at most 1.
- a thing is true if it is given a truth point within RADIUS: one to one, as many as possible, the
  nearest. Of what stays without, what has an ignored truth point within RADIUS is left out.
"""

from __future__ import annotations

import csv
import json
import math
import sys

import numpy as np
from plot import Panel, figure
from scipy.optimize import linear_sum_assignment

LEAST = 0.05
TENTHS = 10
TWIN = 0.1  # of the radius
ONE = 1.5  # expected objects
FEW = 100  # things in a tenth: fewer say nothing, the standard error is 0.05 at p = 0.5


def read_truth(path: str) -> dict[int, list[tuple[list[float], bool]]]:
    frames: dict[int, list[tuple[list[float], bool]]] = {}
    with open(path, newline="") as f:
        for r in csv.DictReader(f):
            point = ([float(r["x"]), float(r["y"])], float(r.get("ignore") or 0) > 0)
            frames.setdefault(int(float(r["frame"])), []).append(point)
    return frames


def mass_within(radius: float, covariance: list[float]) -> float:
    """Of a plane normal density within `radius` of its mean; row-major covariance, 2-D or 3-D."""
    n = math.isqrt(len(covariance))
    a, b = np.linalg.eigvalsh(np.reshape(covariance, (n, n))[:2, :2]).clip(1e-12)
    # In polar coordinates; the trapezoidal rule over a period.
    angle = np.arange(64) * (2 * np.pi / 64)
    s = np.cos(angle) ** 2 / a + np.sin(angle) ** 2 / b
    return float(np.mean(-np.expm1(-0.5 * radius**2 * s) / s) / math.sqrt(a * b))


def things(objects: list[dict], now: int, seen: float, radius: float) -> list[list[float]]:
    """x, y, p of what is claimed."""
    found: list[list[float]] = []  # and how many objects are expected
    for o in sorted(objects, key=lambda o: -o["p"]):
        if now - o["last_seen"] > seen * 1e6:
            continue
        place = o if o["in_best"] else o["marginal"]
        x, y = place["position"][:2]
        number, p = o["p"], o["p"] * mass_within(radius, place["covariance"])
        for t in found:
            if math.dist((x, y), t[:2]) < TWIN * radius and t[3] + number < ONE:
                t[2] = min(1.0, t[2] + p)
                t[3] += number
                break
        else:
            found.append([x, y, p, number])
    return [t[:3] for t in found if t[2] >= LEAST]


def distances(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.linalg.norm(a[:, None, :2] - b[None, :, :2], axis=2)


def judge(believed: list[list[float]], truth: list, radius: float) -> list[tuple[float, bool]]:
    """Each thing's p and whether it is true."""
    b = np.array(believed)
    real = np.array([p for p, ignored in truth if not ignored]).reshape(-1, 2)
    ignored = np.array([p for p, ignored in truth if ignored]).reshape(-1, 2)
    d = distances(b, real)
    i, j = linear_sum_assignment(np.where(d <= radius, d, 1e3 * radius))
    found = {a for a, c in zip(i, j) if d[a, c] <= radius}
    neutral = (distances(b, ignored) <= radius).any(axis=1)
    return [(p, k in found) for k, p in enumerate(b[:, 2]) if k in found or not neutral[k]]


def judge_sequence(line: str) -> tuple[str, list[tuple[float, bool]]]:
    name, radius, seen, world_path, truth_path, index_path = line.split()
    truth = read_truth(truth_path)
    with open(index_path, newline="") as f:
        frame_of = {int(r["utime"]): int(r["frame"]) for r in csv.DictReader(f)}
    worlds = {}  # of several lines of one time the last counts
    with open(world_path) as f:
        for text in f:
            world = json.loads(text)
            if world["utime"] in frame_of:
                worlds[world["utime"]] = world
    out = []
    for now, world in worlds.items():
        believed = things(world["objects"], now, float(seen), float(radius))
        if believed:
            out += judge(believed, truth.get(frame_of[now], []), float(radius))
    return name, out


def tenths(judged: list[tuple[float, bool]]) -> list[tuple[int, float, float]]:
    """Per tenth: how many, their mean p, the share that is true."""
    out = []
    for k in range(TENTHS):
        inside = [(p, t) for p, t in judged if min(int(p * TENTHS), TENTHS - 1) == k]
        n = len(inside)
        mean = sum(p for p, _ in inside) / n if n else 0.0
        out.append((n, mean, sum(t for _, t in inside) / n if n else 0.0))
    return out


def panel(name: str, judged: list[tuple[float, bool]]) -> Panel:
    out = Panel(name, "believed", "true")
    out.curve("as believed", [(0, 0, 0), (1, 1, 0)])
    table = [(n, p, share) for n, p, share in tenths(judged) if n]
    points = [(p, share, math.sqrt(share * (1 - share) / n)) for n, p, share in table]
    out.curve("observed, and one standard error", points)
    return out


def main() -> None:
    by_set: dict[str, list[tuple[float, bool]]] = {}
    for line in sys.stdin:
        name, judged = judge_sequence(line)
        by_set.setdefault(name, []).extend(judged)
    everything = [j for judged in by_set.values() for j in judged]
    print("\n### Reliability\n\nshare that is true / mean p (how many)\n")
    print("| set | " + " | ".join(f"{k / 10:.1f}-" for k in range(TENTHS)) + " | worst |")
    print("| --- |" + " ---: |" * (TENTHS + 1))
    for name, judged in [*by_set.items(), ("together", everything)]:
        table = tenths(judged)
        cells = [f"{share:.2f} / {mean:.2f} ({n})" if n else "" for n, mean, share in table]
        worst = max((abs(share - mean) for n, mean, share in table if n >= FEW), default=0.0)
        print(f"| {name} | " + " | ".join(cells) + f" | {worst:.3f} |")
    print(f"\nworst: the largest difference in a tenth with at least {FEW} things.")
    families: dict[str, list[tuple[float, bool]]] = {"together": everything}
    for name, judged in by_set.items():  # variants of one data set share a panel
        families.setdefault(name.split("_")[0], []).extend(judged)
    with open(sys.argv[1], "w") as f:
        f.write(figure([panel(name, judged) for name, judged in families.items()]))


main()
