#!/usr/bin/env python3
"""Whether what a crowd's scores lack could have been known: the ceiling, and each switch's odds.

    exchanges.py SCORE.py FRAMES.jsonl[.gz] WORLD.jsonl TRUTH.csv INDEX.csv [--clutter 0.00556]

For scenes of constant velocity that were made with the numbers below (bench/crowd_scene.py and its
like; those of `build/crowd_bench --write` with a --clutter of 1 / side^2). Prints Markdown:

- the scores of the answer; of the answer under the truth's names; and of what the exact Kalman
  filters of the objects say that are given the right detections and no other: positions cannot be
  known better on-line, and no association is better than that;
- each change of names that is counted as switches (CLEAR-MOT), with the posterior of the two
  assignments of names, kept and as answered, given the detections up to that frame, one, two, five
  and ten frames later and to the end: ln P(kept) - ln P(answered), and ln P(true) - ln P(answered).
  Below 0 the evidence is for the exchange. Where the answer is the true one again the latter is
  left out.

The posterior is over all associations of the objects concerned, by their filters and the
generator's own model, from the frame on by which each of them has been detected; of those that were
within 1 m of one of them in the last five frames, too, the nearest first, four at most in all.
Detections of other objects are left out. So it knows more than a tracker could. Names count from
that frame on, too, also where the truth begins later: what was exchanged before, and is put right
after, counts as a switch. Histories of less than 1e-7 of the best go, the best 1000 are kept; with
more than 2 frames a second those whose tracks had the same detections in the last second are one.

Which detection is an object's is not in the data: the most probable one-to-one assignment to the
true positions; before the truth's first frame, to their continuation backwards.
"""

from __future__ import annotations

import argparse
import csv
import gzip
import itertools
import json
import math
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

PSD, SPEED, NOISE, DETECTED, RADIUS = 0.01, 0.3, 0.15, 0.9, 1.0
LATER = [0, 1, 2, 5, 10]
COLUMNS = ["HOTA", "DetA", "AssA", "IDF1", "IDSW", "FP", "FN"]
NEVER = 1e6


class State(NamedTuple):
    """Position and velocity; both axes have the same covariance."""

    x: float
    y: float
    vx: float
    vy: float
    pp: float
    pv: float
    vv: float

    def after(self, dt: float) -> State:
        return State(
            self.x + dt * self.vx,
            self.y + dt * self.vy,
            self.vx,
            self.vy,
            self.pp + 2 * dt * self.pv + dt * dt * self.vv + PSD * abs(dt) ** 3 / 3,
            self.pv + dt * self.vv + PSD * dt * abs(dt) / 2,
            self.vv + PSD * abs(dt),
        )

    def given(self, z: tuple[float, float]) -> tuple[State, float]:
        """Kalman update, and ln of the likelihood."""
        s = self.pp + NOISE**2
        dx, dy = z[0] - self.x, z[1] - self.y
        k, g = self.pp / s, self.pv / s
        state = State(
            self.x + k * dx,
            self.y + k * dy,
            self.vx + g * dx,
            self.vy + g * dy,
            (1 - k) * self.pp,
            (1 - k) * self.pv,
            self.vv - g * self.pv,
        )
        return state, -math.log(2 * math.pi * s) - (dx * dx + dy * dy) / (2 * s)

    @staticmethod
    def first(z: tuple[float, float]) -> State:
        return State(z[0], z[1], 0, 0, NOISE**2, 0, SPEED**2)


class Scene(NamedTuple):
    time: list[float]  # of each frame, s
    detections: list[list[tuple[float, float]]]
    truth: dict[int, dict[str, tuple[float, float]]]
    answer: dict[int, dict[str, tuple[float, float]]]
    first: int  # frame of the truth as given; before it, it is estimated
    clutter: float  # per m^2
    origins: list[dict[str, int]]  # per frame: the detection of each object that has one


def opened(path: str):
    return gzip.open(path, "rt") if path.endswith(".gz") else open(path, newline="")


