"""From the energy that fields of each degree hold to what all further levels would add.

Corners of clamps and edges of contact make the error of level k fall like k^-2 or a little faster: a clamp's corner is
singular like r^(0.71 - 1), the end of a stretch in contact like r^(0.5 - 1), and the p-version's energy error falls
with twice twice that exponent (I. Babuska, M. Suri, SIAM Review 36 (1994) 578-632). Away from them, fields of bending,
shear and torsion are all but polynomials over a solid section, and levels fall off fast; walls fall off slowly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# By how many degrees levels rise: odd and even ones alone carry different fields.
PAIR = 2
# Degrees share energy with their neighbours, the lower ones most, so that it falls faster than the error does: of what
# the power is above 1 this part is believed. On box girders that is what levels 4 to 10 show.
BELIEVED = 0.5
# The powers of k tried where two pairs of degrees tell it.
POWERS = np.linspace(0.5, 8.0, 151)


@dataclass(frozen=True, eq=False)
class Share:
    """What alike elements of one level hold in their highest fields.

    Attributes
    ----------
    level : k, even
    by_degree : energy in the fields of each degree, any unit, shape (k + 1,)
    near : whether they are near corners
    usual : power of k by which the error falls where level 4 alone cannot tell it
    least, most : limits of what higher levels tell
    """

    level: int
    by_degree: Array
    near: bool
    usual: float
    least: float
    most: float

    @property
    def power(self) -> float:
        """The power of k by which the error falls."""
        last, before = self._pair(self.level), self._pair(self.level - PAIR)
        if self.level < 3 * PAIR or before == 0.0:
            return self.usual
        fitted = fitted_power(self.level, last / before)
        return float(np.clip(1.0 + BELIEVED * (fitted - 1.0), self.least, self.most))

    def left_at(self, level: int) -> float:
        """Energy in all fields above a level, the own one or a higher."""
        if self.level <= PAIR:
            return 0.0
        power = self.power
        at_own = self._pair(self.level) / ((self.level / (self.level - PAIR)) ** power - 1.0)
        return float(at_own * (self.level / level) ** power)

    def _pair(self, level: int) -> float:
        return float(self.by_degree[level - PAIR + 1 : level + 1].sum())


def fitted_power(level: int, ratio: float) -> float:
    """The power a for which an error k^-a falls at two steps of `PAIR` up to a level by differences of this ratio."""
    third, second, first = (np.power(float(level - back * PAIR), -POWERS) for back in (0, 1, 2))
    return float(np.interp(-ratio, -(second - third) / (first - second), POWERS))
