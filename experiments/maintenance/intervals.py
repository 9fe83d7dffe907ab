"""Means with 95 % intervals over runs, and curves compared at equal distance."""

from __future__ import annotations

import math

Key = tuple[str, str, str, float]  # study, variant, strategy, value
Runs = dict[Key, list[dict[str, str]]]

# Student's t, 97.5 %, by degrees of freedom; between them the smaller one's (the wider interval).
STUDENT = {1: 12.71, 2: 4.30, 3: 3.18, 5: 2.57, 10: 2.23, 20: 2.09, 30: 2.04, 60: 2.00, 120: 1.98}


def interval(values: list[float]) -> tuple[float, float]:
    """Mean and half width of its 95 % interval; half width 0 of a single value."""
    n = len(values)
    mean = sum(values) / n
    if n < 2:
        return mean, 0.0
    variance = sum((v - mean) ** 2 for v in values) / (n - 1)
    t = STUDENT[max(k for k in STUDENT if k <= n - 1)]
    return mean, t * math.sqrt(variance / n)


def paired(a: list[dict[str, str]], b: list[dict[str, str]], column: str) -> tuple[float, float]:
    """a - b, run by run, as far as both have runs."""
    return interval([float(x[column]) - float(y[column]) for x, y in zip(a, b)])


def show(value: tuple[float, float], digits: int = 2) -> str:
    return f"{value[0]:.{digits}f} ± {value[1]:.{digits}f}"


def at_distance(points: list[tuple[float, float]], distance: float) -> float | None:
    """y of a curve of (distance, y) by straight lines; None outside of it."""
    points = sorted(points)
    for (d0, y0), (d1, y1) in zip(points, points[1:]):
        if d0 <= distance <= d1:
            return y0 if d1 == d0 else y0 + (distance - d0) / (d1 - d0) * (y1 - y0)
    return None
