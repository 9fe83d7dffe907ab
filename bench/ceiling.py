"""How far evidence of scores and times alone goes with these detections: a classifier tells the
right ones from the false ones, on-line, and the truth associates them.

    ceiling.py SCORE.py CLASS RADIUS < SEQUENCES

SEQUENCES, a line each: FRAMES.jsonl[.gz] TRUTH.csv INDEX.csv. Detections that are reported as CLASS
are linked over frames: one to one, nearest first, within RADIUS m in the plane of where a constant
velocity leads, through at most nine frames without one. Of each is then known, from its own frame
and those before alone: its score (logits) and the mean, the mean of the last five and the largest
of its chain's; how many there are (logarithm) and in what part of all frames and of the last ten;
its distance; the chain's speed and how far from its predictions it was found. Logistic regressions
on these, ridge 1: on five of them (score, mean, how many, part of the last ten, distance), or on
all and their squares. Detections with p >= 0.5 are answered, where they are, the right ones under
the truth's names; frames in which a thing is not detected are left open.

Prints Markdown, SCORE.py's numbers of each, where fitted

- on the same sequences: what can be had with so many numbers fitted to the very truth;
- crosswise: on the sequences of even lines, scored on those of odd ones, and the other way round.
"""

from __future__ import annotations

import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from oracle import COLUMNS, Rows, in_map, lines, names, read_truth, top, write
from scipy.optimize import linear_sum_assignment, minimize

PATIENCE = 10  # frames
FEW = [0, 1, 4, 6, 7]  # of the columns of features()


class Chain:
    """Detections that are taken for one thing."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.at = self.velocity = np.zeros(2)
        self.frames: list[int] = []
        self.logits: list[float] = []
        self.off = 0.0  # m, of predictions, the mean that forgets

    def predicted(self, frame: int) -> np.ndarray:
        return self.at + self.velocity * (frame - self.frames[-1])

    def take(self, frame: int, at: np.ndarray, logit: float) -> None:
        if self.frames:
            news = at - self.predicted(frame)
            gain = max(0.3, 1 / (len(self.frames) + 1))
            self.off += 0.3 * (float(np.hypot(*news)) - self.off)
            self.velocity = self.velocity + gain / 2 * news / (frame - self.frames[-1])
            at = at - (1 - max(gain, 0.6)) * news
        self.at = at
        self.frames.append(frame)
        self.logits.append(logit)

    def features(self, distance: float) -> list[float]:
        now, n = self.frames[-1], len(self.frames)
        age, late = now - self.frames[0] + 1, sum(f > now - PATIENCE for f in self.frames)
        return [
            self.logits[-1],
            float(np.mean(self.logits)),
            float(np.mean(self.logits[-5:])),
            max(self.logits),
            float(np.log(n)),
            n / age,
            late / min(age, PATIENCE),
            distance,
            float(np.hypot(*self.velocity)),
            self.off,
        ]


def nearest(a: np.ndarray, b: np.ndarray, radius: float) -> list[tuple[int, int]]:
    at = a[:, None] - b[None]
    distance = np.hypot(at[..., 0], at[..., 1])
    pairs = zip(*linear_sum_assignment(np.where(distance < radius, distance, 1e6)))
    return [(i, k) for i, k in pairs if distance[i, k] < radius]


def read(path: str, numbers: dict[int, int], cls: str, radius: float) -> tuple[Rows, dict]:
    """The detections, each under its chain's name, and the features by frame and name."""
    rows: Rows = {}
    features: dict[tuple[int, str], list[float]] = {}
    chains: list[Chain] = []
    begun = 0
    for line in lines(path):
        if line["utime"] not in numbers:
            continue
        frame = numbers[line["utime"]]
        found = [z for z in line["detections"] if top(z["attributes"]["class"]) == cls]
        at = np.array([in_map(line.get("pose"), z["position"]) for z in found]).reshape(-1, 2)
        chains = [c for c in chains if frame - c.frames[-1] < PATIENCE]
        expected = np.array([c.predicted(frame) for c in chains]).reshape(-1, 2)
        of = {i: chains[k] for i, k in nearest(at, expected, radius)}
        rows[frame] = []
        for i, z in enumerate(found):
            if i not in of:
                of[i] = Chain(f"d{begun}")
                chains.append(of[i])
                begun += 1
            score = min(max(z["score"], 1e-6), 1 - 1e-6)
            of[i].take(frame, at[i], float(np.log(score / (1 - score))))
            rows[frame].append((of[i].name, list(at[i])))
            features[frame, of[i].name] = of[i].features(float(np.hypot(*z["position"][:2])))
    return rows, features


