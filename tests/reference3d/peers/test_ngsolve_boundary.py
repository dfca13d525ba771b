"""NGSolve's own contact against contact condensed by hand: two ways through one mesh to one answer."""

import numpy as np
import pytest

from cases.loader import load_case
from cases.scene import SceneError
from reference3d.peers.ngsolve_grading import COARSE, graded
from reference3d.peers.ngsolve_solver import answer, installed, solve_condensed
from reference3d.peers.ngsolve_tuned import TUNED

pytestmark = pytest.mark.skipif(installed() != "", reason="NGSolve is not installed")


@pytest.mark.slow
def test_its_energy_of_penetration_gives_the_forces_of_the_active_set():
    from reference3d.peers.ngsolve_boundary import solve_with_contact_boundary

    case = "two-cantilevers-e50-g05"
    scene, hexahedra = load_case(case).scene, TUNED[case, 0.1]
    stations = {"upper": np.array([130.0])}

    own, condensed = (
        answer(solve(scene, hexahedra), stations, 0.0) for solve in (solve_with_contact_boundary, solve_condensed)
    )

    # the same points and polynomials; what differs is the penalty of 1e6 N/mm^3 against rigid contact: 3e-6 in force,
    # 0.001 mm in its centre, hence 8e-6 in the clamp's moment. Other meshes showed 8e-6, 0.002 mm and 2e-5.
    assert own.outcome == condensed.outcome == "converged"
    assert own.contact_force["overlap"] == pytest.approx(condensed.contact_force["overlap"], rel=2e-5, abs=1e-6)
    assert own.contact_centre["overlap"] == pytest.approx(condensed.contact_centre["overlap"], abs=5e-3)
    assert own.displacement["upper"][1] == pytest.approx(condensed.displacement["upper"][1], rel=1e-5)
    assert own.reactions["lower", 0.0] == pytest.approx(condensed.reactions["lower", 0.0], rel=5e-5, abs=1e-3)


def test_ground_is_refused():
    from reference3d.peers.ngsolve_boundary import solve_with_contact_boundary

    scene = load_case("bar-lifting-off-a-bed").scene

    with pytest.raises(SceneError, match="two rods"):
        solve_with_contact_boundary(scene, graded(scene, COARSE))
