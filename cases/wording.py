"""How messages about case files show names and values."""

from __future__ import annotations

import json
from collections.abc import Iterable
from difflib import get_close_matches


def nearest(word: str, words: Iterable[str]) -> str | None:
    """The word most like the given one; None if none is."""
    near = get_close_matches(word, list(words), n=1, cutoff=0.6)
    return near[0] if near else None


def listed(words: Iterable[str]) -> str:
    """Words in quotation marks, in one line."""
    return ", ".join(f"'{word}'" for word in words) or "none"


def shown(value: object) -> str:
    """A value of a TOML file, on one line and not too long."""
    if isinstance(value, dict):
        return "a table"
    text = json.dumps(value, ensure_ascii=False, default=str).replace("NaN", "nan").replace("Infinity", "inf")
    return text if len(text) <= 60 else text[:57] + "..."


def in_one_line(text: str, longest: int = 500) -> str:
    """A sentence for a terminal: no control characters whatever it quotes, and without its middle if it is too long."""
    text = text if len(text) <= longest else f"{text[: longest // 2]} ... {text[-longest // 2 :]}"
    return "".join(each if each.isprintable() else ascii(each)[1:-1] for each in text)
