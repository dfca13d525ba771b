"""Tables that say where on a rod something is: a face, an end."""

from __future__ import annotations

from cases.scene import End, Face
from cases.tables.values import Table, Text


class RodFaceTable(Table):
    """A lateral face of a rod."""

    rod: Text
    """Name of one of the [rods]."""
    face: Face
    """Which face: "top" (y = +height/2), "bottom", "right" (x = +width/2) or "left"."""


class RodEndTable(Table):
    """An end of a rod."""

    rod: Text
    """Name of one of the [rods]."""
    end: End
    """Which end of the rod: "start" or "end"."""
