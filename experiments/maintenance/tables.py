"""Tables of the report, as Markdown."""

from __future__ import annotations

from intervals import Runs, at_distance, interval, paired, show


def table(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def column(rows: list[dict[str, str]], name: str) -> list[float]:
    return [float(row[name]) for row in rows]


def below(runs: Runs, study: str, name: str, planner: str = "greedy") -> list[float]:
    """The settings at which a planner's mean lies below the tour's, by 95 % interval."""
    tour = runs[study, "", "tour", 0.0]
    out = []
    for key in sorted(k for k in runs if k[0] == study and k[2] == planner):
        mean, half = paired(runs[key], tour, name)
        if mean + half < 0:
            out.append(key[3])
    return out


def span(values: list[float], unit: str) -> str:
    return f"at {values[0]:g} to {values[-1]:g}{unit}" if values else "nowhere"


def verdict(holds: bool) -> str:
    return "holds" if holds else "does not hold"


def claims(runs: Runs) -> str:
    tour = runs["threshold", "", "tour", 0.0]

    def at(study: str, value: float) -> list[dict[str, str]]:
        return runs[study, "", "greedy", value]

    rows = []
    for study, unit, most in (("threshold", " nat", 16), ("omega", "", 2)):
        worst = below(runs, study, "h_max")
        count = sum(1 for k in runs if k[0] == study and k[2] == "greedy")
        low = min(k[3] for k in runs if k[0] == study and k[2] == "greedy")
        difference = paired(at(study, low), tour, "h_max"), paired(at(study, most), tour, "h_max")
        rows.append(
            [
                f"H_max below the tour's for all {study}s",
                f"{span(worst, unit)}; greedy - tour {show(difference[0])} nat at {low:g}{unit}, "
                f"{show(difference[1])} at {most}{unit}",
                verdict(len(worst) == count),
            ]
        )
        total = below(runs, study, "h_sum")
        limit = 10 if study == "threshold" else 1.5
        rows.append(
            [
                f"H_sum below it up to {'10 nat' if study == 'threshold' else 'omega = 1.7'}",
                span(total, unit),
                verdict(bool(total) and total[-1] >= limit),
            ]
        )
    driven = interval(column(tour, "distance"))[0]
    for value, claim, low, high in (
        (9.0, "about half", 0.4, 0.6),
        (16.0, "about a tenth", 0.07, 0.13),
    ):
        share = interval([d / driven for d in column(at("threshold", value), "distance")])
        less = " (less still)" if share[0] < low else ""
        rows.append(
            [f"distance at {value:g} nat: {claim}", f"{show(share)} of the tour's",
             verdict(low <= share[0] <= high) + less]
        )
    most = max(
        interval(column(rows_, "distance"))[0]
        for key, rows_ in runs.items()
        if key[0] == "omega" and key[2] == "greedy"
    )
    rows.append(
        ["distance below the tour's for all omega", f"at most {most / driven:.2f} of it",
         verdict(most < driven)]
    )
    ends = [interval(column(at("omega", w), "distance"))[0] for w in (0.05, 2.0)]
    rows.append(
        ["distance falls as omega rises", f"{ends[0]:.0f} m at 0.05, {ends[1]:.0f} m at 2",
         verdict(ends[1] < 0.95 * ends[0])]
    )
    for name, mine, theirs in (("actions", 104, 263), ("updates", 515, 973)):
        a, b = interval(column(at("omega", 1.0), name)), interval(column(tour, name))
        rows.append(
            [f"fewer {name} at omega = 1: {mine} against {theirs}",
             f"{show(a, 0)} against {show(b, 0)}", verdict(a[0] + a[1] < b[0] - b[1])]
        )
    for name, label in (("h_max", "H_max"), ("h_sum", "H_sum")):
        held = ", ".join(f"{t:g}" for t in below(runs, "threshold", name, "look-ahead"))
        tried = ", ".join(
            f"{k[3]:g}" for k in sorted(runs) if k[0] == "threshold" and k[2] == "look-ahead"
        )
        rows.append(
            [f"(not in the thesis) look-ahead: {label} below the tour's",
             f"at {held or 'none'} of {tried} nat", ""]
        )
    return table(["the thesis", "measured", ""], rows)


def up_to(runs: Runs, variant: str, name: str) -> str:
    """The greatest threshold up to which the greedy rule is below the tour in the mean."""
    tour = interval(column(runs["sensitivity", variant, "tour", 0.0], name))[0]
    best = "never"
    for key in sorted(k for k in runs if k[1] == variant and k[2] == "greedy by threshold"):
        if interval(column(runs[key], name))[0] >= tour:
            break
        best = f"{key[3]:g}"
    return best


def sensitivity(runs: Runs) -> str:
    rows = []
    for variant in dict.fromkeys(k[1] for k in runs if k[0] == "sensitivity"):

        def mean(strategy: str, value: float, name: str, v: str = variant) -> float:
            return interval(column(runs["sensitivity", v, strategy, value], name))[0]

        def pair(name: str) -> str:
            return f"{mean('greedy by omega', 1.0, name):.0f} / {mean('tour', 0.0, name):.0f}"

        driven = mean("tour", 0.0, "distance")
        rows.append(
            [variant, pair("actions"), pair("updates"), up_to(runs, variant, "h_max"),
             up_to(runs, variant, "h_sum")]
            + [f"{mean('greedy by threshold', t, 'distance') / driven:.2f}" for t in (9.0, 16.0)]
            + [f"{mean('greedy by omega', w, 'distance') / driven:.2f}" for w in (0.05, 1.7)]
        )
    head = ["assumption", "actions, omega 1 / tour", "updates", "H_max below up to [nat]",
            "H_sum below up to [nat]", "D at 9 nat / tour", "at 16 nat",
            "D at omega 0.05, 8 nat / tour", "at 1.7"]  # fmt: skip
    return table(head, rows)


def points(runs: Runs, study: str, objects: int) -> str:
    rows = []
    for key, runs_ in runs.items():
        if key[0] != study:
            continue
        h = interval([v / objects for v in column(runs_, "h_sum")])
        rows.append(
            [key[2], f"{key[3]:g}", show(h), show(interval(column(runs_, "h_max"))),
             show(interval(column(runs_, "distance")), 0),
             show(interval([100 * v for v in column(runs_, "lost")]), 1)]
        )
    head = ["strategy", "pause [s] or omega", "entropy per object [nat]", "H_max [nat]",
            "distance [m]", "objects not believed within 1 m [%]"]  # fmt: skip
    return table(head, rows)


DISTANCES = (60.0, 100.0, 140.0, 180.0, 220.0, 260.0)


def equal_distance(runs: Runs, variant: str) -> str:
    """Entropy per object at equal distance, each run's curve interpolated, differences paired."""
    curves: dict[str, list[list[tuple[float, float]]]] = {}
    for key, rows in runs.items():
        if key[:2] != ("house", variant):
            continue
        per_run = curves.setdefault(key[2], [[] for _ in rows])
        for curve, row in zip(per_run, rows):
            curve.append((float(row["distance"]), float(row["h_sum"]) / 40))
    names = ["tour", "patrol", "greedy by threshold", "greedy by omega", "look-ahead"]
    rows = []
    for distance in DISTANCES:
        at = {n: [at_distance(curve, distance) for curve in curves[n]] for n in names}
        row = [f"{distance:.0f}"]
        for name in names:
            known = [y for y in at[name] if y is not None]
            row.append(show(interval(known)) if 2 * len(known) > len(at[name]) else "-")
        for other in ("tour", "greedy by threshold", "greedy by omega"):
            both = [a - b for a, b in zip(at["look-ahead"], at[other])
                    if a is not None and b is not None]  # fmt: skip
            row.append(show(interval(both)) if 2 * len(both) > len(at[other]) else "-")
        rows.append(row)
    head = ["distance [m]", *names, "look-ahead less tour", "less greedy by threshold",
            "less greedy by omega"]  # fmt: skip
    runs_made = len(curves["look-ahead"])
    return f"Things of psd {variant}; runs: {runs_made}\n\n" + table(head, rows)
