"""CalculiX (G. Dhondt and K. Wittig, www.calculix.de), run on the deck of a scene where the program `ccx` is installed.

Its mesh is that of the 3D reference with 20-node hexahedra of reduced integration; contact is its own: penalty between
surfaces. Contact forces are those that it prints for the slave surface, reactions its nodal forces in the clamps.
"""

from __future__ import annotations

import ctypes
import math
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cases.scene import Clamp, RodFace, Scene, station_of
from reference3d.peers.answer import NotInstalled, PeerAnswer
from reference3d.peers.calculix_output import Printed, SurfaceForce, complaint, increments, read_dat, unknowns
from reference3d.peers.deck import Deck, deck_text, make_deck
from reference3d.peers.deck_mesh import HexRod

Array = NDArray[np.float64]

PROGRAM = "ccx"
# loads and gaps are made so much smaller, so that lever arms and a second pairing are those of the undeformed shape
SCALE = 1e-3
# seconds after which a run is given up
TIME_LIMIT = 300.0
# force on a rod that may be left over, of the sum of its nodal forces: they are printed with seven digits
BALANCE = 1e-5
# option of Linux's prctl: the signal that a process is sent when the one that started it ends
PR_SET_PDEATHSIG = 1
# seconds between two looks at the memory of the run
LOOK = 0.05
MISSING = "CalculiX is not installed: no program `ccx` on the path (Debian, Ubuntu: apt-get install calculix-ccx)"


def installed() -> str:
    """'' where CalculiX can be run, else a sentence that says what is missing."""
    return "" if shutil.which(PROGRAM) else MISSING


def solve(scene: Scene, stations: Mapping[str, Array], refinement: int = 1) -> PeerAnswer:
    """A scene solved by CalculiX.

    Parameters
    ----------
    stations : by rod, arc lengths at which displacements are wanted, mm, shape (n,)
    refinement : k of `section_mesh` and `layers`

    Raises
    ------
    NotInstalled
        if there is no program `ccx`.
    SceneError
        if a deck cannot express the scene.
    """
    if absent := installed():
        raise NotInstalled(absent)
    begin = time.perf_counter()
    # a gap that is drawn cannot be made smaller
    drawn = any(pair.gap == "drawn" and isinstance(pair.second, RodFace) for pair in scene.contacts)
    deck = make_deck(scene, refinement, 1.0 if drawn else SCALE)
    with tempfile.TemporaryDirectory(prefix="rodcheck-ccx-") as folder:
        run = run_deck(deck_text(deck), Path(folder))
        printed = read_dat(Path(folder) / "deck.dat") if run.outcome == "converged" else None
    found = _Answers({}, {}, {}, {}) if printed is None else _answers(deck, printed, stations)
    return PeerAnswer(
        solver=f"CalculiX {version()}",
        outcome=run.outcome if printed is None else _balanced(deck, printed, found.contact_force),
        unknowns=run.unknowns,
        seconds=time.perf_counter() - begin,
        peak_memory=run.peak_memory,
        contact_force=found.contact_force,
        contact_centre=found.contact_centre,
        displacement=found.displacement,
        reactions=found.reactions,
    )


@dataclass(frozen=True, eq=False)
class _Answers:
    """Fields as in `PeerAnswer`."""

    contact_force: dict[str, Array]
    contact_centre: dict[str, Array]
    displacement: dict[str, Array]
    reactions: dict[tuple[str, float], Array]


def _answers(deck: Deck, printed: Printed, stations: Mapping[str, Array]) -> _Answers:
    found = _Answers({}, {}, {}, {})
    for pair in deck.scene.contacts:
        surface = printed.contacts[deck.name("first", pair.name)]
        found.contact_force[pair.name] = 0.0 - surface.force / deck.scale
        found.contact_centre[pair.name] = _centre(surface)
    for name, rod in deck.rods.items():
        nodal = _of_rod(rod, printed.displacements) / deck.scale
        found.displacement[name] = rod.centre_line(nodal, stations[name])
    for support in deck.scene.supports:
        if isinstance(support, Clamp):
            station = station_of(support, deck.scene.rod(support.rod))
            found.reactions[support.rod, station] = _reaction(deck, printed, support.rod, station)
    return found


def _of_rod(rod: HexRod, values: Array) -> Array:
    """The rows of a rod's nodes, shape (node_count, 3)."""
    return values[rod.mesh.first_node : rod.mesh.first_node + rod.mesh.node_count]