def neutral(path: str, cls: str, rows: Rows, radius: float) -> set[tuple[int, str]]:
    """What lies near an ignored row: neither right nor false where it has no truth."""
    at: dict[int, list[list[float]]] = {}
    with open(path, newline="") as f:
        for r in csv.DictReader(f):
            if r["class"] == cls and float(r.get("ignore") or 0) > 0:
                at.setdefault(int(r["frame"]), []).append([float(r["x"]), float(r["y"])])
    return {
        (frame, name)
        for frame, found in rows.items()
        for name, p in found
        if any(np.hypot(p[0] - x, p[1] - y) < radius for x, y in at.get(frame, []))
    }


def regression(x: np.ndarray, y: np.ndarray):
    """Logistic; returns what gives the log-odds."""
    mean, scale = x.mean(axis=0), x.std(axis=0) + 1e-9
    sign = 2 * y - 1

    def design(x: np.ndarray) -> np.ndarray:
        return np.c_[np.ones(len(x)), (x - mean) / scale]

    z = design(x)

    def loss(w: np.ndarray) -> tuple[float, np.ndarray]:
        margin = sign * (z @ w)
        ridge = np.r_[0, w[1:]]
        return (
            np.logaddexp(0, -margin).sum() + 0.5 * ridge @ ridge,
            ridge - z.T @ (sign / (1 + np.exp(np.clip(margin, -700, 700)))),
        )

    best = minimize(loss, np.zeros(z.shape[1]), jac=True, method="L-BFGS-B")
    return lambda x: design(x) @ best.x


def main() -> None:
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    score, cls, radius = sys.argv[1], sys.argv[2], float(sys.argv[3])
    sequences = [line.split() for line in sys.stdin if line.strip()]
    found, keys, x, y = [], [], [], []
    for n, (frames, truth, index) in enumerate(sequences):
        with open(index, newline="") as f:
            numbers = {int(r["utime"]): int(r["frame"]) for r in csv.DictReader(f)}
        rows, features = read(frames, numbers, cls, radius)
        true = names(read_truth(truth, cls), rows, radius)
        ignored = neutral(truth, cls, rows, radius)
        found.append((rows, true))
        for key, values in features.items():
            keys.append((n, key))
            x.append(values)
            y.append(1 if key in true else -1 if key in ignored else 0)
    values, right = np.array(x), np.array(y)
    half = np.array([n % 2 for n, _ in keys])
    print("| | " + " | ".join(COLUMNS) + " |\n| --- |" + " ---: |" * len(COLUMNS))
    for kind, columns in {
        "five features": values[:, FEW],
        "all and squares": np.c_[values, values**2],
    }.items():
        for where in ("on the same", "crosswise"):
            odds = np.zeros(len(keys))
            for k in (0, 1):
                fit = (right >= 0) & ((half != k) | (where == "on the same"))
                odds[half == k] = regression(columns[fit], right[fit])(columns[half == k])
            taken = {key for key, o in zip(keys, odds) if o >= 0}
            with tempfile.TemporaryDirectory() as folder:
                tracks = []
                for n, (rows, true) in enumerate(found):
                    answered = {
                        frame: [r for r in all_of_it if (n, (frame, r[0])) in taken]
                        for frame, all_of_it in rows.items()
                    }
                    tracks.append(f"{folder}/{n}.csv")
                    write(Path(tracks[-1]), answered, cls, true, True, False)
                command = [sys.executable, score, "--truth", *(s[1] for s in sequences)]
                command += ["--index", *(s[2] for s in sequences), "--track", *tracks]
                command += ["--radius", str(radius), "--dims", "2", "--per-class"]
                done = subprocess.run(command, check=True, capture_output=True, text=True)
            for line in map(json.loads, done.stdout.splitlines()):
                if line["class"] == cls:
                    cells = [line[c] for c in COLUMNS]
                    shown = [f"{c:.1f}" if isinstance(c, float) else str(c) for c in cells]
                    print(f"| {kind}, {where} | " + " | ".join(shown) + " |", flush=True)


if __name__ == "__main__":
    main()
