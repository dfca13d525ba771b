"""Where contact starts and ends, from a pressure profile sampled at stations."""

from __future__ import annotations

import numpy as np

from reports.solution import Array

# Pressures below this part of the largest one of the pair count as no contact (round-off of a solver).
PRESSURE_FLOOR = 1e-6
# A stretch of a single station counts only if its pressure reaches this part of the largest one of the pair;
# below, it is an active-set flicker and not a zone.
FLICKER = 1e-2


def contact_stretches(station: Array, pressure: Array, limits: tuple[float, float]) -> tuple[tuple[float, float], ...]:
    """Stretches of positive pressure and where they end.

    Parameters
    ----------
    station : ascending, mm, shape (n,); where a station is repeated (element borders) the larger pressure
        counts
    pressure : MPa, shape (n,)
    limits : where the zone or a rod ends, mm

    Returns
    -------
    (start, end) of each stretch, ascending, mm

    Notes
    -----
    Near an edge inside the zone p ~ sqrt(distance) (Hertz), so p^2 is extrapolated to zero from the last
    two stations in contact, at most to the next open station. Where the pressure does not fall towards
    the edge, or a single station is in contact, the edge lies half way to the next open station.
    """
    span = limits[1] - limits[0]
    borders = np.concatenate([[True], np.diff(station) > 1e-9 * span])
    starts = np.flatnonzero(borders)
    merged = np.asarray(station)[starts]
    peak = np.maximum.reduceat(np.asarray(pressure, dtype=float), starts)
    largest = float(peak.max(initial=0.0))
    touching = peak > PRESSURE_FLOOR * largest
    if largest <= 0.0 or not touching.any():
        return ()
    change = np.flatnonzero(np.diff(np.concatenate([[False], touching, [False]]).astype(int)))
    stretches = []
    for begin, stop in change.reshape(-1, 2):
        last = stop - 1
        if begin == last and 0 < begin < len(merged) - 1 and peak[begin] < FLICKER * largest:
            continue
        start = _edge(merged, peak, begin, -1, begin == last, limits[0], 1e-6 * span)
        end = _edge(merged, peak, last, +1, begin == last, limits[1], 1e-6 * span)
        stretches.append((start, end))
    return tuple(stretches)


def edge_resolution(station: Array, stretches: tuple[tuple[float, float], ...], limits: tuple[float, float]) -> float:
    """Width of the widest station interval that holds an edge, mm; an edge at a limit is exact.

    Parameters
    ----------
    station : as in `contact_stretches`
    """
    inside = [edge for stretch in stretches for edge in stretch if edge not in limits]
    after = np.searchsorted(station, inside, side="right").clip(1, len(station) - 1)
    before = np.searchsorted(station, inside, side="left").clip(1, len(station) - 1) - 1
    return float((station[after] - station[before]).max(initial=0.0))


def _edge(station: Array, pressure: Array, index: int, step: int, alone: bool, limit: float, tolerance: float) -> float:
    """Edge of a stretch whose last station in contact is `index`, outwards in direction `step`."""
    beyond = index + step
    here = float(station[index])
    if not 0 <= beyond < len(station) or step * (limit - here) <= tolerance:
        return limit
    next_open = float(station[beyond])
    inner = index - step
    falling = not alone and pressure[inner] > pressure[index]
    if falling:
        slope = (pressure[inner] ** 2 - pressure[index] ** 2) / (station[index] - station[inner])
        edge = here + float(pressure[index] ** 2 / slope)
    elif step * (next_open - limit) > 0.0:
        return limit
    else:
        edge = 0.5 * (here + next_open)
    nearest = next_open if step * (limit - next_open) > 0.0 else limit
    return min(edge, nearest) if step > 0 else max(edge, nearest)
