"""Poisson's ratio towards 0.5: volumetric locking of rod levels and of 3D elements."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import rodmodel
from cases.scene import Clamp, Material, Rectangle, Rod, Scene
from reports.stability import plain_rods
from reports.stability.solids import Solid, face_weights, solid, solved
from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.wording import share
from reports.verification.bending import cowper_coefficient
from reports.verification.scenes import ROD, borders, end_force, straight
from rodmodel.section import Fields

YOUNG, SIDE = 1000.0, 10.0
SECTION = Rectangle(SIDE, SIDE)
SLENDERNESS, ORDER = 4.0, 6
RATIOS = (0.3, 0.45, 0.49, 0.499, 0.4999)
LEVELS = (1, 2, 4, 6)

FULL = Method("h1 with the full law", ours=False)
RODS = tuple(Method(f"h{level}, p = {ORDER}") for level in LEVELS)
PLAIN = Method("8-node hexahedra", ours=False)
QUADRATIC = Method("27-node hexahedra", ours=False)


def measure(values: tuple[float, ...]) -> Found:
    """Deflection of a short cantilever over Timoshenko's, and stiffness of a bonded cube over that of the finest."""
    bent: dict[str, list[float]] = {method.name: [] for method in (FULL, *RODS, PLAIN, QUADRATIC)}
    pressed: dict[str, list[float]] = {method.name: [] for method in (*RODS[1:], PLAIN, QUADRATIC)}
    one = Fields(1, mirror_x=True)
    length = SLENDERNESS * SIDE
    for value in values:
        material = Material(YOUNG, value)
        shearing = cowper_coefficient(value) * YOUNG * SIDE**2 / (2.0 * (1.0 + value))
        timoshenko = 4.0 * length**3 / (YOUNG * SIDE**4) + length / shearing
        equal = np.array(borders(length, SIDE, 2))
        found = [
            plain_rods.end_deflection(plain_rods.full_law(SECTION, material, one), one, ORDER, equal),
            *(2.0 * _bent(material, level).strain_energy for level in LEVELS),
            _solid_deflection(material, 8, 8),
            _solid_deflection(material, 2, 27),
        ]
        for name, deflection in zip(bent, found, strict=True):
            bent[name].append(deflection / timoshenko)
        finest = _solid_stiffness(material, 8, 27)
        stiff = [
            *(2.0 * _pressed(material, level).strain_energy for level in LEVELS[1:]),
            _solid_stiffness(material, 8, 8),
            _solid_stiffness(material, 4, 27),
        ]
        for name, stiffness in zip(pressed, stiff, strict=True):
            pressed[name].append(stiffness / finest)
    to_half = [0.5 - value for value in values]
    return {
        "bent": {name: curve(to_half, ratios) for name, ratios in bent.items()},
        "pressed": {name: curve(to_half, ratios) for name, ratios in pressed.items()},
    }


def _bent(material: Material, level: int) -> rodmodel.Solution:
    line = straight(SLENDERNESS * SIDE)
    rod = Rod(ROD, line, SECTION, material, borders(line.length, SIDE, 2))
    scene = Scene("bent", (rod,), (Clamp(ROD, "start"),), end_force(line, (0.0, 1.0, 0.0)), ())
    return rodmodel.solve(scene, level, ORDER)


def _pressed(material: Material, level: int) -> rodmodel.Solution:
    """A cube between clamps one of which moves by 1 mm: twice its energy is its stiffness, N/mm."""
    line = straight(SIDE)
    near = tuple(np.array([0.0, 0.15, 0.5, 0.85, 1.0]) * SIDE)
    rod = Rod(ROD, line, SECTION, material, near)
    clamps = (Clamp(ROD, "start"), Clamp(ROD, "end", (-1.0, 0.0, 0.0)))
    return rodmodel.solve(Scene("pressed", (rod,), clamps, (), ()), level, ORDER)


def _planes(elements: int) -> NDArray[np.float64]:
    return np.linspace(-0.5 * SIDE, 0.5 * SIDE, elements + 1)


