"""Tables beside the thesis' words."""

from __future__ import annotations

import identity

Row = dict[str, str]
Runs = dict[str, dict[int, list[Row]]]  # by variant and seed


def table(head: list[str], rows: list[list[str]], numbers: int = 0) -> str:
    """`numbers`: how many of the last columns are numbers."""
    rules = ["---"] * (len(head) - numbers) + ["---:"] * numbers
    return "\n".join("| " + " | ".join(r) + " |" for r in [head, rules, *rows]) + "\n"


def percent(hits: int, of: int) -> str:
    return f"{100 * hits / of:.1f} %"


def mean(values: list[float]) -> float:
    return sum(values) / len(values)


def complete(row: Row) -> bool:
    """All objects are shown, each under a name of its own, and no other."""
    names = [n for n in row["names"].split() if n != "0"]
    return int(row["shown"]) == int(row["truth"]) == len(set(names))


def share(runs: dict[int, list[Row]], part: str, holds, when=lambda row: True) -> str:
    rows = [r for run in runs.values() for r in run if r["part"] == part and when(r)]
    return percent(sum(map(holds, rows)), len(rows)) + " of frames"


def last(run: list[Row], part: str, before: float = float("inf")) -> list[str]:
    rows = [r for r in run if r["part"] == part and float(r["time"]) < before]
    return rows[-1]["names"].split()


def runs_with(runs: dict[int, list[Row]], holds) -> str:
    return f"{sum(map(holds, runs.values()))} of {len(runs)} runs"


SETTLED = 1.0  # s after which all objects should have been found
PUSHED = 26.0  # s: the second green box is not yet on its way
LEFT, SMALL, RED, RIGHT = range(4)


def large(row: Row) -> bool:
    return float(row["one_large"]) >= 0.5


def boxes(runs: Runs) -> str:
    def same(run: list[Row], who: list[int], a: str, b: str) -> bool:
        first, then = last(run, a, PUSHED), last(run, b)
        return all(first[i] == then[i] != "0" for i in who)

    claims = [
        ("all three objects are there, each under its own name",
         lambda v: share(v, "three", complete, lambda r: float(r["time"]) > SETTLED)),
        ("false negatives do not matter: the same in frames with one, after the occlusion",
         lambda v: share(v, "cup", complete, lambda r: float(r["time"]) > 12 + SETTLED
                         and int(r["detections"]) < int(r["truth"]))),
        ("(an error) the red cup is taken for the red box",
         lambda v: runs_with(v, lambda run: same(run, [RED], "three", "cup"))),
        ("the others keep their names",
         lambda v: runs_with(v, lambda run: same(run, [LEFT, SMALL], "three", "cup"))),
        ("a second green box is added without problems: all four are there",
         lambda v: share(v, "added", complete, lambda r: 18 + SETTLED < float(r["time"]) < PUSHED)),
        ("(an error) the boxes touch: a large green rectangle is added",
         lambda v: runs_with(v, lambda run: any(large(r) for r in run if r["part"] == "touching"))),
        ("... and believed", lambda v: share(v, "touching", large)),
        ("(not in the thesis) while they touch, all four are there",
         lambda v: share(v, "touching", complete)),
        ("(not in the thesis) 8 s later they are apart: all four are there",
         lambda v: runs_with(v, lambda run: complete(run[-1]))),
        ("(not in the thesis) ... and both green boxes under their names of before",
         lambda v: runs_with(v, lambda run: same(run, [LEFT, RIGHT], "added", "parted"))),
    ]
    rows = [[words, *(measure(v) for v in runs.values())] for words, measure in claims]
    return table(["the thesis", *runs], rows)


def cups(runs: Runs) -> str:
    trials = {
        "new": [("partial", "new", "two_cups", "the cup in sight is a new one"),
                ("after", "new", "two_cups", "it was: two cups")],
        "moved": [("partial", "moved", "one_cup", "the cup in sight is the known one, moved"),
                  ("partial", "new", "", "(that it is a new one is still there, less probable)"),
                  ("after", "new", "two_cups", "corrected: the known cup stands where it stood, "
                                               "the other is new")],
    }
    rows = []
    for trial, claims in trials.items():
        for part, column, best, words in claims:
            at_end = [[r for r in run if r["part"] == part][-1] for run in runs[trial].values()]
            values = [float(r[column]) for r in at_end]
            leads = sum(int(r[best]) for r in at_end) if best else None
            rows.append([trial, part, words,
                         f"{leads} of {len(at_end)}" if leads is not None else "-",
                         f"{mean(values):.4f}", f"{min(values):.4f}"])
    return table(["trial", "part", "the thesis", "best world says so, runs", "its probability, mean",
                  "least"], rows, 3)


def hidden_points(rows: list[Row]) -> dict[tuple[str, str, str, float], list[Row]]:
    """Runs by variant, ambiguity, false positives and seconds."""
    points: dict[tuple[str, str, str, float], list[Row]] = {}
    for r in rows:
        key = (r["variant"], r["ambiguity"], r["false_positives"], float(r["seconds"]))
        points.setdefault(key, []).append(r)
    return points


def hidden(rows: list[Row]) -> str:
    points = hidden_points(rows)
    variants = list(dict.fromkeys(k[0] for k in points))
    seconds = sorted({k[3] for k in points})
    out = []
    for ambiguity in dict.fromkeys(k[1] for k in points):
        for clutter in dict.fromkeys(k[2] for k in points):
            for variant in variants:
                cells = []
                for s in seconds:
                    at = points[variant, ambiguity, clutter, s]
                    right = sum(int(r["right"]) for r in at)
                    p = mean([float(r["probability"]) for r in at])
                    cells.append(f"{right}/{len(at)} {p:.3f}")
                out.append([ambiguity, clutter, variant, *cells])
    return table(["ambiguity", "false positives", "models", *(f"{s:g} s" for s in seconds)], out,
                 len(seconds))


def ants(runs: Runs) -> str:
    rows = []
    for variant, by_seed in runs.items():
        for seed, run in by_seed.items():
            names = [r["names"].split() for r in run]
            s = identity.scores(names, sum(int(r["shown"]) for r in run))
            off = mean([abs(float(r["expected"]) - int(r["truth"])) for r in run])
            missing = mean([int(r["truth"]) - int(r["detections"]) for r in run])
            rows.append([str(seed), f"{missing:.2f}", f"{off:.2f}", f"{100 * s['kept']:.1f}",
                         f"{100 * s['idf1']:.1f}", f"{s['switches']}"])
    middle = [mean([float(row[i]) for row in rows]) for i in range(1, 6)]
    rows.append(["mean", *(f"{m:.2f}" for m in middle)])
    return table(["seed", "ants without a detection of their own", "expected number, off by",
                  "own name, % of frames", "IDF1, %", "switches"], rows, 6)
