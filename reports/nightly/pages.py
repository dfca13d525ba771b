"""The pages of verification and stability, which come with a nightly run over the whole library."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from reports.cache import Cache
from reports.processes import ProcessFailed


@dataclass(frozen=True)
class Pages:
    """What came of them.

    Attributes
    ----------
    files : names of those that were written
    missed : checks and claims that do not hold, and pages that could not be made, a line each
    notes : what the user should know of the cache, a sentence each
    """

    files: tuple[str, ...] = ()
    missed: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def write_pages(output: Path, folder: Path | None) -> Pages:
    """Carry out all checks and sweeps, each lot in a process of its own, and write their pages into a folder.

    Parameters
    ----------
    folder : of the cache in which their numbers are looked for and kept; None for none

    Raises
    ------
    OSError
        if one cannot be written.
    """
    cache = None if folder is None else Cache(folder)
    files, missed = [], []
    for name, write in (("verification", _write_verification), ("stability", _write_stability)):
        try:
            path, lines = write(output, cache)
        except ProcessFailed as error:
            missed.append(f"{name}: not run: {error}")
        else:
            files.append(path.name)
            missed += [f"{name}: {line}" for line in lines]
    return Pages(tuple(files), tuple(missed), () if cache is None else tuple(cache.notes))


def _write_verification(output: Path, cache: Cache | None) -> tuple[Path, list[str]]:
    # Here, since they bring all solvers, which a run of a few cases does without.
    from reports.verification import page as verification
    from reports.verification import registry as checks
    from reports.verification.wording import relative

    outcomes = checks.verify(cache)
    missed = [
        f"{name}: {found.verdict}: error {relative(found.error)}, tolerance {relative(found.check.tolerance)}"
        for name, found in outcomes.items()
        if found.verdict != "pass"
    ]
    return verification.write_verification(checks.GROUPS, outcomes, output, in_report=True), missed


def _write_stability(output: Path, cache: Cache | None) -> tuple[Path, list[str]]:
    from reports.stability import page as stability
    from reports.stability import registry as sweeps

    found = sweeps.carry_out(cache)
    missed = [f"{name}: does not hold" for name, each in found.found.items() if not sweeps.BY_NAME[name].holds(each)]
    return stability.write_stability(found, output, in_report=True), missed
