"""Frictionless contact in compliance form: the rods are reduced to their contact points.

With forces f at the points and rigid motions q of what contact alone holds, the gap is d = d_0 + C f + G q, and
G^T f + h = 0 balances such rods. Where d < 0 the penalty makes f = -c_n w d; multipliers on top of it (the augmented
Lagrangian: Hestenes, Journal of Optimization Theory and Applications 4 (1969) 303-320) take the penetration away. C is
small and dense, so that trying another active set costs one small factorisation and no solution of the rods.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve, cholesky, solve_triangular

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

# Steps of the multipliers, and the change of the forces, relative to their sum, at which they have settled.
MOST_STEPS, SETTLED = 100, 1e-6
# Weight of balance against the gaps where least squares look for the points that hold a loose rod.
BALANCE_WEIGHT = 1e3
# Forces and gaps this small against the largest have no certain sign.
ROUND_OFF = 1e-10
# Share of a load that contact must balance to hold a loose rod.
BALANCED = 1e-8


@dataclass(frozen=True, eq=False)
class ContactProblem:
    """What contact has to solve.

    Attributes
    ----------
    compliance : C, mm/N, shape (n, n)
    gap : d_0, gap without contact forces, mm, shape (n,)
    spring : c_n w, penalty times share of the face, N/mm, shape (n,)
    motion : G, gap that unit rigid motions of loose rods open, shape (n, n_motions)
    motion_load : h, work of the given loads on these motions, shape (n_motions,)
    rigid : points whose penetration multipliers take away; at the others the springs are meant, shape (n,)
    """

    compliance: Array
    gap: Array
    spring: Array
    motion: Array
    motion_load: Array
    rigid: BoolArray


@dataclass(frozen=True, eq=False)
class ContactForces:
    """Solution of a contact problem.

    Attributes
    ----------
    force : f, N, never negative, shape (n,)
    motion : q, shape (n_motions,)
    outcome : 'converged', 'stagnated: ...' or 'refused: ...'
    active_sets : tried
    """

    force: Array
    motion: Array
    outcome: str
    active_sets: int


class ActiveSet:
    """Points joined by their springs, and the factorisations that answer for any gap there.

    Parameters
    ----------
    active : which points, shape (n,)
    """

    def __init__(self, active: BoolArray, problem: ContactProblem) -> None:
        self.active = active
        self._problem = problem
        self._soft = 1.0 / problem.spring[active]
        chosen = problem.compliance[np.ix_(active, active)]
        chosen[np.diag_indices_from(chosen)] += self._soft
        self._factor = cho_factor(chosen, lower=True, check_finite=False) if len(chosen) else None
        self._opening = problem.motion[active]
        self._by_motion = self._solve(self._opening)
        self._motion_stiffness = self._opening.T @ self._by_motion

    def _solve(self, right: Array) -> Array:
        return right if self._factor is None else cho_solve(self._factor, right, check_finite=False)

    def respond(self, gap: Array, load: Array) -> tuple[Array, Array]:
        """Forces, pulling ones included, and motions that close the given gaps and balance the given load.

        gap, load : of all points, shape (n,) or several (n, m); on the motions, shape (n_motions,) or (n_motions, m)
        """
        force = np.zeros_like(gap)
        found = -self._solve(gap[self.active])
        motion = np.zeros_like(load)
        if len(load):
            # Condensed onto the motions; least squares where the points do not hold all of them.
            motion = np.asarray(np.linalg.lstsq(self._motion_stiffness, load + self._opening.T @ found)[0])
            found = found - self._by_motion @ motion
        force[self.active] = found
        return force, motion

    def forces(self, multiplier: Array) -> tuple[Array, Array]:
        """Forces and motions of the problem, shapes (n,) and (n_motions,), given the multipliers, shape (n,)."""
        problem = self._problem
        return self.respond(problem.gap - multiplier / problem.spring, problem.motion_load)

    def settled_forces(self) -> tuple[Array, Array]:
        """Forces and motions of the problem with the multipliers that take the springs' penetration away."""
        multiplier = np.zeros_like(self._problem.gap)
        for _ in range(MOST_STEPS):
            force, motion = self.forces(multiplier)
            before, multiplier = multiplier, np.where(self._problem.rigid, force, 0.0)
            if _are_settled(multiplier, before):
                break
        return force, motion


def _are_settled(multiplier: Array, before: Array) -> bool:
    return bool(np.abs(multiplier - before).sum() <= SETTLED * np.abs(multiplier).sum())


