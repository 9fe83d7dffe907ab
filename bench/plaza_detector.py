#!/usr/bin/python3
"""Measures the person detector against true positions on the ground, and fits its numbers.

    tools/fetch_vtest.sh DIR
    build/anchor-detect DIR/vtest.avi --fps 7 --features DIR/features.csv
    bench/plaza_detector.py --features DIR/features.csv --truth TRUTH.csv [--fit]

TRUTH.csv: frame,id,x,y with frames from 1 and metres in the map frame, the middle of the lower
edge of each person's box projected on the ground. For this video the annotation of A. Milan is
usual (MOTChallenge 2015, PETS09-S2L1; CC BY-NC-SA 3.0: not part of this project).

Detections and truths are paired one to one in each frame, as many as lie within --radius of each
other, with least total distance. --fit prints the numbers of config/plaza.camera.json: noise (most
likely normal noise of the foot pixel, of the pairs), score (logistic regression on being paired),
color_report (the sharpness whose beliefs, after 50 frames, pick the right person with least
log-loss). Fitted on all frames; "held out" are the two halves of the video, each scored with what
the other half gives. Needs numpy only.
"""
import argparse, collections, csv, json, os, re
import numpy as np

FEATURES = ("gain", "filled", "observed", "alone", "likeness")


def read(path):
    frames = collections.defaultdict(list)
    with open(path) as file:
        for row in csv.DictReader(file):
            frames[int(row["frame"])].append(row)
    return frames


def assignment(cost):
    """Hungarian method: the column of each row, rows <= columns."""
    n, m = cost.shape
    u, v, row_of = np.zeros(n + 1), np.zeros(m + 1), np.zeros(m + 1, int)
    for i in range(1, n + 1):
        row_of[0], j0 = i, 0
        least, before, used = np.full(m + 1, np.inf), np.zeros(m + 1, int), np.zeros(m + 1, bool)
        while row_of[j0]:
            used[j0] = True
            slack = np.append(np.inf, cost[row_of[j0] - 1] - u[row_of[j0]] - v[1:])
            better = ~used & (slack < least)
            least[better], before[better] = slack[better], j0
            j1 = int(np.argmin(np.where(used, np.inf, least)))
            delta = least[j1]
            u[row_of[used]] += delta
            v[used] -= delta
            least[~used] -= delta
            j0 = j1
        while j0:
            row_of[j0], j0 = row_of[before[j0]], before[j0]
    return {row_of[j] - 1: j - 1 for j in range(1, m + 1) if row_of[j]}


def pair(detections, truths, radius):
    """[truth or None] for each detection, and which truths were missed."""
    partners = [None] * len(detections)
    if detections and truths:
        at = lambda rows: np.array([[float(r["x"]), float(r["y"])] for r in rows])
        distance = np.linalg.norm(at(detections)[:, None] - at(truths)[None], axis=2)
        cost = np.where(distance <= radius, distance, 1e3)
        swapped = cost.shape[0] > cost.shape[1]
        for i, j in assignment(cost.T if swapped else cost).items():
            d, t = (j, i) if swapped else (i, j)
            if distance[d, t] <= radius:
                partners[d] = truths[t]
    found = {t["id"] for t in partners if t}
    return partners, [t for t in truths if t["id"] not in found]


class Projector:
    """Tsai's camera, as perception/camera.h."""

    def __init__(self, path):
        text = re.sub(r"^\s*//.*$", "", open(path).read(), flags=re.M)
        c = self.c = json.loads(text)["camera"]
        rx, ry, rz = c["rotation"]
        cos, sin = np.cos, np.sin
        self.rotation = (
            np.array([[cos(rz), -sin(rz), 0], [sin(rz), cos(rz), 0], [0, 0, 1]])
            @ np.array([[cos(ry), 0, sin(ry)], [0, 1, 0], [-sin(ry), 0, cos(ry)]])
            @ np.array([[1, 0, 0], [0, cos(rx), -sin(rx)], [0, sin(rx), cos(rx)]]))

    def __call__(self, x, y):
        c = self.c
        p = self.rotation @ [x, y, 0] + c["translation"]
        ideal = c["focal"] * p[:2] / p[2]
        r = np.linalg.norm(ideal)
        for _ in range(50):
            r = np.linalg.norm(ideal) / (1 + c["kappa1"] * r * r)
        distorted = ideal * r / max(np.linalg.norm(ideal), 1e-12)
        return distorted / c["pixel"] * [c["sx"], 1] + c["center"]


def logistic(x, y):
    w = np.zeros(x.shape[1])
    for _ in range(50):
        p = 1 / (1 + np.exp(-x @ w))
        hessian = x.T @ (x * (p * (1 - p))[:, None]) + 1e-3 * np.eye(len(w))
        w += np.linalg.solve(hessian, x.T @ (y - p) - 1e-3 * w)
    return w


def log_loss(p, y):
    p = np.clip(p, 1e-6, 1 - 1e-6)
    return -np.mean(y * np.log(p) + (1 - y) * np.log(1 - p))


def fit_score(rows, y, frame, middle):
    x = np.array([[1.0] + [float(r[k]) for k in FEATURES] for r in rows])
    p = np.zeros(len(y))
    for half in (frame <= middle, frame > middle):
        p[half] = 1 / (1 + np.exp(-x[half] @ logistic(x[~half], y[~half])))
    print("score", dict(zip(("bias",) + FEATURES, logistic(x, y).round(2))),
          "log-loss held out %.4f, without features %.4f" % (log_loss(p, y), log_loss(y.mean(), y)))


