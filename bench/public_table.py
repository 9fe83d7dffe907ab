"""A Markdown table of what was reached on one set of recordings, beside what others reached.

    public_table.py SET PEERS.csv FOLDER

FOLDER holds score.jsonl and best_world.jsonl (a line per class: the score of what has p >= 0.5, and
of all of the best world) and *.stats.json, as bench/public.sh leaves them.
"""

from __future__ import annotations

import csv
import json
import pathlib
import sys

COLUMNS = ["HOTA", "DetA", "AssA", "MOTA", "IDF1", "IDSW", "FP", "FN", "GOSPA"]
DIGITS = {"IDSW": 0, "FP": 0, "FN": 0, "GOSPA": 2}


def row(who: str, about: str, score: dict[str, float | str], source: str) -> list[str]:
    cells = []
    for column in COLUMNS:
        value = score.get(column, "")
        cells.append(f"{float(value):.{DIGITS.get(column, 1)}f}" if value != "" else "")
    return [who, about, *cells, source]


def read_lines(path: pathlib.Path) -> list[dict]:
    return [json.loads(line) for line in path.read_text().splitlines()]


def work(folder: pathlib.Path) -> str:
    """Frames, and the time of an update over all sequences."""
    stats = [json.loads(path.read_text()) for path in sorted(folder.glob("*.stats.json"))]
    frames = sum(s["frames"] for s in stats)
    mean = sum(s["frames"] * s["update_ms"]["mean"] for s in stats) / frames
    medians = sorted(s["update_ms"]["median"] for s in stats)
    return (
        f"{len(stats)} sequences, {frames} frames; update: mean {mean:.3f} ms, "
        f"median {medians[len(medians) // 2]:.3f} ms"
    )


def main() -> None:
    name, peers_path, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    with open(peers_path, newline="") as f:
        peers = [p for p in csv.DictReader(f) if name in p["sets"].split()]
    rows = []
    pairs = zip(read_lines(folder / "score.jsonl"), read_lines(folder / "best_world.jsonl"))
    for score, best in pairs:
        about = score["class"]
        rows.append(row("**anchord**", about, score, ""))
        rows.append(row("**anchord**, all of the best world", about, best, ""))
        rows += [row(p["who"], about, p, p["source"]) for p in peers if p["class"] == about]
    print(f"\n### {name}\n\n{work(folder)}\n")
    print("| | class | " + " | ".join(COLUMNS) + " | source |")
    print("| --- | --- | " + "---: | " * len(COLUMNS) + "--- |")
    for cells in rows:
        print("| " + " | ".join(cells) + " |")


main()
