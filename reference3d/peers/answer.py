"""What a peer says of a scene: the few quantities that every solver can tell."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PeerAnswer:
    """A scene solved by a peer, for the full section also where a symmetry plane was used.

    Attributes
    ----------
    solver : name and version
    outcome : 'converged', or why not
    unknowns : of the peer's own system
    seconds : wall-clock time of the peer's run, its reading and writing included
    peak_memory : largest resident memory of the peer's process, MB
    contact_force : by pair, on the second rod or ground, global components, N, shape (3,)
    contact_centre : by pair, the point in which it acts, global, mm, shape (3,); nan without contact
    displacement : by rod, of the centre line at the stations that were asked for, global components, mm, shape (3, n)
    reactions : by rod and arc length of a clamp (mm), what it exerts on the rod: force (N) and moment about the
        section's centre (N mm), global, shape (6,)
    """

    solver: str
    outcome: str
    unknowns: int
    seconds: float
    peak_memory: float
    contact_force: Mapping[str, Array]
    contact_centre: Mapping[str, Array]
    displacement: Mapping[str, Array]
    reactions: Mapping[tuple[str, float], Array]


class NotInstalled(Exception):
    """A peer is absent; the message names it and how to install it."""
