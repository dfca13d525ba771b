"""Frictionless contact in compliance form: the rods are reduced to their contact points.

With forces f at the points and rigid motions q of what contact alone holds, the gap is d = d_0 + C f + G q, and
G^T f + h = 0 balances such rods. Where d < 0 the penalty makes f = -c_n w d; multipliers on top of it (the augmented
Lagrangian: Hestenes, Journal of Optimization Theory and Applications 4 (1969) 303-320) take the penetration away. C is
small and dense, so that trying another active set costs one small factorisation and no solution of the rods.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from rodmodel.triangular import cholesky, cholesky_solve

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

# Steps of the multipliers, and the energy left in the springs, as a share of the rods', at which they have settled.
MOST_STEPS, SETTLED = 100, 1e-13
# They end, too, where little is left and a step leaves most of it, however stiff the springs: rods cannot close that.
LITTLE, MOST = 1e-6, 0.9
# Energy that may be left where the steps have run out.
ACCEPTED = 1e-5
# By how much springs are made stiffer where steps leave most of the penetration, and how often; only those of points
# with this part of the largest penetration, as stiff springs at all points leave equations that round-off spoils.
STIFFENED, MOST_STIFFENED, CREEPING = 10.0, 4, 0.1
# The part of the largest penetration on the way that may be kept while springs can still be made stiffer.
KEPT = 1e-2
# Part of what is out of balance that a step may leave, or loose rods hang on softer springs; and how often they may.
SWAYING, MOST_SOFTENED = 0.5, 2
# How often points that are wrong about a set may change sides; how often in a row all of them may where that leaves no
# fewer, and what part of them does then.
MOST_EXCHANGES, PATIENCE, FEWER = 60, 3, 3
# Every such point tells where contact is before all are asked, but of so few.
SPARSE, FEW = 4, 20
# Stiffness of the points against a motion, of the largest, below which they do not hold it.
NO_STIFFNESS = 1e-15
# How far loose rods move on their springs, as a multiple of what they deform.
SOFT = 1e2
# Forces, gaps and unbalanced loads this small against the largest may be round-off; of gaps under given forces, in
# which loose rods on their springs are far away, much less is.
ROUND_OFF, LEAST_GAP = 1e-9, 1e-11
# Share of a load that contact may leave unbalanced on a loose rod: in the end, and where it only tells about where.
BALANCED, ROUGHLY_BALANCED = 1e-10, 1e-3


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
    motion : q, shape (n_motions,); of a refused problem the motion that contact leaves unresisted
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
        self._compliance = problem.compliance[np.ix_(active, active)]
        sprung = self._compliance.copy()
        sprung[np.diag_indices_from(sprung)] += self._soft
        self._factor = cholesky(sprung) if len(sprung) else None
        self._opening = problem.motion[active]
        self._by_motion = self._solve(self._opening)
        # Least squares where the points do not hold all motions.
        self._motion_flexibility = np.linalg.pinv(self._opening.T @ self._by_motion, rcond=NO_STIFFNESS, hermitian=True)

    def _solve(self, right: Array) -> Array:
        return right if self._factor is None else cholesky_solve(self._factor, right)

    def respond(self, gap: Array, load: Array) -> tuple[Array, Array]:
        """Forces, pulling ones included, and motions that close the given gaps and balance the given load.

        gap, load : of all points, shape (n,) or several (n, m); on the motions, shape (n_motions,) or (n_motions, m)
        """
        force = np.zeros_like(gap)
        force[self.active], motion = self._closing(gap[self.active], load)
        return force, motion

    def _closing(self, gap: Array, load: Array) -> tuple[Array, Array]:
        """Like `respond`, gaps and forces of the chosen points alone."""
        found = -self._solve(gap)
        if not len(load):
            return found, np.zeros_like(load)
        motion = self._motion_flexibility @ (load + self._opening.T @ found)
        return found - self._by_motion @ motion, motion

    def settled_forces(self) -> tuple[Array, Array]:
        """Forces and motions of the problem with the multipliers that take the springs' penetration away."""
        gap, rigid = self._problem.gap[self.active], self._problem.rigid[self.active]
        multiplier, left = np.zeros_like(gap), np.inf
        for _ in range(MOST_STEPS):
            found, motion = self._closing(gap - multiplier * self._soft, self._problem.motion_load)
            before, multiplier = multiplier, np.where(rigid, found, 0.0)
            held = float(np.sum((multiplier - before) ** 2 * self._soft))
            left_before, left = left, _share(held, float(multiplier @ self._compliance @ multiplier))
            if _is_settled(left, left_before):
                break
        force = np.zeros_like(self._problem.gap)
        force[self.active] = found
        return force, motion