def _solid_deflection(material: Material, across: int, nodes: int) -> float:
    """Mean deflection along X per unit force spread over the top of a cantilever along Z, mm/N."""
    length = SLENDERNESS * SIDE
    along = np.linspace(0.0, length, round(SLENDERNESS) * across + 1)
    # Half of it, with X odd across the plane Y = 0.
    body = solid((_planes(across), np.linspace(0.0, 0.5 * SIDE, across // 2 + 1), along), material, nodes)
    weights = face_weights(body, length)
    force = np.zeros(3 * body.basis.N)
    force[0::3] = weights / weights.sum()
    fixed = np.repeat(body.nodes[2] < 1e-9, 3)
    fixed[1::3] |= body.nodes[1] < 1e-9
    displacement = solved(body.stiffness, force, fixed, np.zeros(len(force)))
    return 0.5 * float(force @ displacement)


def _solid_stiffness(material: Material, across: int, nodes: int) -> float:
    """Force that presses a cube between bonded plates by 1 mm, N/mm; an eighth of it is solved."""
    half = np.linspace(0.0, 0.5 * SIDE, across // 2 + 1)
    body = solid((half, half, half), material, nodes)
    fixed, given = _eighth_held(body)
    displacement = solved(body.stiffness, np.zeros(len(fixed)), fixed, given)
    return 8.0 * float(displacement @ (body.stiffness @ displacement))


def _eighth_held(
    body: Solid,
) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Planes of symmetry and the plate, which moves by half a millimetre."""
    fixed, given = np.zeros(3 * body.basis.N, dtype=bool), np.zeros(3 * body.basis.N)
    for axis in range(3):
        fixed[axis::3] |= body.nodes[axis] < 1e-9
    plate = body.nodes[2] > 0.5 * SIDE - 1e-9
    for axis in range(3):
        fixed[axis::3] |= plate
    given[2::3][plate] = -0.5
    return fixed, given


def claim(found: Found) -> str:
    """Which elements lock."""
    bent, pressed = found["bent"], found["pressed"]
    levels = ", ".join(f"h{level} {share(bent[each.name].y[-1])}" for level, each in zip(LEVELS, RODS, strict=True))
    blocks = ", ".join(
        f"h{level} {pressed[each.name].y[-1]:.2f}" for level, each in zip(LEVELS[1:], RODS[1:], strict=True)
    )
    return (
        f"At nu = {0.5 - bent[PLAIN.name].x[-1]:g} the 8-node hexahedra keep {share(bent[PLAIN.name].y[-1])} of the "
        f"beam's deflection and h1 with the full law {share(bent[FULL.name].y[-1])}; h1 with its reduced law has "
        f"{levels.removeprefix('h1 ')}, 27-node hexahedra {share(bent[QUADRATIC.name].y[-1])}. The bonded cube is "
        "harder: against a finer mesh of 27-node hexahedra (8 x 8) the 8-node ones are "
        f"{pressed[PLAIN.name].y[-1]:.3g} times as stiff, the 27-node ones (4 x 4) "
        f"{pressed[QUADRATIC.name].y[-1]:.2f}; {blocks}."
    )


def own_limit(found: Found) -> str:
    """What the lowest level lacks beside the highest."""
    bent, pressed = found["bent"], found["pressed"]
    low, high = RODS[1].name, RODS[3].name
    return (
        f"h2 is {share(1.0 - bent[low].y[-1] / bent[high].y[-1])} stiffer than h6 in bending and "
        f"{share(pressed[low].y[-1] / pressed[high].y[-1] - 1.0)} in the cube, where h6 is the softest of all, which "
        "is to say the best. Nothing in a solution says that its level is too low: compare with the level two higher."
    )


def holds(found: Found) -> bool:
    """The plain ones lock; rods and quadratic elements do not, in bending nor in the cube."""
    bent, pressed = found["bent"], found["pressed"]
    plain = bent[PLAIN.name].y[-1] < 0.8 and bent[FULL.name].y[-1] < 0.2 and pressed[PLAIN.name].y[-1] > 1.5
    ours = all(abs(bent[each.name].y[-1] / bent[each.name].y[0] - 1.0) < 0.1 for each in RODS)
    return plain and ours and all(pressed[each.name].y[-1] < 1.1 for each in RODS[1:])


SWEEP = Sweep(
    "Incompressibility",
    "Poisson's ratio from 0.3 to 0.4999: a cantilever of square section, four times as long as high, under a force on "
    "its end, and a cube pressed between plates that it is bonded to.",
    RATIOS,
    (FULL, *RODS, PLAIN, QUADRATIC),
    (
        Picture("bent", "Cantilever", "0.5 − nu", "deflection / Timoshenko's", log_y=False),
        Picture("pressed", "Bonded cube", "0.5 − nu", "stiffness / that of a finer mesh"),
    ),
    measure,
    claim,
    own_limit,
    holds,
)
