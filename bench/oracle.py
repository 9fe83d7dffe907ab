"""What a score would be if one kind of error were gone: where the rest of it is lost.

    oracle.py SCORE.py CLASS RADIUS SEEN < SEQUENCES

SEQUENCES, a line each: FRAMES.jsonl[.gz] WORLD.jsonl TRUTH.csv INDEX.csv, the world's lines made
with anchor-replay. Objects of CLASS, p >= 0.5 and last seen at most SEEN seconds ago are held
against the truth of their class, one to one, as many as possible, the nearest, within RADIUS m in
the plane. Prints Markdown, a row each of SCORE.py's numbers for

- what was answered;
- the same with the truth's names: every object that has a truth point is called as that one;
- the same without what has none;
- both;
- the detections of the frames themselves that are reported as CLASS, held against the truth like
  that, without those that have no truth point: what is found in each frame, rightly associated.
"""

from __future__ import annotations

import csv
import gzip
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.optimize import linear_sum_assignment

Rows = dict[int, list[tuple[str, list[float]]]]  # per frame: name, x and y

COLUMNS = ["HOTA", "DetA", "AssA", "IDF1", "IDSW", "FP", "FN"]


def lines(path: str) -> Iterator[dict]:
    with gzip.open(path, "rt") if path.endswith(".gz") else open(path) as f:
        yield from map(json.loads, filter(str.strip, f))


def top(distribution: dict[str, float]) -> str:
    return max(distribution, key=lambda symbol: distribution[symbol])


def read_truth(path: str, cls: str) -> Rows:
    rows: Rows = {}
    with open(path, newline="") as f:
        for r in csv.DictReader(f):
            if r["class"] == cls and not float(r.get("ignore") or 0) > 0:
                rows.setdefault(int(r["frame"]), []).append((r["id"], [float(r["x"]), float(r["y"])]))
    return rows


def read_world(path: str, frames: dict[int, int], cls: str, seen: float) -> Rows:
    rows: Rows = {}
    for line in lines(path):
        if line["utime"] in frames:
            rows[frames[line["utime"]]] = [
                (o["id"], o["position"][:2])
                for o in line["objects"]
                if o["p"] >= 0.5
                and o.get("position")
                and o.get("in_best") is not False
                and (line["utime"] - o["last_seen"]) * 1e-6 <= seen
                and top(o["attributes"].get("class") or {"": 1}) == cls
            ]
    return rows


def in_map(pose: dict | None, point: list[float]) -> list[float]:
    if pose is None:
        return point[:2]
    w, *axis = pose["orientation"]
    v = np.array((point + [0])[:3])
    turned = v + 2 * np.cross(axis, np.cross(axis, v) + w * v)
    return list(turned[:2] + pose["position"][:2])


def read_detections(path: str, frames: dict[int, int], cls: str) -> Rows:
    rows: Rows = {}
    for line in lines(path):
        if line["utime"] in frames:
            rows[frames[line["utime"]]] = [
                (f"d{i}", in_map(line.get("pose"), z["position"]))
                for i, z in enumerate(line["detections"])
                if top(z["attributes"]["class"]) == cls
            ]
    return rows


def names(truth: Rows, found: Rows, radius: float) -> dict[tuple[int, str], str]:
    """Of what was found: the truth's name."""
    out = {}
    for frame, rows in found.items():
        true = truth.get(frame, [])
        if not rows or not true:
            continue
        at = np.array([p for _, p in rows])[:, None] - np.array([p for _, p in true])[None]
        distance = np.hypot(at[..., 0], at[..., 1])
        cost = np.where(distance < radius, distance, 1e6)
        for i, k in zip(*linear_sum_assignment(cost)):
            if cost[i, k] < radius:
                out[frame, rows[i][0]] = f"true {true[k][0]}"
    return out


def write(path: Path, rows: Rows, cls: str, name: dict, rename: bool, drop: bool) -> None:
    with open(path, "w", newline="") as f:
        out = csv.writer(f)
        out.writerow(["frame", "id", "x", "y", "class"])
        for frame, found in rows.items():
            for own, (x, y) in found:
                true = name.get((frame, own))
                if true or not drop:
                    out.writerow([frame, true if true and rename else own, x, y, cls])


def main() -> None:
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    score, cls, radius, seen = sys.argv[1], sys.argv[2], float(sys.argv[3]), float(sys.argv[4])
    sequences = [line.split() for line in sys.stdin if line.strip()]
    kinds = {  # the detections, the truth's names, without what is false
        "answered": (False, False, False),
        "with the truth's names": (False, True, False),
        "without what is false": (False, False, True),
        "both": (False, True, True),
        "detections, both": (True, True, True),
    }
    print("| | " + " | ".join(COLUMNS) + " |\n| --- |" + " ---: |" * len(COLUMNS))
    with tempfile.TemporaryDirectory() as folder:
        for kind, (detections, rename, drop) in kinds.items():
            tracks = []
            for n, (frames, world, truth, index) in enumerate(sequences):
                with open(index, newline="") as f:
                    number = {int(r["utime"]): int(r["frame"]) for r in csv.DictReader(f)}
                true = read_truth(truth, cls)
                rows = (
                    read_detections(frames, number, cls)
                    if detections
                    else read_world(world, number, cls, seen)
                )
                tracks.append(f"{folder}/{n}.csv")
                write(Path(tracks[-1]), rows, cls, names(true, rows, radius), rename, drop)
            command = [sys.executable, score, "--truth", *(s[2] for s in sequences)]
            command += ["--track", *tracks, "--radius", str(radius), "--dims", "2", "--per-class"]
            done = subprocess.run(command, check=True, capture_output=True, text=True)
            for line in map(json.loads, done.stdout.splitlines()):
                if line["class"] == cls:
                    cells = [line[c] for c in COLUMNS]
                    shown = [f"{c:.1f}" if isinstance(c, float) else str(c) for c in cells]
                    print(f"| {kind} | " + " | ".join(shown) + " |")


if __name__ == "__main__":
    main()
