"""A plane in which a whole scene of solids is mirrored: then half of the motions of every rod are left to solve for.

That it is one is seen on the discretised scene: loads and supports that are their own mirror images, rods that answer
mirrored displacements with mirrored forces, contact nodes of which every one has its image. Meshes stay whole: the
displacements of a plane of nodes are spanned by those that the mirror leaves as they are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import block_array, csr_array
from scipy.spatial import cKDTree

from cases.scene import Scene
from reference3d.facing import face_place
from reference3d.holds import Hold
from reference3d.plane_chain import HeldPlane, combinations_held
from reference3d.section_mesh import SectionMesh
from reference3d.solid_body import SolidBody, nodal_loads
from reference3d.solid_contact import SolidContact

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# difference that is round-off: of places, over the size of rod or section, and of forces, over the largest
SAME_PLACE, SAME_FORCE = 1e-9, 1e-9


@dataclass(frozen=True, eq=False)
class Mirror:
    """A mirror of a rod's sections, of m unknowns each.

    Attributes
    ----------
    axis : component of displacement that changes sign, 0 for x, 1 for y
    normal, point : of the plane, global, shape (3,)
    partner : image of every node of the section
    symmetric : orthonormal motions of a section that are their own images, columns, shape (m, n_symmetric)
    """

    axis: int
    normal: Array
    point: Array
    partner: IntArray
    symmetric: csr_array

    def image(self, values: Array) -> Array:
        """Mirrored vectors at the nodes, shape (..., n_nodes, 3)."""
        found = values[..., self.partner, :]
        found[..., self.axis] *= -1.0
        return found

    def into(self, values: Array) -> Array:
        """Values on planes in terms of the symmetric motions, shape (n_planes, m, n) to (n_planes, n_symmetric, n)."""
        return _by_plane(self.symmetric.T.tocsr(), values)

    def out_of(self, values: Array) -> Array:
        """The other way."""
        return _by_plane(self.symmetric, values)

    def rows_into(self, rows: csr_array) -> csr_array:
        """Functionals on all planes, shape (n, n_planes m), as functionals on the symmetric motions."""
        planes = rows.shape[1] // self.symmetric.shape[0]
        blocks: list[list[csr_array | None]] = [[None] * planes for _ in range(planes)]
        for plane in range(planes):
            blocks[plane][plane] = self.symmetric
        return csr_array(rows @ block_array(blocks, format="csr"))

    def held(self, plane: HeldPlane) -> HeldPlane:
        """What is held of the symmetric motions of a plane."""
        if plane.basis is None:
            return HeldPlane(None, abs(self.symmetric).T @ plane.fixed > 0.0)
        vectors, values, _ = np.linalg.svd(self.symmetric.T @ plane.basis[:, plane.fixed], full_matrices=False)
        # of a subspace that is its own image, motions are either symmetric or not
        return combinations_held(vectors[:, values > 0.5].T)

    def motions(self) -> Array:
        """Rigid motions about a pole in the plane that it leaves: displacement and rotation, shape (3, 6)."""
        along = np.linalg.svd(self.normal[None])[2][1:]
        return np.block([[along, np.zeros((2, 3))], [np.zeros((1, 3)), self.normal[None]]])


def _by_plane(matrix: csr_array, values: Array) -> Array:
    planes, size, count = values.shape
    found = matrix @ values.transpose(1, 0, 2).reshape(size, -1)
    return np.asarray(np.ascontiguousarray(found.reshape(-1, planes, count).transpose(1, 0, 2)))


def scene_mirrors(
    scene: Scene,
    bodies: Mapping[str, SolidBody],
    held: Mapping[str, Mapping[int, Hold]],
    contacts: list[SolidContact],
) -> dict[str, Mirror]:
    """Mirrors of all rods in one plane; none if there is no such plane, or if there are joints."""
    if scene.joints:
        return {}
    first = bodies[scene.rods[0].name]
    for normal in first.axes[0, :2]:
        found: dict[str, Mirror] = {}
        for name, body in bodies.items():
            mirror = mirror_in(body, normal, first.points[0])
            if mirror is None or not _is_symmetric(scene, body, held[name], mirror):
                break
            found[name] = mirror
        whole = len(found) == len(bodies)
        if whole and all(contact_partners(contact, bodies, found) is not None for contact in contacts):
            return found
    return {}


def mirror_in(body: SolidBody, normal: Array, point: Array) -> Mirror | None:
    """The mirror of a rod's sections in a plane; None if that does not take the mesh to itself."""
    size = max(body.rod.length, float(np.ptp(body.section.nodes)))
    if np.abs((body.points - point) @ normal).max() > SAME_PLACE * size:
        return None
    for axis in (0, 1):
        if np.abs(np.abs(body.axes[:, axis] @ normal) - 1.0).max() < SAME_PLACE:
            partner = _partners(body.section, axis)
            return None if partner is None else Mirror(axis, normal, point, partner, _symmetric(partner, axis))
    return None