def read(a: argparse.Namespace) -> Scene:
    with opened(a.frames) as f:
        frames = [json.loads(line) for line in f if line.strip()]
    with opened(a.index) as f:
        number = {int(r["utime"]): int(r["frame"]) for r in csv.DictReader(f)}
    if any(frames[k]["utime"] != utime for utime, k in number.items()):
        sys.exit("exchanges.py: INDEX must count the frames of FRAMES from 0")
    number = {f["utime"]: k for k, f in enumerate(frames)}
    truth: dict = defaultdict(dict)
    with opened(a.truth) as f:
        for r in csv.DictReader(f):
            truth[int(r["frame"])][r["id"]] = (float(r["x"]), float(r["y"]))
    answer = {}
    with opened(a.world) as f:
        for world in map(json.loads, f):
            if (frame := number.get(world["utime"])) is not None:
                answer[frame] = {
                    o["id"]: tuple(o["position"][:2])
                    for o in world["objects"]
                    if o["p"] >= 0.5 and o.get("position") and o.get("in_best") is not False
                }
    time = [(f["utime"] - frames[0]["utime"]) * 1e-6 for f in frames]
    detections = [[tuple(z["position"][:2]) for z in f["detections"]] for f in frames]
    first = min(truth)
    scene = Scene(time, detections, dict(truth), answer, first, a.clutter, [{} for _ in frames])
    find_origins(scene)
    return scene


def assign(cost: np.ndarray) -> list[tuple[int, int]]:
    return [(i, k) for i, k in zip(*linear_sum_assignment(cost)) if cost[i, k] < 0]


def find_origins(scene: Scene) -> None:
    """Each object's detections; see above."""
    nothing = math.log((1 - DETECTED) * scene.clutter / DETECTED)

    def origins(states: dict[str, State], frame: int) -> dict[str, int]:
        ids, points = list(states), scene.detections[frame]
        gain = [[states[i].given(z)[1] - nothing for z in points] for i in ids]
        worth = np.maximum(gain, 0).reshape(len(ids), len(points))
        return {ids[i]: k for i, k in assign(-worth)}

    first = scene.first
    for frame, at in scene.truth.items():
        scene.origins[frame].update(
            origins({i: State(x, y, 0, 0, 0, 0, 0) for i, (x, y) in at.items()}, frame)
        )
    dt = scene.time[first + 1] - scene.time[first]
    states = {}
    for i, (x, y) in scene.truth[first].items():
        x1, y1 = scene.truth[first + 1][i]
        states[i] = State(x, y, (x1 - x) / dt, (y1 - y) / dt, 0, 0, PSD * dt / 3)
    for frame in range(first - 1, -1, -1):
        dt = scene.time[frame] - scene.time[frame + 1]
        states = {i: s.after(dt) for i, s in states.items()}
        for i, k in origins(states, frame).items():
            scene.origins[frame][i] = k
            states[i] = states[i].given(scene.detections[frame][k])[0]
        scene.truth[frame] = {i: (s.x, s.y) for i, s in states.items()}


def filtered(scene: Scene, i: str, until: int) -> list[State | None]:
    """The state of an object after each frame up to `until`, of its own detections alone."""
    out: list[State | None] = []
    state = None
    for frame in range(until + 1):
        if state and frame:
            state = state.after(scene.time[frame] - scene.time[frame - 1])
        if (k := scene.origins[frame].get(i)) is not None:
            z = scene.detections[frame][k]
            state = state.given(z)[0] if state else State.first(z)
        out.append(state)
    return out


def match(truth: dict, tracks: dict, kept: dict[str, str]) -> dict[str, str]:
    """CLEAR-MOT: the name of each object, those of the last frame first where they still match."""
    ids, names = list(truth), list(tracks)
    if not ids or not names:
        return {}
    difference = np.array([truth[i] for i in ids])[:, None] - np.array([tracks[n] for n in names])
    d = np.hypot(difference[..., 0], difference[..., 1])
    keeps = np.array([[kept.get(i) == n for n in names] for i in ids])
    gain = np.where(d <= RADIUS + 1e-9, 1 - d / (2 * RADIUS) + 1000 * keeps, 0)
    return {ids[i]: names[k] for i, k in assign(-gain)}


def names_by_frame(scene: Scene) -> dict[int, dict[str, str]]:
    """The name that each object had last, up to each frame."""
    out, now, ever = {}, {}, {}
    for frame in sorted(scene.answer):
        now = match(scene.truth[frame], scene.answer[frame], now)
        ever = {**ever, **now}
        out[frame] = ever
    return out


