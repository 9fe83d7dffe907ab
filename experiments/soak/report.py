"""The table and the plot of a soak, from samples.csv and summary.json."""

from __future__ import annotations

import argparse
import csv
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from plot import Panel, figure  # noqa: E402

WARM_UP_S = 600  # before memory must be flat; a third of a run that is shorter than half an hour

Row = dict[str, float]


def read(file: pathlib.Path) -> list[Row]:
    with open(file, encoding="utf-8") as lines:
        return [{k: float(x) for k, x in row.items() if x not in ("", "nan")}
                for row in csv.DictReader(lines)]


def slope(points: list[tuple[float, float]]) -> tuple[float, float]:
    """Least squares: units per hour of points (s, unit), and the standard error of that, as if the
    residuals were independent. NaN of fewer than three."""
    n = len(points)
    if n < 3:
        return math.nan, math.nan
    mx, my = sum(x for x, _ in points) / n, sum(y for _, y in points) / n
    sxx = sum((x - mx) ** 2 for x, _ in points)
    b = sum((x - mx) * (y - my) for x, y in points) / sxx
    residual = sum((y - my - b * (x - mx)) ** 2 for x, y in points)
    return 3600 * b, 3600 * math.sqrt(residual / (n - 2) / sxx)


def warm(rows: list[Row]) -> float:
    """s from the start after which memory counts."""
    return min(WARM_UP_S, rows[-1]["elapsed_s"] / 3)


def memory(rows: list[Row], column: str, pid: str = "") -> list[tuple[float, float]]:
    """(s, MB) after the warm-up; with `pid`, of the process that is there at the end."""
    last = next((r[pid] for r in reversed(rows) if pid in r), None) if pid else None
    return [(r["elapsed_s"], r[column]) for r in rows
            if column in r and r["elapsed_s"] >= warm(rows) and (not pid or r.get(pid) == last)]


def memory_line(name: str, points: list[tuple[float, float]]) -> str:
    if not points:
        return f"| {name} | - |"
    b, error = slope(points)
    return (f"| {name} | {points[0][1]:.1f} to {points[-1][1]:.1f} MB, {b:+.2f} ± {error:.2f} MB/h "
            f"over {(points[-1][0] - points[0][0]) / 60:.0f} min |")


def table(rows: list[Row], summary: dict) -> str:
    out = ["| | |", "| --- | --- |"]
    for name, value in summary["lines"]:
        out.append(f"| {name} | {value} |")
    out.append(memory_line("memory of the daemon that is never restarted (RSS)",
                           memory(rows, "steady_rss_mb")))
    out.append(memory_line("of its `anchord-lcm`",
                           memory(rows, "steady_lcm_rss_mb", "steady_lcm_pid")))
    shaken = [r["shaken_rss_mb"] for r in rows if "shaken_rss_mb" in r]
    if shaken:
        out.append(f"| memory of the daemon that is restarted | at most {max(shaken):.1f} MB |")
    for who in ("steady", "shaken"):
        for column, unit in (("fds", "open files"), ("threads", "threads"), ("wal_mb", "MB WAL")):
            values = [r[f"{who}_{column}"] for r in rows if f"{who}_{column}" in r]
            if values:
                out.append(f"| {who}: {unit} | {min(values):g} to {max(values):g} |")
    return "\n".join(out) + "\n"


def minutes(rows: list[Row], column: str) -> list[tuple[float, float, float]]:
    return [(r["elapsed_s"] / 60, r[column], 0.0) for r in rows if column in r]


def plot(rows: list[Row]) -> str:
    panels = []
    for title, unit, curves in (
        ("Memory", "RSS [MB]", [("daemon", "steady_rss_mb"), ("its anchord-lcm",
                                                              "steady_lcm_rss_mb"),
                                ("restarted daemon", "shaken_rss_mb")]),
        ("Answers to questions", "[ms]", [("median", "question_p50_ms"),
                                          ("99 %", "question_p99_ms")]),
        ("Durable acknowledgements", "[ms]", [("median", "ack_p50_ms"), ("99 %", "ack_p99_ms")]),
    ):
        panel = Panel(title, "time [min]", unit)
        for name, column in curves:
            points = minutes(rows, column)
            if len(points) > 1:
                panel.curve(name, points)
        if panel.curves:
            panels.append(panel)
    return figure(panels)


def write(out: pathlib.Path) -> str:
    """soak.svg and table.md into the folder of a run; the table."""
    rows = read(out / "samples.csv")
    text = table(rows, json.loads((out / "summary.json").read_text(encoding="utf-8")))
    (out / "table.md").write_text(text, encoding="utf-8")
    (out / "soak.svg").write_text(plot(rows), encoding="utf-8")
    return text


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path, help="folder of a run")
    print(write(parser.parse_args().out), end="")


if __name__ == "__main__":
    main()
