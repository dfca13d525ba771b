"""Contact forces of solids in compliance form, also where contact alone holds rods.

The gaps of all contact nodes are those with joints at rest and what the skeleton's motions under contact forces add.
Rigid motions a that nothing but contact resists leave, with G the gaps that they open and h the loads on them,

    F >= 0,   w = d0 + C F + G a >= 0,   F^T w = 0,   h + G^T F = 0.

They are solved on soft springs, which are moved until they take no force (proximal method of multipliers:
R. T. Rockafellar, Mathematics of Operations Research 1 (1976) 97-116). Where the scene is mirrored, a contact node
stands for its image, too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls
from scipy.sparse import vstack

from reference3d.contact import RigidContact, solve_complementarity, without_penetration
from reference3d.solid_contact import SolidContact
from reference3d.solid_responses import Response, Skeleton, on_nodes

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

# how far loose rods move on their springs, as a multiple of what contact forces deform at most
SOFT = 1e3
# how often these springs are moved at most, and what they may carry in the end, of the forces on the motions
MOST_MOVES, BALANCED = 60, 1e-10
# singular value of G, over the largest, below which a motion opens no gap; what contact cannot balance, of the loads
OPENS, UNBALANCED = 1e-9, 1e-9
# force on a free motion, over the sum of all nodal loads, that is round-off
NO_FORCE = 1e-12


@dataclass(frozen=True)
class ContactForces:
    """Contact forces, N, and how far springs give way, mm, of every pair; free motions of the skeleton.

    motion : shape (n_free,); outcome; steps : active sets tried
    """

    forces: list[Array]
    given_way: list[Array]
    motion: Array
    outcome: str
    steps: int


def contact_forces(
    responses: Mapping[str, Response],
    skeleton: Skeleton,
    contacts: Sequence[SolidContact],
    candidates: Sequence[BoolArray],
    partners: Sequence[IntArray],
) -> ContactForces:
    """Solve the contact of a scene.

    Parameters
    ----------
    candidates : contact nodes that may touch, of every pair, with a node its image
    partners : image of every contact node; itself where there is no mirror
    """
    chosen = [
        np.flatnonzero(may & (np.arange(len(may)) <= partner))
        for may, partner in zip(candidates, partners, strict=True)
    ]
    starts = np.concatenate([[0], np.cumsum([len(each) for each in chosen])])
    total = int(starts[-1])
    # a node and its image are one unknown, the sum of both forces
    images = np.concatenate(
        [np.where(partner[own] != own, 2.0, 1.0) for own, partner in zip(chosen, partners, strict=True)] or [np.ones(0)]
    )
    joined = list(zip(contacts, chosen, strict=True))
    soft = np.concatenate([contact.soft[own] for contact, own in joined] or [np.ones(0)]) / images
    offset = np.concatenate([contact.gap[own] for contact, own in joined] or [np.ones(0)])
    rigid = np.concatenate([np.full(len(own), contact.rigid) for contact, own in joined] or [np.ones(0, dtype=bool)])
    matrix = np.diag(soft)
    moving = np.zeros((total, len(skeleton.force)))  # gaps under unit motions of the skeleton
    for name, found in responses.items():
        mine = [index for index, contact in enumerate(contacts) if name in contact.rows and len(chosen[index])]
        if found.factor is None or not mine:
            continue
        place = np.concatenate([np.arange(starts[index], starts[index + 1]) for index in mine])
        rows = vstack([contacts[index].rows[name][chosen[index]] for index in mine], format="csr")
        matrix[np.ix_(place, place)] += found.factor.compliance(rows)
        moved = rows @ found.columns.reshape(rows.shape[1], -1)
        offset[place] += moved[:, 0]
        moving[np.ix_(place, found.places)] += moved[:, 1:]
    # a contact force acts on the skeleton as the gap yields to its motion
    offset += moving @ skeleton.motion(skeleton.force)
    matrix += moving @ skeleton.motion(moving.T)
    load = skeleton.free.T @ skeleton.force
    load[np.abs(load) <= NO_FORCE * sum(float(np.abs(found.load).sum()) for found in responses.values())] = 0.0
    answer, motion = _solved(matrix, offset, soft, rigid, moving @ skeleton.free, load)
    forces = [np.zeros(len(contact.place)) for contact in contacts]
    given_way = [np.zeros(len(contact.place)) for contact in contacts]
    for index, (own, partner) in enumerate(zip(chosen, partners, strict=True)):
        part = slice(starts[index], starts[index + 1])
        for node in (own, partner[own]):
            forces[index][node] = (answer.force / images)[part]
            given_way[index][node] = answer.given_way[part]
    return ContactForces(forces, given_way, motion, answer.outcome, answer.steps)


def _solved(
    matrix: Array, offset: Array, soft: Array, rigid: BoolArray, opening: Array, load: Array
) -> tuple[RigidContact, Array]:
    """Forces, and free motions a.

    opening, load : G, shape (n, n_free), and h
    """
    count = opening.shape[1]
    if count == 0:
        if len(offset) == 0:
            return RigidContact(offset, offset, "converged", 0), load
        sprung = solve_complementarity(matrix, offset, offset < 0.0)
        return without_penetration(matrix, offset, soft, rigid, sprung), load
    none = RigidContact(np.zeros(len(offset)), np.zeros(len(offset)), "refused: unbalanced", 0)
    size = float(np.abs(load).max())
    if size > 0.0 and (len(offset) == 0 or nnls(opening.T, -load)[1] > UNBALANCED * size):
        return none, np.zeros(count)
    # motions in units in which they open gaps of one alike; those that open none stay, as nothing moves them
    gaps, values, motions = np.linalg.svd(opening, full_matrices=False)
    counts = values > OPENS * values.max(initial=0.0)
    gaps, motions = gaps[:, counts], motions[counts].T / values[counts]
    load = motions.T @ load
    give = SOFT * float(np.trace(matrix))
    sprung_matrix = matrix + give * gaps @ gaps.T
    motion, steps = np.zeros(len(load)), 0
    active = offset + gaps @ (give * load) < 0.0
    for _ in range(MOST_MOVES):
        here = offset + gaps @ (motion + give * load)
        sprung = solve_complementarity(sprung_matrix, here, active)
        answer = without_penetration(sprung_matrix, here, soft, rigid, sprung)
        steps += answer.steps
        unbalanced = load + gaps.T @ answer.force
        motion = motion + give * unbalanced
        active = answer.force > 0.0
        if answer.outcome != "converged":
            break
        carried = np.abs(load) + np.abs(gaps).T @ answer.force
        if (np.abs(unbalanced) <= BALANCED * carried.max(initial=0.0)).all():
            break
    else:
        answer = RigidContact(answer.force, answer.given_way, "stagnated", steps)
    return RigidContact(answer.force, answer.given_way, answer.outcome, steps), motions @ motion


def fields(
    responses: Mapping[str, Response], skeleton: Skeleton, contacts: Sequence[SolidContact], found: ContactForces
) -> dict[str, Array]:
    """Displacement of every rod under all loads and contact forces, arrays of unknowns."""
    moved, on_skeleton = {}, skeleton.force.copy()
    for name, response in responses.items():
        shape = response.load.shape
        moved[name] = response.columns[..., 0]
        if response.factor is not None:
            mine = [index for index, contact in enumerate(contacts) if name in contact.rows]
            force = on_nodes(
                [contacts[index].rows[name] for index in mine], [found.forces[index] for index in mine], shape
            )
            moved[name] = moved[name] + response.factor.solve(force.reshape(shape[0], -1, 1)).reshape(shape)
            np.add.at(on_skeleton, response.places, np.tensordot(force, response.columns[..., 1:], axes=3))
    motion = skeleton.motion(on_skeleton) + skeleton.free @ found.motion
    return {
        name: field + responses[name].columns[..., 1:] @ motion[responses[name].places] for name, field in moved.items()
    }
