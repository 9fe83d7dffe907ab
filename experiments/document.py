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
