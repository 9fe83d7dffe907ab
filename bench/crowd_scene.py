#!/usr/bin/env python3
"""Makes a scene of like objects: what bench/crowd.json describes, for settings to be chosen on.

    crowd_scene.py OBJECTS SEED PREFIX [--hz 1] [--frames 30] [--first 8]

Constant velocity with white acceleration (psd 0.01 m^2/s^3 per axis), speeds N(0, 0.3^2) m/s per
axis, started uniformly in 20 x 20 m; noise 0.15 m per axis, p_D 0.9, on average 5 clutter
detections a frame over 30 x 30 m (from -5 to 25). Writes PREFIX.frames.jsonl, PREFIX.truth.csv
(frame,id,x,y) and PREFIX.index.csv (utime,frame), the latter from frame `first` on.
"""

from __future__ import annotations

import argparse
import csv
import json

import numpy as np

PSD, SPEED, NOISE, DETECTED, CLUTTER = 0.01, 0.3, 0.15, 0.9, 5
START_US = 1_700_000_000_000_000


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("objects", type=int)
    parser.add_argument("seed", type=int)
    parser.add_argument("prefix")
    parser.add_argument("--hz", type=float, default=1)
    parser.add_argument("--frames", type=int, default=30)
    parser.add_argument("--first", type=int, default=8)
    a = parser.parse_args()
    dice, dt = np.random.default_rng(a.seed), 1 / a.hz
    moved = np.linalg.cholesky(PSD * np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]]))
    position = dice.uniform(0, 20, (a.objects, 2))
    velocity = dice.normal(0, SPEED, (a.objects, 2))
    with (
        open(a.prefix + ".frames.jsonl", "w") as frames,
        open(a.prefix + ".truth.csv", "w", newline="") as truth_file,
        open(a.prefix + ".index.csv", "w", newline="") as index_file,
    ):
        truth, index = csv.writer(truth_file), csv.writer(index_file)
        truth.writerow(["frame", "id", "x", "y"])
        index.writerow(["utime", "frame"])
        for k in range(a.frames):
            if k > 0:
                push = np.einsum("ij,njd->nid", moved, dice.normal(size=(a.objects, 2, 2)))
                position = position + dt * velocity + push[:, 0]
                velocity = velocity + push[:, 1]
            seen = position[dice.uniform(size=a.objects) < DETECTED]
            seen = seen + dice.normal(0, NOISE, seen.shape)
            clutter = dice.uniform(-5, 25, (dice.poisson(CLUTTER), 2))
            points = dice.permutation(np.concatenate([seen, clutter]))
            utime = START_US + round(1e6 * k / a.hz)
            r = NOISE**2
            frame = {
                "utime": utime,
                "sensor": "camera",
                "view": {"type": "world"},
                "detections": [
                    {"position": [round(x, 6), round(y, 6)], "covariance": [r, 0, 0, r]}
                    for x, y in points.tolist()
                ],
            }
            frames.write(json.dumps(frame) + "\n")
            if k >= a.first:
                index.writerow([utime, k])
                for i, (x, y) in enumerate(position.tolist()):
                    truth.writerow([k, i, round(x, 5), round(y, 5)])


if __name__ == "__main__":
    main()
