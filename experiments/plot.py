"""Small line and bar charts as SVG, with nothing but the standard library."""

from __future__ import annotations

import math
from xml.sax.saxutils import escape

WIDTH, HEIGHT = 320, 230
LEFT, RIGHT, TOP, BOTTOM = 48, 10, 26, 40
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#777777", "#cc79a7", "#e69f00"]


def ticks(low: float, high: float, most: int = 6) -> list[float]:
    """Round numbers from low to high."""
    raw = (high - low) / most
    power = 10 ** math.floor(math.log10(raw))
    step = next(m * power for m in (1, 2, 5, 10) if m * power >= raw)
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, int(high / step + 1e-9) + 1)]


class Panel:
    """One pair of axes. Curves are lists of (x, y, half width of the interval)."""

    def __init__(self, title: str, x_label: str, y_label: str):
        self.title, self.x_label, self.y_label = title, x_label, y_label
        self.curves: list[tuple[str, list[tuple[float, float, float]]]] = []
        self.bars: list[tuple[str, list[float]]] = []

    def curve(self, name: str, points: list[tuple[float, float, float]]) -> None:
        self.curves.append((name, sorted(points)))

    def _range(self) -> tuple[float, float, float, float]:
        if self.bars:
            top = max(max(values) for _, values in self.bars)
            return 0.4, max(len(values) for _, values in self.bars) + 0.6, 0, top * 1.05
        xs = [x for _, points in self.curves for x, _, _ in points]
        ys = [y + s * e for _, points in self.curves for _, y, e in points for s in (-1, 1)]
        low, high = min(ys), max(ys)
        pad = 0.05 * (high - low or 1)
        return min(xs), max(xs), (0 if 0 <= low < 0.3 * high else low - pad), high + pad

    def svg(self, x_at: float, y_at: float) -> list[str]:
        x0, x1, y0, y1 = self._range()
        w, h = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM

        def px(x: float) -> float:
            return LEFT + (x - x0) / (x1 - x0) * w

        def py(y: float) -> float:
            return TOP + h - (y - y0) / (y1 - y0) * h

        out = [f'<g transform="translate({x_at},{y_at})">']
        out.append(f'<text x="{LEFT + w / 2}" y="16" class="t">{escape(self.title)}</text>')
        for x in ticks(x0, x1):
            out.append(f'<path d="M{px(x):.1f} {TOP}v{h}" class="g"/>')
            out.append(f'<text x="{px(x):.1f}" y="{TOP + h + 14}" class="m">{x:g}</text>')
        for y in ticks(y0, y1):
            out.append(f'<path d="M{LEFT} {py(y):.1f}h{w}" class="g"/>')
            out.append(f'<text x="{LEFT - 4}" y="{py(y) + 3:.1f}" class="e">{y:g}</text>')
        out.append(f'<rect x="{LEFT}" y="{TOP}" width="{w}" height="{h}" class="f"/>')
        out.append(f'<text x="{LEFT + w / 2}" y="{HEIGHT - 8}" class="m">{self.x_label}</text>')
        out.append(
            f'<text transform="translate(11,{TOP + h / 2}) rotate(-90)" class="m">'
            f"{escape(self.y_label)}</text>"
        )
        for k, (_, points) in enumerate(self.curves):
            colour = COLOURS[k % len(COLOURS)]
            line = " ".join(f"{px(x):.1f},{py(y):.1f}" for x, y, _ in points)
            out.append(f'<polyline points="{line}" fill="none" stroke="{colour}"/>')
            errors = "".join(
                f"M{px(x):.1f} {py(y - e):.1f}V{py(y + e):.1f}" for x, y, e in points if e > 0
            )
            out.append(f'<path d="{errors}" stroke="{colour}" stroke-width="2.5"/>')
        share = 0.8 / max(1, len(self.bars))
        for k, (_, values) in enumerate(self.bars):
            for i, value in enumerate(values):
                left, right = px(i + 0.6 + k * share), px(i + 0.6 + (k + 1) * share)
                out.append(
                    f'<rect x="{left:.1f}" y="{py(value):.1f}" width="{right - left:.1f}" '
                    f'height="{TOP + h - py(value):.1f}" fill="{COLOURS[k]}"/>'
                )
        out.append("</g>")
        return out

    def names(self) -> list[str]:
        return [name for name, _ in self.curves or self.bars]


def legend(names: list[str], width: float) -> tuple[list[str], float]:
    """The curves' names in rows, and where the rows end."""
    out, x, y = [], float(LEFT), 11.0
    for k, name in enumerate(names):
        needed = 30 + 6 * len(name)
        if x > LEFT and x + needed > width:
            x, y = float(LEFT), y + 14
        colour = COLOURS[k % len(COLOURS)]
        out.append(f'<path d="M{x} {y}h16" stroke="{colour}" stroke-width="3"/>')
        out.append(f'<text x="{x + 20}" y="{y + 4}">{escape(name)}</text>')
        x += needed
    return out, y + 9


def figure(panels: list[Panel]) -> str:
    """Panels side by side under one legend, or each under its own where their curves differ."""
    width = WIDTH * len(panels)
    if all(panel.names() == panels[0].names() for panel in panels):
        names, top = legend(panels[0].names(), width)
    else:
        names, top = [], 0.0
        for k, panel in enumerate(panels):
            own, bottom = legend(panel.names(), WIDTH)
            names += [f'<g transform="translate({k * WIDTH},0)">', *own, "</g>"]
            top = max(top, bottom)
    height = HEIGHT + top + 2
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height:g}" '
        f'width="{width}" font-family="sans-serif" font-size="10">',
        "<style>.t{text-anchor:middle;font-size:12px}.m{text-anchor:middle}.e{text-anchor:end}"
        ".g{stroke:#ddd;stroke-width:.5}.f{fill:none;stroke:#444}</style>",
        f'<rect width="{width}" height="{height:g}" fill="#fff"/>',
        *names,
    ]
    for k, panel in enumerate(panels):
        out += panel.svg(k * WIDTH, top)
    return "\n".join([*out, "</svg>", ""])
