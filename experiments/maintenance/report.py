#!/usr/bin/env python3
"""Figures 3.4, 3.6 and 3.7 of the thesis, and tables beside its claims, from the simulations.

Usage: report.py RUNS.csv... --out DIR [--document FILE.md]

Writes SVG and tables.md to DIR; with --document also puts each table into that file, between the
lines `<!-- NAME -->` and `<!-- end -->`, and the figures beside it.
"""

from __future__ import annotations

import argparse
import collections
import csv
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import tables
from document import save
from intervals import Runs, interval
from plot import Panel, figure


def read(paths: list[str]) -> Runs:
    runs: Runs = collections.defaultdict(list)
    for path in paths:
        with open(path, encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                key = (row["study"], row["variant"], row["strategy"], float(row["value"]))
                runs[key].append(row)
    return runs


PANELS = [
    ("h_max", "Worst object", "H_max [nat]"),
    ("h_sum", "All objects", "H_sum [nat]"),
    ("distance", "Distance driven", "D [m]"),
]


def sweep(runs: Runs, study: str, x_label: str) -> str:
    """Figures 3.4 and 3.6: three panels, the tour as a level line."""
    panels = []
    for column, title, y_label in PANELS:
        panel = Panel(title, x_label, y_label)
        for strategy in ("greedy", "look-ahead", "tour"):
            points = [
                (key[3], *interval([float(r[column]) for r in rows]))
                for key, rows in runs.items()
                if key[0] == study and key[2] == strategy
            ]
            if strategy == "tour":
                xs = sorted(key[3] for key in runs if key[0] == study and key[2] == "greedy")
                points = [(x, *points[0][1:]) for x in (xs[0], xs[-1])]
            panel.curve(strategy, points)
        panels.append(panel)
    return figure(panels)


def bars(runs: Runs) -> str:
    """Figure 3.7: updates and actions per object; the run whose tour is nearest the mean."""
    tours, greedy = runs["omega", "", "tour", 0.0], runs["omega", "", "greedy", 1.0]
    mean = sum(int(r["actions"]) for r in tours) / len(tours)
    k = min(range(len(tours)), key=lambda i: abs(int(tours[i]["actions"]) - mean))
    panels = []
    for column, title in (("updated", "Updates"), ("approached", "Actions")):
        panel = Panel(f"{title} per object", "object", title.lower())
        for name, rows in (("greedy", greedy), ("tour", tours)):
            panel.bars.append((name, [float(n) for n in rows[k][column].split()]))
        panels.append(panel)
    return figure(panels)


def frontier(runs: Runs, studies: list[tuple[str, str, str]], objects: int) -> str:
    """Mean entropy per object against distance driven."""
    panels = []
    for study, variant, title in studies:
        panel = Panel(title, "distance driven [m]", "mean entropy per object [nat]")
        curves = collections.defaultdict(list)
        for key, rows in runs.items():
            if key[0] == study and key[1] == variant:
                h = interval([float(r["h_sum"]) / objects for r in rows])
                d = interval([float(r["distance"]) for r in rows])[0]
                curves[key[2]].append((d, *h))
        for strategy, points in curves.items():
            panel.curve(strategy, points)
        panels.append(panel)
    return figure(panels)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("runs", nargs="+")
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--document", type=pathlib.Path)
    arguments = parser.parse_args()
    runs = read(arguments.runs)
    figures, blocks = {}, {}
    studies = {key[0] for key in runs}
    if {"threshold", "omega"} <= studies:
        figures["threshold"] = sweep(runs, "threshold", "IG_thr [nat]")
        figures["omega"] = sweep(runs, "omega", "omega")
        figures["objects"] = bars(runs)
        blocks["claims"] = tables.claims(runs)
    if "sensitivity" in studies:
        blocks["sensitivity"] = tables.sensitivity(runs)
    if "unreliable" in studies:
        blocks["unreliable"] = tables.points(runs, "unreliable", 10)
    if "house" in studies:
        variants = sorted({key[1] for key in runs if key[0] == "house"}, reverse=True)
        shown = [("house", v, f"Forty objects, psd {v}") for v in variants]
        figures["house"] = frontier(runs, shown, 40)
        blocks["house"] = "\n".join(tables.equal_distance(runs, v) for v in variants)
    save(arguments.out, arguments.document, "maintenance", figures, blocks)


if __name__ == "__main__":
    main()