def _partners(section: SectionMesh, axis: int) -> IntArray | None:
    """Node at the mirrored place of every node; None if there is none."""
    image = section.nodes.copy()
    image[:, axis] *= -1.0
    distance, partner = cKDTree(section.nodes).query(image)
    return partner.astype(np.int64) if distance.max() < SAME_PLACE * np.ptp(section.nodes) else None


def _symmetric(partner: IntArray, axis: int) -> csr_array:
    node = np.arange(len(partner))
    sign = np.where(np.arange(3) == axis, -1.0, 1.0)
    pair = np.repeat(node[node <= partner], 3)
    component = np.tile(np.arange(3), len(pair) // 3)
    # motions across the plane are zero on it
    moving = (partner[pair] != pair) | (component != axis)
    pair, component = pair[moving], component[moving]
    alone = partner[pair] == pair
    size = np.where(alone, 1.0, np.sqrt(0.5))
    column = np.arange(len(pair))
    value = np.concatenate([size, (size * sign[component])[~alone]])
    unknown = np.concatenate([3 * pair + component, (3 * partner[pair] + component)[~alone]])
    return csr_array((value, (unknown, np.concatenate([column, column[~alone]]))), shape=(3 * len(node), len(pair)))


def _random(body: SolidBody) -> Array:
    return np.random.default_rng(1).standard_normal(body.shape)


def _is_symmetric(scene: Scene, body: SolidBody, held: Mapping[int, Hold], mirror: Mirror) -> bool:
    """Whether what acts on a rod and holds it, and the rod itself, are their own mirror images."""

    def same(values: Array) -> bool:
        apart = np.abs(mirror.image(values) - values).max(initial=0.0)
        return bool(apart <= SAME_FORCE * np.abs(values).max(initial=0.0))

    if not same(nodal_loads(body, scene.loads)):
        return False
    for hold in held.values():
        fixed = hold.plane.fixed
        if not same(hold.given.reshape(-1, 3)):
            return False
        if hold.plane.basis is None:
            if (mirror.image(fixed.astype(np.float64).reshape(-1, 3)) ** 2 != fixed.reshape(-1, 3)).any():
                return False
            continue
        basis = hold.plane.basis[:, fixed]
        image = mirror.image(basis.T.reshape(-1, *body.shape[1:])).reshape(basis.shape[1], -1).T
        if np.abs(image - basis @ (basis.T @ image)).max() > SAME_FORCE:
            return False
    moved = _random(body)
    solid, beds = body.internal_forces(moved + mirror.image(moved))
    return same(solid + beds)


def contact_partners(
    contact: SolidContact, bodies: Mapping[str, SolidBody], mirrors: Mapping[str, Mirror]
) -> IntArray | None:
    """Image of every contact node of a pair, shape (n,); None if one has none."""
    rod = bodies[contact.pair.first.rod].rod
    if face_place(rod, contact.pair.first.face).axis == mirrors[rod.name].axis:
        return None
    number = np.full(len(contact.station) * len(contact.lateral), -1)
    number[contact.place] = np.arange(len(contact.place))
    row, column = np.divmod(contact.place, len(contact.lateral))
    partner: IntArray = number[row * len(contact.lateral) + len(contact.lateral) - 1 - column].astype(np.int64)
    if (partner < 0).any():
        return None
    size = max(float(np.abs(contact.gap).max(initial=0.0)), float(contact.lateral.max()))
    if np.abs(contact.gap[partner] - contact.gap).max(initial=0.0) > SAME_PLACE * size:
        return None
    if np.abs(contact.area[partner] - contact.area).max(initial=0.0) > SAME_PLACE * contact.area.max(initial=0.0):
        return None
    for name, rows in contact.rows.items():
        moved = _random(bodies[name])
        own, image = (rows @ each.ravel() for each in (moved, mirrors[name].image(moved)))
        if np.abs(own[partner] - image).max(initial=0.0) > SAME_FORCE * np.abs(own).max(initial=0.0):
            return None
    return partner
