"""The picture of a scene before it is solved, drawn in a process of its own, which VTK may end."""

from __future__ import annotations

from cases.scene import Scene
from reports.processes import Progress, in_own_process


def scene_picture(scene: Scene) -> bytes:
    """PNG of the undeformed rods with all that holds and loads them.

    Raises
    ------
    ProcessFailed
        where there is no way to draw off screen.
    """
    return in_own_process(_drawn, scene)


def _drawn(scene: Scene, _: Progress) -> bytes:
    from reports.check.undeformed import undeformed
    from reports.picture import draw_undeformed

    return draw_undeformed(scene, undeformed(scene)).png
