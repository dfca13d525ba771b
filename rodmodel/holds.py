"""What supports and joints leave free at the nodes of a rod, and where they take the rest.

On a held node the displacement is

    psi = (free combinations of the fields) q + given + motions^T (motion of the joint)

and only q is carried by the rod's chain.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import ENDS, Clamp, Joint, Rod, Scene, Support, station_of
from rodmodel.centre_line import centre_points, frames
from rodmodel.resultants import even_traction, linear_traction, rigid_motions
from rodmodel.section import Fields, U, V, W

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
# Fields that are free, by their indices, or orthonormal combinations of them, the columns of a matrix.
Free = IntArray | Array

_COMPONENTS = {"x": U, "y": V, "s": W}
# A field that takes part in each component of the mean motion; symmetry leaves out all such fields or none.
_LEADING = {
    "x": (U, 0, 0),
    "y": (V, 0, 0),
    "s": (W, 0, 0),
    "turn x": (W, 0, 1),
    "turn y": (W, 1, 0),
    "turn s": (U, 0, 1),
}


@dataclass(frozen=True, eq=False)
class Hold:
    """How one node is held.

    Attributes
    ----------
    free : of its fields
    given : coefficients of all fields that the support prescribes, shape (n_fields,)
    motions : unit motions along and about global X, Y, Z of the joint that the node takes part in, or the free motions
        that it follows, as the section's fields, shape (n_motions, n_fields); no rows elsewhere
    """

    free: Free
    given: Array
    motions: Array


@dataclass(frozen=True)
class Held:
    """A section that is held.

    Attributes
    ----------
    by : its support, the joint that it takes part in, or the free motions of a loose rod that it follows
    """

    station: float
    by: Clamp | Support | Joint | FreeMotions


@dataclass(frozen=True, eq=False)
class FreeMotions:
    """Rigid motions that nothing but contact resists.

    Attributes
    ----------
    centre : point that the motions displace, mm, shape (3,)
    motions : displacement of the centre and rotation, rows, shape (n_motions, 6)
    """

    centre: Array
    motions: Array

    def at(self, point: Array) -> Array:
        """Displacement of a point (mm, shape (3,)) and rotation in each motion, shape (n_motions, 6)."""
        turned = np.cross(self.motions[:, 3:], point - self.centre)
        return np.concatenate([self.motions[:, :3] + turned, self.motions[:, 3:]], axis=1)


def held_sections(scene: Scene, rod: Rod) -> tuple[Held, ...]:
    """All sections of a rod that supports and joints hold."""
    supports = [Held(station_of(support, rod), support) for support in scene.supports if support.rod == rod.name]
    joined = [(joint, end.end) for joint in scene.joints for end in joint.ends if end.rod == rod.name]
    return (*supports, *(Held(0.0 if end == "start" else rod.length, joint) for joint, end in joined))


def hold(scene: Scene, rod: Rod, held: Held, fields: Fields) -> Hold:
    """How the node at a held section, carrying `fields`, is held."""
    none, all_held, at_rest = np.empty((0, fields.count)), np.empty(0, dtype=np.int64), np.zeros(fields.count)
    match held.by:
        case Clamp():
            motion = np.concatenate([held.by.displacement, held.by.rotation])
            given = motion @ _global_motions(rod, held.station, fields) if motion.any() else at_rest
            return Hold(all_held, given, none)
        case Joint():
            motions = _global_motions(rod, held.station, fields)
            # Turned about the joint's point, a centre beside it (by round-off of what was written) moves along.
            arm = centre_points(rod.centre_line, np.array([held.station]))[:, 0] - joint_point(scene, held.by)
            motions[3:] += np.cross(np.eye(3), arm) @ motions[:3]
            return Hold(all_held, at_rest, motions)
        case FreeMotions():
            # The section's mean follows the motions; it is held as far as they go, and free to deform.
            point = centre_points(rod.centre_line, np.array([held.station]))[:, 0]
            motions = held.by.at(point) @ _global_motions(rod, held.station, fields)
            axes = frames(rod.centre_line, np.array([held.station]))[0]
            means = np.concatenate([axes.T @ even_traction(fields), axes.T @ linear_traction(rod.section, fields)])
            return Hold(_complement(held.by.at(point) @ means), at_rest, motions)
        case Support(of="section"):
            return Hold(*_component_hold(held.by, fields), none)
        case Support():
            return Hold(*_mean_hold(rod, held.by, fields), none)


def _global_motions(rod: Rod, station: float, fields: Fields) -> Array:
    """Unit rigid motions of a section along, then about global X, Y, Z, as its fields, shape (6, n_fields)."""
    axes = frames(rod.centre_line, np.array([station]))[0]
    local = rigid_motions(rod.section, fields)
    return np.concatenate([axes.T @ local[:3], axes.T @ local[3:]])


def joint_point(scene: Scene, joint: Joint) -> Array:
    """Where a joint is, mm, shape (3,)."""
    first = joint.ends[0]
    line = scene.rod(first.rod).centre_line
    return np.asarray(line.end_points[ENDS.index(first.end)])


def _component_hold(support: Support, fields: Fields) -> tuple[Free, Array]:
    """All fields of the components are held; a prescribed displacement is even over the section."""
    components = [_COMPONENTS[component] for component in support.components]
    given = np.zeros(fields.count)
    for component, displacement in zip(components, support.displacement, strict=False):
        constant = fields.index(component, 0, 0)
        if constant is not None:
            given[constant] = displacement
    return np.flatnonzero(~np.isin(fields.table[0], components)), given


def _mean_hold(rod: Rod, support: Support, fields: Fields) -> tuple[Free, Array]:
    """Mean displacements are single fields, mean rotations combinations of several."""
    wanted = dict(zip(support.components, support.displacement or np.zeros(len(support.components)), strict=True))
    # What symmetry leaves out is held by it.
    held = [component for component in wanted if fields.index(*_LEADING[component]) is not None]
    means = np.concatenate([even_traction(fields), linear_traction(rod.section, fields)])
    rows = means[[list(_LEADING).index(component) for component in held]]
    given = np.linalg.pinv(rows) @ np.array([wanted[component] for component in held])
    if not any(component.startswith("turn") for component in held):
        return np.flatnonzero(~rows.any(axis=0)), given
    return _complement(rows), given


def _complement(rows: Array) -> Array:
    """Orthonormal combinations of fields, columns, on which linearly independent rows vanish."""
    basis = np.linalg.qr(rows.T, mode="complete").Q
    return np.ascontiguousarray(basis[:, len(rows) :])


def restricted(values: Array, free: Free) -> Array:
    """Rows of `values` (one a field, shape (n_fields, ...)) on what is free: T^T values."""
    if free.dtype.kind == "f":
        return np.asarray(free.T @ values)
    return values if len(free) == len(values) else np.asarray(values[free])


def extended(carried: Array, free: Free, count: int) -> Array:
    """Fields from what is carried, shape (n_free, m) to (count, m): T carried."""
    if free.dtype.kind == "f":
        return np.asarray(free @ carried)
    result = np.zeros((count, carried.shape[1]))
    result[free] = carried
    return result


def within(free: Free, places: IntArray, count: int) -> Free:
    """The same combinations among `count` fields of a higher level, in which the node's fields stand at `places`."""
    if free.dtype.kind != "f":
        return np.asarray(places[free])
    result = np.zeros((count, free.shape[1]))
    result[places] = free
    return result
