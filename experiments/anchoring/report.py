#!/usr/bin/env python3
"""Figures 2.3 to 2.8 and 2.11 of the thesis as curves, and tables beside its words, from simulations.

Usage: report.py --out DIR [--document FILE.md] [--video NAME FRAMES.jsonl.gz WORLD.jsonl]... RUNS.csv...

Each RUNS.csv is named after its study: boxes-symbols.csv. Writes SVG and tables.md to DIR; with
--document also puts each table into that file, between the lines `<!-- NAME -->` and `<!-- end -->`,
and the figures beside it. A video's plot goes to DIR alone.
"""

from __future__ import annotations

import argparse
import collections
import csv
import gzip
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import tables
from document import save
from plot import Panel, figure


def read(paths: list[pathlib.Path]) -> dict[str, list[tables.Row]]:
    studies = collections.defaultdict(list)
    for path in sorted(paths):
        with open(path, encoding="utf-8", newline="") as file:
            studies[path.name.split("-")[0].removesuffix(".csv")] += csv.DictReader(file)
    return studies


def by_run(rows: list[tables.Row]) -> tables.Runs:
    runs: tables.Runs = {}
    for r in rows:
        runs.setdefault(r["variant"], {}).setdefault(int(r["seed"]), []).append(r)
    return runs


def over_time(runs: dict[int, list[tables.Row]], column: str) -> list[tuple[float, float, float]]:
    """The mean over seeds, without an interval."""
    return [(float(at[0]["time"]), tables.mean([float(r[column]) for r in at]), 0.0)
            for at in zip(*runs.values())]


def panels(runs: tables.Runs, titles: dict[str, str], y_label: str, curves: dict[str, str]) -> str:
    out = []
    for variant, of_seeds in runs.items():
        panel = Panel(titles.get(variant, variant), "time [s]", y_label)
        for name, column in curves.items():
            panel.curve(name, over_time(of_seeds, column))
        out.append(panel)
    return figure(out)


def hidden_figure(rows: list[tables.Row]) -> str:
    points = tables.hidden_points(rows)
    out = []
    for ambiguity in dict.fromkeys(k[1] for k in points):
        panel = Panel(ambiguity, "log10 of the ambiguity's seconds", "P(the truth) at the end")
        for variant, clutter in dict.fromkeys((k[0], k[2]) for k in points):
            panel.curve(f"{variant}, {clutter} false positives", [
                (math.log10(k[3]), tables.mean([float(r["probability"]) for r in at]), 0.0)
                for k, at in points.items() if k[:3] == (variant, ambiguity, clutter)])
        out.append(panel)
    return figure(out)


def video_panel(name: str, frames: str, world: str) -> Panel:
    """Figure 2.11 of a real video: its detections, and what anchor-replay made of them."""
    with gzip.open(frames, "rt", encoding="utf-8") as file:
        detections = [len(json.loads(line)["detections"]) for line in file]
    with open(world, encoding="utf-8") as file:
        beliefs = [json.loads(line) for line in file]
    start = beliefs[0]["utime"]
    times = [(b["utime"] - start) * 1e-6 for b in beliefs]
    panel = Panel(name, "time [s]", "number of ants")
    panel.curve("expected", [(t, b["expected_count"], 0.0) for t, b in zip(times, beliefs)])
    panel.curve("detections", [(t, float(n), 0.0) for t, n in zip(times, detections)])
    return panel


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("runs", nargs="*", type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--document", type=pathlib.Path)
    parser.add_argument("--video", nargs=3, action="append", default=[])
    arguments = parser.parse_args()
    studies = read(arguments.runs)
    figures, blocks = {}, {}
    if studies["boxes"]:
        runs = by_run(studies["boxes"])
        blocks["boxes"] = tables.boxes(runs)
        figures["boxes"] = panels(runs, {}, "objects", {
            "believed in": "shown", "there": "truth", "P(a large green one)": "one_large"})
    if studies["cups"]:
        runs = by_run(studies["cups"])
        blocks["cups"] = tables.cups(runs)
        titles = {"new": "First trial: new cups are likely", "moved": "Second: cups are moved"}
        figures["cups"] = panels(runs, titles, "probability", {
            "the known cup, moved": "moved", "a new cup": "new"})
    if studies["hidden"]:
        blocks["hidden"] = tables.hidden(studies["hidden"])
        figures["hidden"] = hidden_figure(studies["hidden"])
    if studies["ants"]:
        runs = by_run(studies["ants"])
        blocks["ants"] = tables.ants(runs)
        shown = {f"Dish {seed}": {seed: run} for seed, run in list(next(iter(runs.values())).items())[:2]}
        figures["ants"] = panels(shown, {}, "number of ants", {
            "expected": "expected", "detections": "detections", "there": "truth"})
    arguments.out.mkdir(parents=True, exist_ok=True)
    if arguments.video:
        svg = figure([video_panel(*video) for video in arguments.video])
        (arguments.out / "anchoring-videos.svg").write_text(svg, encoding="utf-8")
    save(arguments.out, arguments.document, "anchoring", figures, blocks)


if __name__ == "__main__":
    main()
