"""What a sweep is: one thing driven through its range, methods compared on the way, and a claim made from the data."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Method:
    """A method that is compared.

    Attributes
    ----------
    ours : whether it is this project's, or the plain alternative
    """

    name: str
    ours: bool = True


@dataclass(frozen=True)
class Curve:
    """Numbers of one method, nan where it gave none."""

    x: tuple[float, ...]
    y: tuple[float, ...]

    def at(self, x: float) -> float:
        """Number at the given x nearest to this."""
        return self.y[min(range(len(self.x)), key=lambda index: abs(self.x[index] - x))]

    @property
    def largest(self) -> float:
        """Largest number that there is."""
        return max(self.sizes)

    @property
    def sizes(self) -> list[float]:
        """Sizes of the numbers that there are."""
        return [abs(value) for value in self.y if not math.isnan(value)]


Found = Mapping[str, Mapping[str, Curve]]
"""What was measured: by the key of the picture, then by the method's name."""


@dataclass(frozen=True)
class Picture:
    """How one measured quantity is drawn.

    Attributes
    ----------
    key : of the quantity in what was measured
    x, y : titles of the axes
    ticks : names of 1, 2, ... along x, where these are kinds and not numbers
    """

    key: str
    title: str
    x: str
    y: str
    log_x: bool = True
    log_y: bool = True
    ticks: tuple[str, ...] = ()


@dataclass(frozen=True)
class Sweep:
    """One thing driven through its range.

    Attributes
    ----------
    name : of the sweep
    driven : what is driven, on which problem, in a sentence or two
    values : that it takes
    methods : compared
    pictures : of what was measured
    measure : the numbers for given values
    claim : what is seen, in a sentence made from the numbers
    own_limit : where our own code fails or degrades, and what tells so; made from the numbers
    holds : whether the numbers bear the claim out
    """

    name: str
    driven: str
    values: tuple[float, ...]
    methods: tuple[Method, ...]
    pictures: tuple[Picture, ...]
    measure: Callable[[tuple[float, ...]], Found]
    claim: Callable[[Found], str]
    own_limit: Callable[[Found], str]
    holds: Callable[[Found], bool]

    def is_ours(self, method: str) -> bool:
        """Whether a method is this project's."""
        return next(each.ours for each in self.methods if each.name == method)


def curve(x: Iterable[float], y: Iterable[float]) -> Curve:
    """A curve of plain floats, which can pass from process to process and into JSON."""
    return Curve(tuple(float(value) for value in x), tuple(float(value) for value in y))