def with_neighbours(scene: Scene, group: list[str], frame: int) -> list[str]:
    near = {}
    for k in range(max(frame - 4, 0), frame + 1):
        at = scene.truth[k]
        for i in set(at) - set(group):
            near[i] = min(near.get(i, NEVER), *(math.dist(at[i], at[j]) for j in group))
    return group + sorted((i for i in near if near[i] < 1), key=near.get)[: max(4 - len(group), 0)]


def posterior(scene: Scene, members: list[str], frame: int, until: int) -> dict[int, dict]:
    """ln P(which object each member's track follows at `frame`), given the detections up to there
    and to each later frame; tracks begin as the objects, in the order of the members."""
    group = with_neighbours(scene, members, frame)
    hz = 1 / (scene.time[1] - scene.time[0])
    first = max(next(k for k, o in enumerate(scene.origins) if i in o) for i in group)
    begun = [filtered(scene, i, first)[-1] for i in group]
    if first >= frame:
        return {}
    memory = 10**9 if hz <= 2 else round(hz)
    # Per track its state and its latest detections; the assignment at `frame`; ln weight.
    Hypothesis = tuple[tuple[tuple[State, tuple], ...], tuple]
    worlds: dict[Hypothesis, float] = {(tuple((s, ()) for s in begun), ()): 0.0}
    out = {}
    for k in range(first + 1, until + 1):
        dt = scene.time[k] - scene.time[k - 1]
        others = {z for i, z in scene.origins[k].items() if i not in group}
        points = [(z, p) for z, p in enumerate(scene.detections[k]) if z not in others]
        versions: dict = {}

        def children(track: tuple[State, tuple]) -> list:
            state = track[0].after(dt)
            last = track[1] if memory > 10**8 else tuple(r for r in track[1] if r[0] > k - memory)
            found = [(-1, math.log(1 - DETECTED), (state, last))]
            for z, p in points:
                if (p[0] - state.x) ** 2 + (p[1] - state.y) ** 2 < 40 * (state.pp + NOISE**2):
                    new, ln = state.given(p)
                    ln += math.log(DETECTED / scene.clutter)
                    found.append((z, ln, (new, (*last, (k, z)))))
            return found

        grown: dict = defaultdict(lambda: -math.inf)
        kept: dict = {}
        for (tracks, was), weight in worlds.items():
            for track in tracks:
                if track not in versions:
                    versions[track] = children(track)
            for choice in itertools.product(*(versions[t] for t in tracks)):
                taken = [z for z, _, _ in choice if z >= 0]
                if len(set(taken)) < len(taken):
                    continue
                ln = weight + sum(c[1] for c in choice)
                after = tuple(c[2] for c in choice)
                key = (tuple(t[1] for t in after), was)
                if key not in kept or ln > kept[key][0]:
                    kept[key] = (ln, after)
                grown[key] = np.logaddexp(grown[key], ln)
        best = max(grown.values())
        order = sorted(grown, key=lambda key: -grown[key])[:1000]
        worlds = {
            (kept[key][1], key[1]): float(grown[key] - best)
            for key in order
            if grown[key] > best + math.log(1e-7)
        }
        if k == frame:
            at = [scene.truth[k][i] for i in group]
            told = {}
            for (tracks, _), weight in worlds.items():
                cost = [[math.hypot(t.x - x, t.y - y) - NEVER for x, y in at] for t, _ in tracks]
                follows = tuple(group[i] for _, i in assign(np.array(cost)))[: len(members)]
                told[(tracks, follows)] = weight
            worlds = told
        if k >= frame:
            of: dict = defaultdict(lambda: -math.inf)
            for (_, follows), weight in worlds.items():
                of[follows] = float(np.logaddexp(of[follows], weight))
            total = np.logaddexp.reduce(list(of.values()))
            out[k] = {follows: ln - total for follows, ln in of.items()}
    return out


