"""Limits of a case as people write them."""

from __future__ import annotations

import re

from reports.nightly.task import Limits

BYTES = {"MB": 1e6, "GB": 1e9, "TB": 1e12, "MiB": 2.0**20, "GiB": 2.0**30, "TiB": 2.0**40}
SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0}
AMOUNT = re.compile(r"(\d+(?:\.\d+)?) ?([A-Za-z]+)")


class LimitError(Exception):
    """A limit that cannot be used; the message is one sentence."""


def limits(memory: str | None, time: str) -> Limits:
    """The limits that texts state: 4GB, 20 min.

    Parameters
    ----------
    memory : None for an equal part of the machine's

    Raises
    ------
    LimitError
        if one is not a number above zero with a unit.
    """
    bytes_ = None if memory is None else _amount("--memory-limit", memory, BYTES, "4GB")
    return Limits(bytes_, _amount("--time-limit", time, SECONDS, "20min"))


def _amount(option: str, text: str, units: dict[str, float], example: str) -> float:
    found = AMOUNT.fullmatch(text.strip())
    if found is None or found[2] not in units or float(found[1]) == 0.0:
        raise LimitError(f"{option}: found {text!r}; give a number above zero with {', '.join(units)}, as in {example}")
    return float(found[1]) * units[found[2]]
