"""How singular the displacement of a scene is, r^lambda at an edge, and the order that this leaves to refinement."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np
from scipy.optimize import brentq

from cases.scene import Box, Circle, Material, Orthotropic, Polygon, Rectangle, Ring, Rod, RodFace, Scene
from reference3d.grading import GRADING_EXPONENT

# Poisson's ratio for the singularity at a clamp of what is not isotropic
ORDINARY_RATIO = 0.3
# What quadratic elements reach in energy, and so in forces and deflections, without any singularity; and with edges of
# contact inside elements, where the displacement is r^(3/2)
SMOOTH_ORDER, CONTACT_ORDER = 4.0, 3.0


def formal_order(scene: Scene) -> float:
    """Order with which energy, forces and deflections converge on the meshes of `grading`.

    A singularity r^lambda lets the energy error fall as h^(2 lambda) on even meshes, whatever the order of the elements
    (G. Strang, G. J. Fix, An Analysis of the Finite Element Method, 1973, chapter 8), and as h^(2 q lambda) on those
    graded towards it with exponent q, up to what the elements reach. Singular are the edges of clamps, the ends of a
    rod that presses on another, and re-entrant corners of a section of interior angle omega in torsion and shear,
    where lambda is pi / omega. Meshes of rectangles, circles and rings are graded towards their faces; those of boxes
    and polygons are not.
    """
    orders = [SMOOTH_ORDER]
    for rod in scene.rods:
        across = GRADING_EXPONENT if isinstance(rod.section, Rectangle | Circle | Ring) else 1.0
        orders.append(2.0 * across * clamp_singularity_exponent(_poisson_ratio(rod)))
        orders.append(2.0 * math.pi / max(0.5 * math.pi, _widest_corner(rod)))
    for one, other in _touching(scene):
        across = GRADING_EXPONENT if isinstance(one.section, Rectangle) else 1.0
        orders += [CONTACT_ORDER, 2.0 * across * contact_corner_exponent(_compliance(one) / _compliance(other))]
    return min(orders)


def clamp_singularity_exponent(poisson_ratio: float) -> float:
    """Exponent lambda of the displacement r^lambda at the edge where a free face meets a clamp at 90 degrees.

    Smallest root of (3 - 4 nu) sin^2(lambda pi / 2) = 4 (1 - nu)^2 - lambda^2 (M. L. Williams, Journal of
    Applied Mechanics 19 (1952) 526-528, plane strain); 0.711 for nu = 0.3. It is 1 (no singularity)
    for nu = 0.
    """

    def mismatch(exponent: float) -> float:
        left = (3.0 - 4.0 * poisson_ratio) * math.sin(0.5 * math.pi * exponent) ** 2
        return left + exponent**2 - 4.0 * (1.0 - poisson_ratio) ** 2

    return _root(mismatch, 0.0)


def contact_corner_exponent(ratio: float) -> float:
    """Exponent lambda of the displacement r^lambda where a corner of 90 degrees presses on a flat face, frictionless.

    A wedge of angle omega under p r^(lambda - 1) on one face yields there by p r^lambda / lambda times
    2 (1 - nu^2) / E times (sin 2 lambda omega + lambda sin 2 omega) / (2 sin^2 lambda omega - 2 lambda^2 sin^2 omega)
    (Mellin transform of Airy's function); the two sides must yield by nothing in all (J. Dundurs, M. S. Lee, Journal of
    Elasticity 2 (1972) 109-112). It is 1/2 for a rigid corner, as under a punch, 0.774 for equal materials and 1 (no
    singularity) on a rigid face.

    Parameters
    ----------
    ratio : (1 - nu^2) / E of the corner over that of the face, positive
    """

    def mismatch(exponent: float) -> float:
        turn = math.pi * exponent
        corner = math.sin(turn) / (2.0 * (math.sin(0.5 * turn) ** 2 - exponent**2))
        return math.cos(turn) / math.sin(turn) + ratio * corner

    return _root(mismatch, 0.5)


def _root(mismatch: Callable[[float], float], above: float) -> float:
    """Root between a bound and 1, where there is none 1."""
    least, most = above + 1e-12, 1.0 - 1e-9
    if mismatch(least) * mismatch(most) >= 0.0:
        return 1.0
    return float(brentq(mismatch, least, most, xtol=1e-14))


def _touching(scene: Scene) -> Iterator[tuple[Rod, Rod]]:
    """The rods of all pairs in both orders, as the end of either may press on the other."""
    for pair in scene.contacts:
        if isinstance(pair.second, RodFace):
            first, second = (scene.rod(face.rod) for face in pair.faces)
            yield first, second
            yield second, first


def _poisson_ratio(rod: Rod) -> float:
    return rod.material.poisson_ratio if isinstance(rod.material, Material) else ORDINARY_RATIO


def _compliance(rod: Rod) -> float:
    """(1 - nu^2) / E, mm^2/N."""
    material = rod.material
    young = min(material.young_moduli) if isinstance(material, Orthotropic) else material.young_modulus
    return (1.0 - _poisson_ratio(rod) ** 2) / young


def _widest_corner(rod: Rod) -> float:
    """Largest interior angle at a corner of the rod's section, rad."""
    if isinstance(rod.section, Box):
        return 1.5 * math.pi
    if not isinstance(rod.section, Polygon):
        return 0.5 * math.pi
    widest = 0.0
    for number, loop in enumerate((rod.section.outer, *rod.section.holes)):
        corners = np.array(loop)
        before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
        enclosed = np.sum(corners[:, 0] * np.roll(corners[:, 1], -1) - corners[:, 1] * np.roll(corners[:, 0], -1))
        turned = np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], np.sum(before * after, axis=1))
        inside = np.sign(enclosed) * (1.0 if number == 0 else -1.0)
        widest = max(widest, float((math.pi - inside * turned).max()))
    return widest