def _is_settled(left: float, left_before: float) -> bool:
    return left <= SETTLED or (left <= LITTLE and left > MOST * left_before)


def _energy_left(problem: ContactProblem, multiplier: Array, before: Array) -> float:
    """What the springs still hold, as a share of what the rods and they do."""
    touching = np.flatnonzero(multiplier)
    pressing = multiplier[touching]
    rods = float(pressing @ problem.compliance[np.ix_(touching, touching)] @ pressing)
    return _share(float(np.sum((multiplier - before) ** 2 / problem.spring)), rods)


def _share(springs: float, rods: float) -> float:
    return springs / ((springs + rods) or 1.0)


def unilateral_contact(problem: ContactProblem, settled: bool = True, guess: BoolArray | None = None) -> ContactForces:
    """Contact forces that only push: f >= 0, d >= 0 (d + f / (c_n w) >= 0 at springs), and one of the two zero.

    Loose rods hang on soft springs, whose forces multipliers take away as they do the penetration. Each step of the
    multipliers is then the minimum of a strictly convex quadratic over f >= 0.

    guess : points that may be in contact, shape (n,), to begin with
    settled : go on until the multipliers have done their work; before, the forces tell about where contact is
    """
    force, motion = np.zeros_like(problem.gap), np.zeros_like(problem.motion_load)
    escaping = _escaping_motion(problem)
    if escaping.any():
        return ContactForces(force, escaping, "refused: contact does not hold what nothing else holds", 0)
    flexibility = _soft_springs(problem)
    hanging = _hanging(problem, flexibility)
    pushing = PushingForces(_with_springs(hanging, problem), guess)
    multiplier, left, first = force, np.inf, 0.0
    outcome, balance = "stagnated: the multipliers did not settle", 0.0
    largest, size = 0.0, float(np.abs(problem.motion_load).max(initial=0.0)) or _closing_force(problem)
    active = tried = np.empty(0, dtype=bool)
    slow = stiffened = swaying = softened = 0
    for _ in range(MOST_STEPS):
        hung = problem.gap + problem.motion @ (motion + flexibility @ problem.motion_load)
        try:
            found = pushing.closing(hung - multiplier / problem.spring)
        except np.linalg.LinAlgError:  # springs too stiff for the digits that numbers have
            found = None
        if found is None:
            outcome = "stagnated: no set of contact points serves"
            break
        force = found
        unbalanced = problem.motion.T @ force + problem.motion_load
        motion = motion + flexibility @ unbalanced
        before, multiplier = multiplier, np.where(problem.rigid, force, 0.0)
        # Forces of an interference that a loose rod gives way to vanish: what they began with is their measure.
        largest = max(largest, float(force.max(initial=0.0)))
        size = max(size, (np.abs(problem.motion.T) @ force).max(initial=0.0))
        balance_before, balance = balance, float(np.abs(unbalanced).max(initial=0.0))
        left_before, left = left, _energy_left(problem, multiplier, before)
        penetrated = np.where(problem.rigid, np.abs(multiplier - before) / problem.spring, 0.0)
        first = max(first, float(penetrated.max(initial=0.0)))
        crept = (
            stiffened < MOST_STIFFENED and _is_settled(left, left_before) and penetrated.max(initial=0.0) > KEPT * first
        )
        if balance <= (BALANCED if settled else ROUGHLY_BALANCED) * size and (
            not settled or (_is_settled(left, left_before) and not crept)
        ):
            outcome = "converged"
            break
        slow = slow + 1 if left > MOST * left_before else 0
        if (slow > PATIENCE and stiffened < MOST_STIFFENED) or crept:
            # Points next to which nothing yields, as at a clamp: their springs must be stiffer still.
            creeping = penetrated > CREEPING * penetrated.max()
            problem = replace(problem, spring=np.where(creeping, STIFFENED * problem.spring, problem.spring))
            pushing = PushingForces(_with_springs(hanging, problem), pushing.active, pushing.active_sets)
            slow, stiffened, tried = 0, stiffened + 1, np.empty(0, dtype=bool)
        swaying = swaying + 1 if balance > SWAYING * balance_before else 0
        if swaying > PATIENCE and softened < MOST_SOFTENED:
            # Loose rods on springs that are soft themselves need softer ones to hang on.
            flexibility = STIFFENED * flexibility
            hanging = _hanging(problem, flexibility)
            pushing = PushingForces(_with_springs(hanging, problem), pushing.active, pushing.active_sets)
            swaying, softened = 0, softened + 1
        active_before, active = active, pushing.active
        if settled and np.array_equal(active, active_before) and not np.array_equal(active, tried):
            # The set may be the one in the end: what it answers at once takes the steps many.
            tried = active
            answer = _serving(problem, active, largest, size)
            if answer is not None:
                return ContactForces(*answer, "converged", pushing.active_sets + 1)
    # What all these steps leave to do may still be little.
    if outcome != "converged" and left <= ACCEPTED and balance <= 10.0 * ROUND_OFF * size:
        outcome = "converged"
    return ContactForces(force, motion, outcome, pushing.active_sets)


