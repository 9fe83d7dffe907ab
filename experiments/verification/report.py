#!/usr/bin/env python3
"""Makes the table and the figures of experiments/verification from what verification_follow wrote.

Usage: report.py OUT RUN.csv [RUN.csv ...] [--person N]

Each RUN.csv is named after its threshold (nat): follow-1.csv. Writes OUT/table.md, and of one person
OUT/when.svg (after thesis figure 3.9: when the position was verified) and OUT/entropy.svg (after
figure 3.10). Errors are told where the runs hold true positions. Standard library only.
"""
import argparse, collections, csv, math, pathlib, re

FAR = 1.0  # m: an estimate that is farther off than this ...
FOR = 7  # ... for so many frames in a row is of somebody else, or of nobody
WIDTH, LEFT = 760, 60


def read(path):
    people = collections.defaultdict(list)
    with open(path, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            name, outcome = int(row.pop("person")), row.pop("outcome")
            step = {k: float(v) if v else None for k, v in row.items()}
            people[name].append(step | {"outcome": outcome})
    return people


def error(step):
    if step["true_x"] is None:
        return None
    return math.hypot(step["x"] - step["true_x"], step["y"] - step["true_y"])


def until_lost(steps):
    """The steps up to where the person was lost, and how: None, `missing` or `another`."""
    far = 0
    for i, step in enumerate(steps):
        e = error(step)
        far = far + 1 if e is not None and e > FAR else 0
        if far == FOR:
            return steps[: i + 1 - FOR], "another"
    absent = 0
    for step in steps:
        if step["looked"]:
            absent = absent + 1 if step["outcome"] == "absent" else 0
    return steps, "missing" if absent >= 3 and steps[-1]["outcome"] == "absent" else None


def row(threshold, people, fps):
    kept, lost = [], collections.Counter()
    for steps in people.values():
        good, how = until_lost(steps)
        kept += good
        lost[how] += 1
    looks = [s for s in kept if s["looked"]]
    errors = sorted(e for e in map(error, kept) if e is not None)
    read_px = sum(s["looked_at"] for s in looks)
    rms = math.sqrt(sum(e * e for e in errors) / len(errors)) if errors else None
    cells = [
        f"{threshold:g}", f"{len(people)}", f"{len(kept) / fps:.0f}",
        f"{fps * len(looks) / len(kept):.2f}", f"{100 * read_px / len(looks):.2f}",
        f"{100 * read_px / len(kept):.2f}",
        f"{sum(s['entropy_after'] for s in kept) / len(kept):.2f}",
        f"{rms:.2f}" if errors else "-",
        f"{errors[int(0.95 * len(errors))]:.2f}" if errors else "-",
        f"{lost['missing']}", f"{lost['another']}" if errors else "-",
        f"{sum(s['look_ms'] for s in looks) / len(looks):.1f}",
    ]
    return "| " + " | ".join(cells) + " |"


def table(runs, fps):
    titles = ("threshold, nat", "people", "followed, s", "looks per s", "of the picture per look, %",
              "per frame, %", "mean entropy, nat", "RMS error, m", "95 % of errors, m",
              "given up as missing", "gone over to another", "ms per look")
    lines = ["| " + " | ".join(titles) + " |", "|" + " ---: |" * len(titles)]
    return "\n".join(lines + [row(t, people, fps) for t, people in runs]) + "\n"


def x_axis(first, last, bottom, scale):
    marks = []
    step = max(1, round((last - first) / 10))
    for t in range(math.ceil(first), math.floor(last) + 1, step):
        x = LEFT + (t - first) * scale
        marks.append(f'<path d="M{x:.1f} {bottom}v5" stroke="black"/>'
                     f'<text x="{x:.1f}" y="{bottom + 18}" text-anchor="middle">{t}</text>')
    middle = LEFT + (last - first) * scale / 2
    marks.append(f'<text x="{middle:.0f}" y="{bottom + 36}" text-anchor="middle">Time [s]</text>')
    return "".join(marks)


def svg(height, content):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" '
            f'font-family="sans-serif" font-size="12">'
            f'<rect width="{WIDTH}" height="{height}" fill="white"/>{content}</svg>\n')


def when(runs, person):
    """A row of bars for each threshold: at which times somebody looked, and found (black) or not."""
    runs = [(t, people[person]) for t, people in runs if person in people]
    first, last = runs[0][1][0]["time"], max(steps[-1]["time"] for _, steps in runs)
    scale, bottom, content = (WIDTH - LEFT - 20) / (last - first), 20 + 26 * len(runs), []
    for i, (threshold, steps) in enumerate(runs):
        y = 14 + 26 * i
        content.append(f'<text x="{LEFT - 8}" y="{y + 14}" text-anchor="end">{threshold:g} nat</text>')
        for s in steps:
            if s["looked"]:
                color = "black" if s["outcome"] == "found" else "#d62728"
                x = LEFT + (s["time"] - first) * scale
                content.append(f'<path d="M{x:.1f} {y}v18" stroke="{color}"/>')
    content.append(f'<path d="M{LEFT} {bottom}H{WIDTH - 20}" stroke="black"/>')
    return svg(bottom + 45, "".join(content) + x_axis(first, last, bottom, scale))


def entropy(threshold, steps, seconds=15):
    """The position's entropy over the first seconds: it rises by prediction and falls by looks."""
    steps = [s for s in steps if s["time"] <= steps[0]["time"] + seconds]
    points = [(s["time"], s[k]) for s in steps for k in ("entropy_before", "entropy_after")]
    first, last = points[0][0], points[-1][0]
    low, high = math.floor(min(h for _, h in points)), math.ceil(max(h for _, h in points))
    scale, bottom = (WIDTH - LEFT - 20) / (last - first), 230
    y = lambda h: 15 + (high - h) * (bottom - 15) / (high - low)
    line = " ".join(f"{LEFT + (t - first) * scale:.1f},{y(h):.1f}" for t, h in points)
    content = [f'<polyline points="{line}" fill="none" stroke="#1f77b4" stroke-width="1.5"/>',
               f'<path d="M{LEFT} 15V{bottom}H{WIDTH - 20}" fill="none" stroke="black"/>',
               f'<text x="18" y="125" transform="rotate(-90 18 125)" text-anchor="middle">'
               f"Entropy [nat], looks above {threshold:g} nat</text>"]
    for h in range(low, high + 1):
        content.append(f'<text x="{LEFT - 8}" y="{y(h) + 4:.1f}" text-anchor="end">{h}</text>')
    return svg(bottom + 45, "".join(content) + x_axis(first, last, bottom, scale))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("runs", nargs="+", type=pathlib.Path)
    parser.add_argument("--person", type=int, help="of the figures; default: the first")
    parser.add_argument("--fps", type=float, default=7)
    parser.add_argument("--figure-threshold", type=float, default=1)
    args = parser.parse_args()
    numbered = [(float(re.search(r"-([\d.]+)\.csv$", p.name)[1]), p) for p in args.runs]
    runs = [(threshold, read(p)) for threshold, p in sorted(numbered)]
    person = args.person or min(runs[0][1])
    text = table(runs, args.fps)
    (args.out / "table.md").write_text(text, encoding="utf-8")
    (args.out / "when.svg").write_text(when(runs, person), encoding="utf-8")
    shown = min(runs, key=lambda run: abs(run[0] - args.figure_threshold))
    (args.out / "entropy.svg").write_text(entropy(shown[0], shown[1][person]), encoding="utf-8")
    print(text, end="")


if __name__ == "__main__":
    main()
