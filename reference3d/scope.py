"""What the 3D reference can mesh and load so far: straight, untwisted rods of rectangular section under forces."""

from __future__ import annotations

from cases.scene import Line, LineLoad, Material, Rectangle, Rod, Scene, SceneError, SectionForce

INSTEAD = "yet; use --model rod"


def require_treatable(scene: Scene) -> None:
    """Refuse what cannot be meshed or loaded.

    Raises
    ------
    SceneError
        if a rod is curved, twisted, not isotropic or not of rectangular section, or a load is a moment.
    """
    for rod in scene.rods:
        straight_line(rod)
        rectangle(rod)
        isotropic(rod)
    forces(scene)


def straight_line(rod: Rod) -> Line:
    """The centre line of a rod, seen to be straight and untwisted; SceneError if it is not."""
    line = rod.centre_line
    if isinstance(line, Line) and line.twist == 0.0:
        return line
    found = "a twisted line" if isinstance(line, Line) else "an arc" if line.pitch == 0.0 else "a helix"
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
    remedy = f"the 3D reference knows isotropic materials alone {INSTEAD}"
    raise SceneError(f"rods.{rod.name}.material", "an orthotropic material", remedy)


def forces(scene: Scene) -> tuple[SectionForce | LineLoad, ...]:
    """The loads of a scene, seen to be forces; SceneError if there is a moment among them."""
    found: list[SectionForce | LineLoad] = []
    for number, load in enumerate(scene.loads, 1):
        if not isinstance(load, SectionForce | LineLoad):
            remedy = f"the 3D reference does not spread moments over a mesh {INSTEAD}"
            raise SceneError(f"loads #{number}.kind", "a section moment", remedy)
        found.append(load)
    return tuple(found)