def _hanging(problem: ContactProblem, flexibility: Array) -> Array:
    """Compliance of the contact points with loose rods on their springs."""
    return np.asarray(problem.compliance + problem.motion @ flexibility @ problem.motion.T)


def _with_springs(compliance: Array, problem: ContactProblem) -> Array:
    matrix = compliance.copy()
    matrix[np.diag_indices_from(matrix)] += 1.0 / problem.spring
    return matrix


def _serving(problem: ContactProblem, active: BoolArray, largest: float, size: float) -> tuple[Array, Array] | None:
    """Forces and motions that solve the problem if just these points touch; None if they pull or others penetrate.

    largest, size : forces and sums of forces on motions that are zero next to these are round-off
    """
    force, motion = ActiveSet(active, problem).settled_forces()
    opening = problem.gap + problem.compliance @ force + problem.motion @ motion
    unbalanced = problem.motion.T @ force + problem.motion_load
    serves = (
        force.min(initial=0.0) >= -ROUND_OFF * largest
        and opening[~active].min(initial=0.0) >= -ROUND_OFF * np.abs(problem.gap).max()
        and np.abs(unbalanced).max(initial=0.0) <= BALANCED * size
    )
    return (np.maximum(force, 0.0), motion) if serves else None


def _closing_force(problem: ContactProblem) -> float:
    """What would close the largest gap, N: the measure of forces on loose rods that no load acts on."""
    own = np.diagonal(problem.compliance) + 1.0 / problem.spring
    return float((np.abs(problem.gap) / own).max(initial=0.0))


def _soft_springs(problem: ContactProblem) -> Array:
    """Flexibility of the springs that loose rods hang on, shape (n_motions, n_motions).

    They move the contact points some `SOFT` times as far as the rods' own compliance does.
    """
    count = len(problem.motion_load)
    if count == 0 or not len(problem.gap):
        return np.zeros((count, count))
    own = float(np.median(np.diagonal(problem.compliance) + 1.0 / problem.spring))
    # Motions that open no gap have no say.
    return np.asarray(SOFT * own * len(problem.gap) * np.linalg.pinv(problem.motion.T @ problem.motion, hermitian=True))


