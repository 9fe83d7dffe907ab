"""How well names are kept, from the name that each true object is paired with in each frame."""

from __future__ import annotations

import collections

NOBODY = "-1"


def assign(gain: list[list[int]]) -> int:
    """The greatest sum of one entry from each row, no two from one column (Kuhn 1955, Munkres
    1957, with potentials); there are at least as many columns as rows."""
    rows, columns = len(gain), len(gain[0])
    u, v = [0] * (rows + 1), [0] * (columns + 1)
    row_of, way = [0] * (columns + 1), [0] * (columns + 1)
    for i in range(1, rows + 1):
        row_of[0], j0 = i, 0
        least, used = [float("inf")] * (columns + 1), [False] * (columns + 1)
        while row_of[j0]:
            used[j0], i0, delta, j1 = True, row_of[j0], float("inf"), 0
            for j in range(1, columns + 1):
                if used[j]:
                    continue
                reduced = -gain[i0 - 1][j - 1] - u[i0] - v[j]
                if reduced < least[j]:
                    least[j], way[j] = reduced, j0
                if least[j] < delta:
                    delta, j1 = least[j], j
            for j in range(columns + 1):
                if used[j]:
                    u[row_of[j]] += delta
                    v[j] -= delta
                else:
                    least[j] -= delta
            j0 = j1
        while j0:
            row_of[j0], j0 = row_of[way[j0]], way[j0]
    return sum(gain[row_of[j] - 1][j - 1] for j in range(1, columns + 1) if row_of[j])


def scores(frames: list[list[str]], shown: int) -> dict[str, float]:
    """Of one run: frames[k][i] is the name that object i is paired with in frame k; `shown` objects
    were shown, summed over frames. `kept`: the share of frames in which an object has the name that
    it has most often. `switches`: changes to another name. `idf1`: 2 IDTP / (objects + shown),
    with at most one name for each object and the other way round (Ristani et al. 2016)."""
    objects = list(zip(*frames))
    counts = [collections.Counter(n for n in names if n != NOBODY) for names in objects]
    kept = sum(max(c.values(), default=0) for c in counts) / (len(frames) * len(objects))
    switches = 0
    for names in objects:
        named = [n for n in names if n != NOBODY]
        switches += sum(a != b for a, b in zip(named, named[1:]))
    columns = sorted({n for c in counts for n in c})
    gain = [[c[n] for n in columns] + [0] * len(objects) for c in counts]
    idf1 = 2 * assign(gain) / (len(frames) * len(objects) + shown)
    return {"kept": kept, "switches": switches, "idf1": idf1}