def unilateral_contact(problem: ContactProblem, settled: bool = True) -> ContactForces:
    """Contact forces that only push: f >= 0, d >= 0 (d + f / (c_n w) >= 0 at springs), and one of the two zero.

    Each step of the multipliers is the minimum of a convex quadratic over f >= 0, solved by Lawson and Hanson's
    non-negative least squares, which end after finitely many sets. (A primal-dual active set cycles on these problems:
    more points than an element has freedoms make sets that differ by nothing but round-off.) Where the set of the step
    before still serves, no other is looked for.

    settled : go on until the multipliers have taken the penetration away; the first step alone tells about where
    """
    force, motion = np.zeros_like(problem.gap), np.zeros_like(problem.motion_load)
    if not _can_balance(problem):
        return ContactForces(force, motion, "refused: contact does not hold what nothing else holds", 0)
    multiplier, tried = force, 1
    chosen = ActiveSet(_pushing(problem, multiplier), problem)
    for _ in range(MOST_STEPS if settled else 1):
        force, motion, wrong = _answer(chosen, problem, multiplier)
        if len(wrong):
            chosen, tried = ActiveSet(_pushing(problem, multiplier), problem), tried + 1
            force, motion, wrong = _answer(chosen, problem, multiplier)
        # Least squares lose digits to the factor's condition, and weigh balance instead of asking for it: one point
        # after another changes sides until all serve.
        for _ in range(3 * len(force)):
            if not len(wrong):
                break
            active = chosen.active.copy()
            active[wrong[0]] = ~active[wrong[0]]
            chosen, tried = ActiveSet(active, problem), tried + 1
            force, motion, wrong = _answer(chosen, problem, multiplier)
        if len(wrong):
            return ContactForces(np.maximum(force, 0.0), motion, "stagnated: no set of contact points serves", tried)
        force = np.maximum(force, 0.0)
        before, multiplier = multiplier, np.where(problem.rigid, force, 0.0)
        if _are_settled(multiplier, before):
            break
    return ContactForces(force, motion, "converged", tried)


def _can_balance(problem: ContactProblem) -> bool:
    """Whether pushing forces of some size can balance the loose rods."""
    size = float(np.abs(problem.motion_load).max(initial=0.0))
    if size == 0.0:
        return True
    if not len(problem.gap):
        return False
    from scipy.optimize import nnls

    _, missing = nnls(problem.motion.T, -problem.motion_load)
    return bool(missing <= BALANCED * size)


def _answer(chosen: ActiveSet, problem: ContactProblem, multiplier: Array) -> tuple[Array, Array, IntArray]:
    """Forces and motions on a set, and the points wrong about it, the worst first.

    Those that pull, and those that are not joined and closer than their multiplier allows.
    """
    force, motion = chosen.forces(multiplier)
    opening = problem.gap + problem.compliance @ force + problem.motion @ motion - multiplier / problem.spring
    size = np.abs(problem.gap).max(initial=0.0) + np.abs(opening).max(initial=0.0)
    pulling = -force / (np.abs(force).max(initial=0.0) or 1.0)
    closing = -opening / (size or 1.0)
    wrong = np.where(chosen.active, pulling, closing)
    number = np.flatnonzero(wrong > ROUND_OFF)
    return force, motion, number[np.argsort(-wrong[number], kind="stable")]


def _pushing(problem: ContactProblem, multiplier: Array) -> BoolArray:
    """Points that push in the minimum over f >= 0, up to round-off."""
    gap = problem.gap - multiplier / problem.spring
    if not len(gap):
        return np.empty(0, dtype=bool)
    # Importing it takes longer than importing all of this package, and only scenes with contact need it.
    from scipy.optimize import nnls

    matrix = problem.compliance.copy()
    matrix[np.diag_indices_from(matrix)] += 1.0 / problem.spring
    factor = cholesky(matrix, lower=True, check_finite=False)
    rows, right = factor.T, -solve_triangular(factor, gap, lower=True, check_finite=False)
    if len(problem.motion_load):
        scale = np.linalg.norm(problem.motion, axis=0) / (BALANCE_WEIGHT * np.linalg.norm(factor))
        rows = np.vstack([rows, (problem.motion / scale).T])
        right = np.concatenate([right, -problem.motion_load / scale])
    try:
        return np.asarray(nnls(rows, right)[0] > 0.0)
    except RuntimeError:  # out of iterations: begin with what the given gaps close
        return np.asarray(gap < 0.0)