def changes(scene: Scene):
    """Each change of names: frame, the objects concerned, and which of them the name that each had
    first follows before and after; None where one is not there any more."""
    names = names_by_frame(scene)
    frames = sorted(names)
    earliest: dict[str, str] = {}
    for frame in frames:
        for i, name in names[frame].items():
            if name not in earliest.values():
                earliest.setdefault(i, name)
    start = {name: i for i, name in earliest.items()}
    for before, frame in zip(frames, frames[1:]):
        if frame <= scene.first:
            continue
        old, new = names[before], names[frame]
        left = {i for i in old if new[i] != old[i]}
        while left:
            group, todo = set(), {left.pop()}
            while todo:
                i = todo.pop()
                group.add(i)
                mine = {old.get(i), new.get(i), earliest.get(i)} - {None}
                todo |= {start[n] for n in mine if n in start} - group
                todo |= {j for j in new if new[j] in mine or old.get(j) in mine} - group
            count = len({i for i in group if i in old and new[i] != old[i]})
            left -= group
            members = sorted(group)

            def follows(by: dict[str, str]):
                who = {by[i]: i for i in members if i in by}
                mine = [earliest.get(i) for i in members]
                told = tuple(who.get(n) for n in mine)
                return told if None not in told else None

            yield frame, members, count, follows(old), follows(new)


def score(program: str, truth: dict, tracks: dict) -> str:
    with tempfile.TemporaryDirectory() as folder:
        for name, rows in (("truth", truth), ("track", tracks)):
            with open(Path(folder) / name, "w", newline="") as f:
                out = csv.writer(f)
                out.writerow(["frame", "id", "x", "y"])
                out.writerows((k, i, *p) for k, at in rows.items() for i, p in at.items())
        command = [sys.executable, program, "--truth", f"{folder}/truth", "--track"]
        command += [f"{folder}/track", "--radius", str(RADIUS), "--dims", "2"]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
    line = json.loads(done.stdout)
    cells = [line[c] for c in COLUMNS]
    return " | ".join(f"{c:.1f}" if isinstance(c, float) else str(c) for c in cells)


def print_scores(scene: Scene, program: str) -> None:
    truth = {k: at for k, at in scene.truth.items() if k >= scene.first}
    answer = {k: at for k, at in scene.answer.items() if k in truth}
    renamed: dict = {}
    filters: dict = {k: {} for k in truth}
    for frame, tracks in answer.items():
        true = {n: f"true {i}" for i, n in match(truth[frame], tracks, {}).items()}
        renamed[frame] = {true.get(n, n): p for n, p in tracks.items()}
    for i in truth[scene.first]:
        for frame, state in enumerate(filtered(scene, i, max(scene.truth))):
            if state and frame in filters and i in truth[frame]:
                filters[frame][i] = (state.x, state.y)
    print("| | " + " | ".join(COLUMNS) + " |\n| --- |" + " ---: |" * len(COLUMNS))
    print(f"| answered | {score(program, truth, answer)} |")
    print(f"| under the truth's names | {score(program, truth, renamed)} |")
    print(f"| filters of the right detections | {score(program, truth, filters)} |\n")


def print_changes(scene: Scene) -> None:
    last = max(scene.truth)
    later = [f"+{n}" if n else "then" for n in LATER] + ["end"]
    print("| frame | objects | switches | kept or answered: " + " | ".join(later), end=" ")
    print("| true or answered: " + " | ".join(later) + " |")
    print("| ---: | --- |" + " ---: |" * (1 + 2 * len(later)))
    for frame, group, count, kept, answered in changes(scene):
        cells = ["a name has come or gone"] + [""] * (2 * len(later) - 1)
        if kept and answered and len(group) <= 5:
            of = posterior(scene, group, frame, last)
            cells = []
            for other in (kept, tuple(group)):
                for k in [frame + n for n in LATER] + [last]:
                    p = of.get(k, {})
                    gone = -16.1  # ln 1e-7
                    odds = p.get(other, gone) - p.get(answered, gone)
                    cells.append(f"{odds:.1f}" if k in of and other != answered else "")
        print(f"| {frame} | {', '.join(group)} | {count} | " + " | ".join(cells) + " |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    for name in ("score", "frames", "world", "truth", "index"):
        parser.add_argument(name)
    parser.add_argument("--clutter", type=float, default=5 / 900, help="density, per m^2")
    a = parser.parse_args()
    scene = read(a)
    print_scores(scene, a.score)
    print_changes(scene)


if __name__ == "__main__":
    main()