class PushingForces:
    """Minimises 1/2 f^T A f + gap^T f over f >= 0 for one gap after another: f >= 0, gap + A f >= 0, one of them zero.

    From the set of the gap before all points that are wrong about it change sides at once (primal-dual active set), as
    long as that leaves fewer of them; then the worst of them only, until it does (block principal pivoting: Portugal,
    Judice, Vicente, Mathematics of Computation 63 (1994) 625-643). Points more than an element has freedoms make sets
    that differ by little but round-off, among which that may not end. Then Lawson and Hanson's non-negative least
    squares find the set, which end after finitely many.

    Attributes
    ----------
    active_sets : tried so far
    """

    def __init__(self, matrix: Array, guess: BoolArray | None, active_sets: int = 0) -> None:
        self.active_sets = active_sets
        self._guess = guess
        self._matrix = matrix
        self._factor: Array | None = None
        self._active = np.zeros(len(matrix), dtype=bool)
        self._active_factor: Array | None = None
        self._begun = False

    @property
    def active(self) -> BoolArray:
        """The points that the last forces join, shape (n,)."""
        return self._active

    def closing(self, gap: Array) -> Array | None:
        """The forces for a gap, shape (n,); None where no set of points serves."""
        if not self._begun:
            self._begun = True
            self._choose(self._first(gap) if self._guess is None else self._guess)
        force, wrong = self._forces(gap)
        fewest, patience = len(wrong), PATIENCE
        for _ in range(MOST_EXCHANGES):
            if not len(wrong):
                break
            self._exchange(wrong if patience else wrong[: max(1, len(wrong) // FEWER)])
            force, wrong = self._forces(gap)
            patience = PATIENCE if len(wrong) < fewest else max(0, patience - 1)
            fewest = min(fewest, len(wrong))
        if len(wrong):
            self._choose(self._least_squares(gap) > 0.0)
            force, wrong = self._forces(gap)
        # Least squares lose digits to the factor's condition: one point after another changes sides until all serve.
        for _ in range(3 * len(gap)):
            if not len(wrong):
                break
            self._exchange(wrong[:1])
            force, wrong = self._forces(gap)
        return None if len(wrong) else np.maximum(force, 0.0)

    def _first(self, gap: Array) -> BoolArray:
        """Points to begin with: where contact is for one in `SPARSE` of them without the others, found in the same way.

        Points that follow one another are neighbours, and many close ones change sides in many small steps.
        """
        if len(gap) <= FEW:
            return np.asarray(gap < 0.0)
        chosen = np.arange(0, len(gap), SPARSE)
        sparse = PushingForces(self._matrix[np.ix_(chosen, chosen)], None)
        sparse.closing(gap[chosen])
        return np.repeat(sparse.active, SPARSE)[: len(gap)]

    def _exchange(self, points: IntArray) -> None:
        active = self._active.copy()
        active[points] = ~active[points]
        self._choose(active)

    def _choose(self, active: BoolArray) -> None:
        self.active_sets += 1
        self._active = active
        chosen = self._matrix[np.ix_(active, active)]
        self._active_factor = cholesky(chosen) if len(chosen) else None

    def _forces(self, gap: Array) -> tuple[Array, IntArray]:
        """Forces on the chosen set, and the points that are wrong about it, the worst first.

        Those that pull, and those that are not joined and penetrate.
        """
        force = np.zeros_like(gap)
        if self._active_factor is not None:
            force[self._active] = -cholesky_solve(self._active_factor, gap[self._active])
        opening = gap + self._matrix @ force
        pulling = -force / (np.abs(force).max(initial=0.0) or 1.0)
        closing = -opening / (np.abs(gap).max(initial=0.0) or 1.0)
        wrong = np.where(self._active, pulling / ROUND_OFF, closing / LEAST_GAP)
        number = np.flatnonzero(wrong > 1.0)
        return force, number[np.argsort(-wrong[number], kind="stable")]

    def _least_squares(self, gap: Array) -> Array:
        if not len(gap):
            return gap
        # Importing it takes longer than importing all of this package, and only scenes with contact need it.
        from scipy.optimize import nnls

        if self._factor is None:
            self._factor = cholesky(self._matrix)
        try:
            return np.asarray(nnls(self._factor.T, -solve_triangular(self._factor, gap, lower=True))[0])
        except RuntimeError:  # out of iterations: begin with what the given gap closes
            return np.maximum(-gap, 0.0)


def _escaping_motion(problem: ContactProblem) -> Array:
    """A rigid motion that the loads drive and no pushing forces hold, shape (n_motions,); zero where they can.

    What the best of such forces leave unbalanced closes no gap and is worked on by the loads (Farkas' lemma).
    """
    load = problem.motion_load
    size = float(np.abs(load).max(initial=0.0))
    if size == 0.0:
        return np.zeros_like(load)
    if not len(problem.gap):
        return load
    from scipy.optimize import nnls

    balancing, missing = nnls(problem.motion.T, -load)
    return np.zeros_like(load) if missing <= ROUND_OFF * size else problem.motion.T @ balancing + load
