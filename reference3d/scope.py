"""What `solver` treats as boxes: straight, untwisted rods of rectangular section, clamped and under forces.

All else is for `solid_solver`, which takes anything and more time.
"""

from __future__ import annotations

from cases.scene import (
    Box,
    Clamp,
    ContactPair,
    Gravity,
    Ground,
    Helix,
    Line,
    LineLoad,
    Load,
    Material,
    Orthotropic,
    Pressure,
    Rectangle,
    Rod,
    Scene,
    SceneError,
    SectionForce,
    SectionMoment,
)

INSTEAD = "as boxes"

# Default penalty in units of the softer rod's Young's modulus over the smallest side of a section: a rod is squeezed a
# thousand times as much as it penetrates.
STIFF = 1e3

# What a load is called that is not a force, and what keeps it from being taken.
_OTHER_LOADS: dict[type[Load], tuple[str, str]] = {
    SectionMoment: ("a section moment", f"the 3D reference does not spread moments over a mesh {INSTEAD}"),
    Pressure: ("a pressure", f"the 3D reference does not load faces {INSTEAD}"),
    Gravity: ("gravity", f"the 3D reference does not load volumes {INSTEAD}"),
}


def require_treatable(scene: Scene) -> None:
    """Refuse what is not for boxes.

    Raises
    ------
    SceneError
        if a rod is curved, twisted, not isotropic or not of rectangular section, a support is not a clamp at rest,
        a load is not a force, or there is a joint or a bed.
    """
    for rod in scene.rods:
        straight_line(rod)
        rectangle(rod)
        isotropic(rod)
    clamps(scene)
    forces(scene)
    if scene.joints:
        remedy = f"the 3D reference does not join rods {INSTEAD}"
        raise SceneError("joints", f"{len(scene.joints)}", remedy)
    if scene.beds:
        raise SceneError("beds", f"{len(scene.beds)}", f"the 3D reference does not lay rods on beds {INSTEAD}")


def on_bed(pair: ContactPair) -> bool:
    """Whether a rod lies on a bed, whose springs are meant; those of all other pairs stand for rigid contact."""
    return isinstance(pair.second, Ground) and pair.second.modulus is not None


def penalty(scene: Scene, pair: ContactPair) -> float:
    """Modulus of a bed; else the penalty as given, or one so stiff that what it leaves hardly counts, N/mm^3."""
    if isinstance(pair.second, Ground) and pair.second.modulus is not None:
        return pair.second.modulus
    if pair.penalty is not None:
        return pair.penalty
    rods = [scene.rod(face.rod) for face in pair.faces]
    modulus = min(_young_modulus(rod.material) for rod in rods)
    sections = [rod.section for rod in rods if isinstance(rod.section, Rectangle | Box)]  # no others have flat faces
    return STIFF * modulus / min(min(section.width, section.height) for section in sections)


def _young_modulus(material: Material | Orthotropic) -> float:
    """Young's modulus, MPa; the largest of an orthotropic material, as springs must not give way along any axis."""
    return material.young_modulus if isinstance(material, Material) else max(material.young_moduli)


def straight_line(rod: Rod) -> Line:
    """The centre line of a rod, seen to be straight and untwisted; SceneError if it is not."""
    line = rod.centre_line
    if isinstance(line, Line) and line.twist == 0.0:
        return line
    found = "a twisted line" if isinstance(line, Line) else f"a {type(line).__name__.lower()}"
    if isinstance(line, Helix) and line.pitch == 0.0:
        found = "an arc"
    raise SceneError(
        f"rods.{rod.name}.centre_line", found, f"the 3D reference does not mesh curved or twisted rods {INSTEAD}"
    )


def rectangle(rod: Rod) -> Rectangle:
    """The section of a rod, seen to be a rectangle; SceneError if it is not."""
    if isinstance(rod.section, Rectangle):
        return rod.section
    found = f"a {type(rod.section).__name__.lower()}"
    raise SceneError(f"rods.{rod.name}.section", found, f"the 3D reference does not mesh any but rectangles {INSTEAD}")


def isotropic(rod: Rod) -> Material:
    """The material of a rod, seen to be isotropic; SceneError if it is not."""
    if isinstance(rod.material, Material):
        return rod.material
    remedy = f"the 3D reference takes no other than isotropic materials {INSTEAD}"
    raise SceneError(f"rods.{rod.name}.material", "an orthotropic material", remedy)


def clamps(scene: Scene) -> tuple[Clamp, ...]:
    """The supports of a scene, seen to be clamps at rest; SceneError if there is another among them."""
    found: list[Clamp] = []
    for number, support in enumerate(scene.supports, 1):
        if not isinstance(support, Clamp):
            remedy = f"the 3D reference holds nothing but whole end sections {INSTEAD}"
            raise SceneError(f"supports #{number}.kind", "a support of components", remedy)
        for key, motion in (("displacement", support.displacement), ("rotation", support.rotation)):
            if any(motion):
                remedy = f"the 3D reference does not move clamps {INSTEAD}"
                raise SceneError(f"supports #{number}.{key}", str(list(motion)), remedy)
        found.append(support)
    return tuple(found)


def forces(scene: Scene) -> tuple[SectionForce | LineLoad, ...]:
    """The loads of a scene, seen to be forces; SceneError if there is another among them."""
    found: list[SectionForce | LineLoad] = []
    for number, load in enumerate(scene.loads, 1):
        if not isinstance(load, SectionForce | LineLoad):
            kind, remedy = _OTHER_LOADS[type(load)]
            raise SceneError(f"loads #{number}.kind", kind, remedy)
        found.append(load)
    return tuple(found)
