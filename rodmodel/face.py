"""Flat lateral faces of a rod, straight, curved or twisted: their area, pressure on them and beds under them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import Box, Face, Rectangle, Rod, Scene, Section
from rodmodel.axial import gauss
from rodmodel.section import Darboux, Fields, axial_modulus, section_values

Array = NDArray[np.float64]

# Beds under an element: face, and modulus in units of the rod's axial modulus, 1/mm.
Springs = tuple[tuple[Face, float], ...]
# Points across the face beyond those that products of two fields need: the area of a twisted face is no polynomial.
EXTRA_POINTS = 6


@dataclass(frozen=True, eq=False)
class FaceStrip:
    """Points across a face at one station, and the area that they stand for.

    Attributes
    ----------
    x, y : section coordinates, mm, shape (n,)
    area : outward area vector per arc length of the centre line, components along e1, e2, t, mm, shape (3, n)
    """

    x: Array
    y: Array
    area: Array

    @property
    def size(self) -> Array:
        """Length of the area vectors, mm, shape (n,)."""
        return np.asarray(np.linalg.norm(self.area, axis=0))


def face_strip(section: Section, face: Face, turning: Darboux, level: int) -> FaceStrip:
    """Gauss points across a face, enough for products of two level-k functions; ValueError for a section without faces.

    Along s a point moves by r_s = sqrt(g) t + tau (x e2 - y e1), across the face by e1 or e2; their cross product is
    the area vector.
    """
    if not isinstance(section, Rectangle | Box):
        raise ValueError(f"only rectangles and boxes have flat faces, not {section}")
    k1, k2, tau = turning
    upright = face in ("top", "bottom")
    sign = 1.0 if face in ("top", "right") else -1.0
    root, weight = gauss(level + 1 + (EXTRA_POINTS if any(turning) else 0))
    half_width = 0.5 * (section.width if upright else section.height)
    along, fixed = half_width * root, np.full_like(root, 0.5 * sign * (section.height if upright else section.width))
    x, y = (along, fixed) if upright else (fixed, along)
    stretch, nothing = 1.0 - k2 * x + k1 * y, np.zeros_like(x)
    area = np.array([nothing, stretch, -tau * x]) if upright else np.array([stretch, nothing, tau * y])
    return FaceStrip(x, y, sign * half_width * weight * area)


def face_values(section: Section, fields: Fields, strip: FaceStrip, vector: Array) -> Array:
    """Displacement along given vectors (shape (3, n)) at the points of a strip, of every field, shape (n_fields, n)."""
    return np.asarray(section_values(section, fields, strip.x, strip.y) * vector[fields.table[0]])


def pressure_work(section: Section, face: Face, fields: Fields, turning: Darboux) -> Array:
    """Work of a unit pressure on a face, per arc length of the centre line, on every field, mm, shape (n_fields,)."""
    strip = face_strip(section, face, turning, fields.level)
    return np.asarray(-face_values(section, fields, strip, strip.area).sum(axis=1))


def bed_stiffness(section: Section, springs: Springs, fields: Fields, turning: Darboux) -> Array:
    """Int k u_n u_n over the faces on beds, per arc length: what beds add to S_00, shape (n_fields, n_fields)."""
    result = np.zeros((fields.count, fields.count))
    for face, modulus in springs:
        strip = face_strip(section, face, turning, fields.level)
        size = strip.size
        normal = face_values(section, fields, strip, strip.area / size)
        result += (modulus * size * normal) @ normal.T
    return result


def springs_under(scene: Scene, rod: Rod, borders: Array) -> list[Springs]:
    """The beds under each element, whose borders (mm, shape (n_elements + 1,)) hold the ends of all beds."""
    middle = 0.5 * (borders[:-1] + borders[1:])
    beds = [bed for bed in scene.beds if bed.rod == rod.name]
    unit = axial_modulus(rod.material)
    return [tuple((bed.face.face, bed.modulus / unit) for bed in beds if bed.start < at < bed.end) for at in middle]