def fit_noise(rows, partners, projector):
    pairs = [(r, t) for r, t in zip(rows, partners) if t]
    height = np.array([float(r["height_px"]) for r, _ in pairs])
    error = np.array([projector(float(t["x"]), float(t["y"])) -
                      [float(r["foot_u"]), float(r["foot_v"])] for r, t in pairs])
    error /= height[:, None]
    offset = np.median(error, axis=0)
    x = np.array([[1, 1 - float(r["alone"]), max(0, 1 - float(r["gain"]))] for r, _ in pairs])
    print("noise foot_offset", offset.round(4), "of the body's height")
    for axis, name in enumerate("uv"):
        e2, w = (error[:, axis] - offset[axis]) ** 2, np.array([-3.0, 0, 0])
        for _ in range(200):  # Newton on the likelihood of normal errors with log-linear deviation
            ratio = e2 * np.exp(-2 * x @ w)
            hessian = 2 * x.T @ (x * ratio[:, None]) + 1e-6 * np.eye(3)
            w += np.linalg.solve(hessian, x.T @ (ratio - 1))
        print("noise", name, dict(zip(("base", "covered", "weak"), w.round(2))))


def fit_colors(rows, partners, run=50, gap=35):
    """Who is who by color alone: beliefs from `run` frames against all reports of as many frames, a
    `gap` later, as the belief would multiply them along a track."""
    seen = collections.defaultdict(dict)
    for r, t in zip(rows, partners):
        if t and r["colors"].strip():
            seen[t["id"]][int(r["frame"])] = np.array(r["colors"].split(), float)
    best, choices = (np.inf,), 0
    for doubt in (0.02, 0.05, 0.1, 0.2, 0.3, 0.5):
        for sharpness in (0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.5, 1):
            def evidence(at, start):
                shares = np.array([at[f] for f in range(start, start + run) if f in at])
                if len(shares) <= run // 2:
                    return None
                m = ((1 - doubt) * shares + doubt / shares.shape[1]) ** sharpness
                return np.log(m * shares.shape[1] / m.sum(axis=1, keepdims=True)).sum(axis=0)
            losses, chance = [], []
            for frame in range(1, 795, 10):
                before = {who: evidence(at, frame) for who, at in seen.items()}
                after = {who: evidence(at, frame + run + gap) for who, at in seen.items()}
                both = [w for w in seen if before[w] is not None and after[w] is not None]
                for who in both if len(both) > 1 else ():
                    log_l = []
                    for other in both:
                        b = before[other] - np.logaddexp.reduce(before[other])
                        log_l.append(np.logaddexp.reduce(b + after[who]))
                    losses.append(np.logaddexp.reduce(log_l) - log_l[both.index(who)])
                    chance.append(np.log(len(both)))
            best = min(best, (np.mean(losses), doubt, sharpness, np.mean(chance), len(losses)))
    print("color_report doubt %g sharpness %g: log-loss %.3f; guessing: %.3f (%d choices)" % (
        best[1], best[2], best[0], best[3], best[4]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--features", required=True)
    parser.add_argument("--truth", required=True)
    parser.add_argument("--radius", type=float, default=1.0)
    parser.add_argument("--fit", action="store_true")
    here = os.path.dirname(os.path.abspath(__file__))
    parser.add_argument("--camera", default=os.path.join(here, "../config/plaza.camera.json"))
    args = parser.parse_args()
    detected, truth = read(args.features), read(args.truth)
    rows, partners, missed = [], [], 0
    for frame in sorted(truth):
        pairs, misses = pair(detected[frame], truth[frame], args.radius)
        rows += detected[frame]
        partners += pairs
        missed += len(misses)
    y = np.array([t is not None for t in partners], float)
    found = [(r, t) for r, t in zip(rows, partners) if t]
    error = np.array([[float(t[a]) - float(r[a]) for a in "xy"] for r, t in found])
    covariance = np.array([[float(r[c]) for c in ("cxx", "cxy", "cxy", "cyy")]
                           for r, _ in found]).reshape(-1, 2, 2)
    nees = np.einsum("ni,nij,nj->n", error, np.linalg.inv(covariance), error)
    score = np.array([float(r["score"]) for r in rows])
    print("recall %.3f  precision %.3f  false per frame %.3f  (%d detections, %d frames)" % (
        y.sum() / (y.sum() + missed), y.mean(), (1 - y).sum() / len(truth), len(y), len(truth)))
    print("distance: median %.3f m, mean %.3f m;  NEES (2 when consistent): mean %.2f, median %.2f "
          "(1.39)" % (np.median(np.hypot(*error.T)), np.mean(np.hypot(*error.T)), nees.mean(),
                      np.median(nees)))
    print("score: log-loss %.4f; paired where score is" % log_loss(score, y), end="")
    bounds = (0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98, 1.01)
    for low, high in zip(bounds, bounds[1:]):
        inside = (score >= low) & (score < high)
        if inside.any():
            print("  %.2f: %.2f (%d)" % (score[inside].mean(), y[inside].mean(), inside.sum()),
                  end="")
    print("\nat score >= 0.5: recall %.3f, false per frame %.3f" % (
        y[score >= 0.5].sum() / (y.sum() + missed), (1 - y[score >= 0.5]).sum() / len(truth)))
    if args.fit:
        frame = np.array([int(r["frame"]) for r in rows])
        fit_score(rows, y, frame, np.median(list(truth)))
        fit_noise(rows, partners, Projector(args.camera))
        fit_colors(rows, partners)


if __name__ == "__main__":
    main()
