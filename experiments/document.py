"""Puts tables into the documents that tell of them."""

from __future__ import annotations

import pathlib
import re


def put(document: pathlib.Path, blocks: dict[str, str]) -> None:
    """Each block between the lines `<!-- NAME -->` and `<!-- end -->`."""
    text = document.read_text(encoding="utf-8")
    for name, block in blocks.items():
        pattern = re.compile(rf"(<!-- {re.escape(name)} -->\n).*?(<!-- end -->)", re.S)
        text = pattern.sub(lambda m, b=block: m[1] + "\n" + b + "\n" + m[2], text)
    document.write_text(text, encoding="utf-8")


def save(out: pathlib.Path, document: pathlib.Path | None, prefix: str, figures: dict[str, str],
         blocks: dict[str, str]) -> None:
    """Figures (SVG, as PREFIX-NAME.svg) and tables into `out`, and into and beside the document if
    there is one; the tables also to standard output."""
    out.mkdir(parents=True, exist_ok=True)
    places = [out]
    if document:
        put(document, blocks)
        places.append(document.parent)
    for place in places:
        for name, svg in figures.items():
            (place / f"{prefix}-{name}.svg").write_text(svg, encoding="utf-8")
    text = "".join(f"## {name}\n\n{block}\n" for name, block in blocks.items())
    (out / "tables.md").write_text(text, encoding="utf-8")
    print(text, end="")