def _balanced(deck: Deck, printed: Printed, contact_force: Mapping[str, Array]) -> str:
    """Outcome of a run that converged: whether what is printed of forces adds up to nothing on every rod."""
    for name, rod in deck.rods.items():
        nodal = _of_rod(rod, printed.forces) / deck.scale
        total, magnitude = nodal.sum(axis=0), float(np.linalg.norm(nodal, axis=1).sum())
        for pair in deck.scene.contacts:
            if isinstance(pair.second, RodFace) and pair.second.rod == name:
                total = total + contact_force[pair.name]
            elif pair.first.rod == name:
                total = total - contact_force[pair.name]
        if not float(np.linalg.norm(total)) <= BALANCE * magnitude:
            return f"refused: forces on rod '{name}' are out of balance by {float(np.linalg.norm(total)):.2g} N"
    return "converged"


def version() -> str:
    """As CalculiX tells it."""
    told = subprocess.run([PROGRAM, "-v"], capture_output=True, text=True, check=False, timeout=60).stdout
    found = re.search(r"Version (\S+)", told)
    return found[1] if found else "of unknown version"


def _centre(found: SurfaceForce) -> Array:
    """The point on the line of action of a contact force that lies level with the area in contact, mm, shape (3,)."""
    square = float(found.force @ found.force)
    if square == 0.0:
        return np.full(3, np.nan)
    level = float(found.middle @ found.force) / square
    return np.asarray(np.cross(found.force, found.moment) / square + level * found.force)


def _reaction(deck: Deck, printed: Printed, rod: str, station: float) -> Array:
    """Force and moment about the section's centre that a clamp exerts on its rod, N and N mm, shape (6,)."""
    mesh, body = deck.rods[rod].mesh, deck.rods[rod].body
    nodes = deck.holds.clamped[rod, station]
    # what is printed of a node is all that acts on it from outside, its loads included
    loads = deck.rods[rod].forces(deck.scene.loads)[nodes - mesh.first_node]
    force = printed.forces[nodes] / deck.scale - loads
    arm = mesh.coordinates[nodes - mesh.first_node] - body.points[2 * body.border_at(station)]
    return np.concatenate([force.sum(axis=0), np.cross(arm, force).sum(axis=0)])


@dataclass(frozen=True)
class DeckRun:
    """How a run of CalculiX went: fields as in `PeerAnswer`."""

    outcome: str
    unknowns: int
    peak_memory: float


def run_deck(text: str, folder: Path, time_limit: float = TIME_LIMIT) -> DeckRun:
    """Run CalculiX on a deck in a folder, where it leaves its files as `deck.*`.

    Parameters
    ----------
    time_limit : seconds, wall-clock time and processor time
    """
    (folder / "deck.inp").write_text(text, encoding="ascii")
    told = folder / "told.txt"
    begin, peak, late = time.perf_counter(), 0.0, False
    with told.open("w") as stream:
        process = subprocess.Popen(
            [PROGRAM, "-i", "deck"],
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=stream,
            stderr=subprocess.STDOUT,
            preexec_fn=partial(_end_in_time, time_limit),
        )
        try:
            while process.poll() is None and not late:
                peak = max(peak, _memory(process.pid))
                late = time.perf_counter() - begin > time_limit
                time.sleep(LOOK)
        finally:
            process.kill()
            code = process.wait()
    output = told.read_text(encoding="utf-8", errors="replace")
    outcome = f"refused: not done within {time_limit:g} s" if late else _outcome(output, code, folder / "deck.sta")
    return DeckRun(outcome, unknowns(output), peak)


def _end_in_time(time_limit: float) -> None:
    """See to it that a new process ends by itself, as whoever started it may be killed before he can end it."""
    limit = math.ceil(time_limit)
    resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def _outcome(output: str, code: int, sta: Path) -> str:
    if error := complaint(output):
        return f"refused: {error}"
    if code != 0 or "Job finished" not in output:
        return f"refused: CalculiX ended early with exit code {code}"
    times = increments(sta) if sta.exists() else []
    if "zero-size increment is appended" in output:
        return "refused: CalculiX found tension in contact"
    if times and times != [1.0]:
        return f"refused: CalculiX took {len(times)} increments where one is asked for"
    return "converged"


def _memory(process: int) -> float:
    """Largest resident memory of a process so far, MB; 0 where the system does not tell.

    The operating system's account of ended children would begin with that of this process.
    """
    try:
        status = Path(f"/proc/{process}/status").read_text(encoding="ascii", errors="replace")
    except OSError:
        return 0.0
    found = re.search(r"VmHWM:\s+(\d+)", status)
    return int(found[1]) / 2**10 if found else 0.0
