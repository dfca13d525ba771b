"""Frozen data as plain JSON values and back, exactly: what a question or a result is kept as on disk.

Every value says what it is, so that reading needs no types and builds nothing but the dataclasses it is told of.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np


def to_plain(value: object) -> Any:  # noqa: ANN401 (JSON)
    """Numbers, text, None, tuples, arrays, mappings and dataclasses, nested at will, as JSON values.

    Raises
    ------
    TypeError
        if there is anything else in it.
    """
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.generic):
        return to_plain(value.item())
    if isinstance(value, tuple):
        return [to_plain(entry) for entry in value]
    if isinstance(value, np.ndarray) and value.dtype.kind in "bif":
        return {"is": "array", "dtype": value.dtype.str, "shape": list(value.shape), "values": value.ravel().tolist()}
    if isinstance(value, Mapping):
        return {"is": "mapping", "items": [[to_plain(key), to_plain(entry)] for key, entry in value.items()]}
    if is_dataclass(value) and not isinstance(value, type):
        content = {field.name: to_plain(getattr(value, field.name)) for field in fields(value)}
        return {"is": type(value).__name__, "fields": content}
    raise TypeError(f"found a {type(value).__name__}, which has no plain form")


def from_plain(plain: Any, kinds: Iterable[type]) -> Any:  # noqa: ANN401 (the value itself says what it is)
    """The value that `to_plain` made plain.

    Parameters
    ----------
    kinds : the dataclasses that may be in it

    Raises
    ------
    KeyError, TypeError, ValueError
        if `to_plain` cannot have made it, or other dataclasses are in it.
    """
    by_name = {kind.__name__: kind for kind in kinds}

    def restored(part: Any) -> Any:  # noqa: ANN401
        if isinstance(part, list):
            return tuple(restored(entry) for entry in part)
        if not isinstance(part, dict):
            return part
        if part["is"] == "array":
            return np.array(part["values"], dtype=part["dtype"]).reshape(part["shape"])
        if part["is"] == "mapping":
            return {restored(key): restored(entry) for key, entry in part["items"]}
        return by_name[part["is"]](**{name: restored(entry) for name, entry in part["fields"].items()})

    return restored(plain)
