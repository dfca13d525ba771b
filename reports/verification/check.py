"""What a verification check is, and what came of one: a number of a model, step by step, beside a reference.

The steps are the levels of the rod model; of checks of the 3D reference its meshes, or its kinds of contact points.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from reports.comparison import Verdict

Kind = Literal["closed form", "published", "3d converged"]

LEVELS = (1, 2, 3, 4, 5, 6, 7, 8)


@dataclass(frozen=True)
class Steps:
    """What the numbers of a check are made for, one after the other.

    Attributes
    ----------
    title : what they are, in the singular
    name : what one of them is called
    """

    title: str
    name: Callable[[int], str]


BY_LEVEL = Steps("level", "h{}".format)


def elasticity(article: int) -> str:
    """Citation of an article of the textbook most closed forms are from."""
    return f"Timoshenko, Goodier, Theory of Elasticity, 1970, article {article}"


@dataclass(frozen=True)
class Reference:
    """A reference value.

    Attributes
    ----------
    value : in the check's unit
    uncertainty : how far it may be from what the model should give, in the same unit: zero for what is exact, for
        an approximate formula the size of what it leaves out
    """

    value: float
    uncertainty: float = 0.0


@dataclass(frozen=True)
class Check:
    """One number of a model held against a reference, level by level of the rod model or by other steps.

    Attributes
    ----------
    shows : in one sentence, what the check shows
    kind : 'closed form' is computed here from its formula; 'published' and '3d converged' are numbers made elsewhere,
        or 3D of this run
    source : citation
    unit : of value and reference; empty where they have none
    reference : makes the reference value
    value : the number at a level
    levels : levels, or other steps, tried
    tolerance : largest relative error allowed at level `at_level`
    published : a well-known published value that is less right than the reference, for comparison
    steps : what the levels are where they are not those of the rod model; the same for all checks of a group
    """

    name: str
    shows: str
    kind: Kind
    source: str
    unit: str
    reference: Callable[[], Reference]
    value: Callable[[int], float]
    tolerance: float
    at_level: int
    levels: tuple[int, ...] = LEVELS
    published: float | None = None
    steps: Steps = BY_LEVEL


@dataclass(frozen=True)
class Outcome:
    """A check carried out.

    Attributes
    ----------
    values : one for each of the check's levels
    kept_since : the day they were computed on, YYYY-MM-DD, if they come from the cache; else ''
    """

    check: Check
    reference: Reference
    values: tuple[float, ...]
    kept_since: str = ""

    @property
    def errors(self) -> tuple[float, ...]:
        """Relative errors with their sign, one for each level."""
        return tuple(value / self.reference.value - 1.0 for value in self.values)

    @property
    def error(self) -> float:
        """The relative error at the level where the tolerance must be met."""
        return self.errors[self.check.levels.index(self.check.at_level)]

    @property
    def relative_uncertainty(self) -> float:
        """Uncertainty of the reference, relative to it."""
        return self.reference.uncertainty / abs(self.reference.value)

    @property
    def verdict(self) -> Verdict:
        """'not resolved' where the reference is less certain than the tolerance asks."""
        if self.relative_uncertainty > self.check.tolerance:
            return "not resolved"
        return "pass" if abs(self.error) <= self.check.tolerance else "fail"


@dataclass(frozen=True)
class Group:
    """Checks of one subject.

    Attributes
    ----------
    text : what they have in common, in a sentence or two
    """

    title: str
    text: str
    checks: tuple[Check, ...]

    @property
    def steps(self) -> Steps:
        """What its checks are made for, one after the other."""
        return self.checks[0].steps
