"""Whether wheels that come from rolling are in the ellipsoid of a band: the state of the way in, in its coordinates."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from wspd_design.certificates.kernel.affine import Affine, Array
from wspd_design.certificates.theorems.slip_band.followed_law import known_acceleration, observed_friction
from wspd_design.certificates.theorems.slip_band.followed_plant import Plant, State
from wspd_design.certificates.theorems.slip_band.motion import rates
from wspd_design.certificates.theorems.slip_band.statement import Cell
from wspd_design.controllers.protection import Protection

INWARD = 1e-6  # by which an ellipsoid is made smaller, so that rounding of its root does not count


class Asked(NamedTuple):
    """What a band asks of a wheel at its beginning."""

    speeds: tuple[float, float]  # m/s, of the window
    settled: float  # rad/s, error of the wheel speed that errors are counted from
    matrix: Sequence[Sequence[float]]  # P of (X - c)'P(X - c) <= 1 [s2/rad2]
    center: Sequence[float]  # c [rad/s]
    moved: Sequence[float]  # by how much the center is elsewhere at either end of the steady drift [rad/s]
    supply: float  # -, of the full pressure, at least
    closer: Callable[[Cell, tuple[float, float]], tuple[list[float], list[float]]] | None = None
    """Center and by how much it is elsewhere, for a part of the cell and of the speeds [m/s]."""


def arrived(law: Protection, plant: Plant, state: State, asked: Asked) -> Array:
    """Tell for each box whether all of its wheels have what a band asks for.

    Parameters
    ----------
    law : Protection
        Sliding mode of relative degree two.
    plant, state : Plant, State
        At a sample, before the law computes.
    asked : Asked
        Of the band.
    """
    deviations = in_band(law, plant, state, asked.settled)
    root = np.linalg.cholesky(np.asarray(asked.matrix, dtype=float)).T
    apart = [x - float(c) for x, c in zip(deviations, asked.center, strict=True)]
    # The length of a sum is at most the sum of the lengths: of the center, of each symbol, and of the errors.
    centers, errors = (np.stack([getattr(x, name) for x in apart], axis=1) for name in ("center", "error"))
    symbols = np.stack([x.slopes for x in apart], axis=1)
    length = np.linalg.norm(centers @ root.T, axis=1)
    length = length + np.linalg.norm(np.einsum("ij,bjs->bis", root, symbols), axis=1).sum(axis=1)
    length = length + np.linalg.norm(errors @ np.abs(root).T, axis=1)
    length = length + np.linalg.norm(root @ np.asarray(asked.moved, dtype=float))
    slow, fast = asked.speeds
    inside: Array = (
        (length < 1.0 - INWARD)
        & (state.speed.low >= slow)
        & (state.speed.high <= fast)
        & (state.supply.low >= asked.supply)
    )
    return inside


def in_band(law: Protection, plant: Plant, state: State, settled: float) -> tuple[Affine, ...]:
    """Return e, p, N, Y and D of the band, once the law has observed [rad/s]."""
    h, inertia = law.sample_time, law.wheelset_inertia
    slip, pole = law.reference.slip, float(np.exp(-law.observer_rate * h))  # type: ignore[attr-defined]
    held = state.speed * slip - settled / plant.curvature  # sliding speed
    slowing, _ = rates(plant, state.speed, state.sliding)
    slowing_there, gliding_there = rates(plant, state.speed, held)
    turning = slowing * (1.0 - slip)  # of the rim at the reference [m/s2]
    holding = (slowing_there - gliding_there - turning) / plant.effect  # N m, as the law sees it
    known = known_acceleration(law, state)
    friction = observed_friction(law, plant, state)
    return (
        (held - state.sliding) * plant.curvature,
        state.innovation * plant.curvature * -(pole**2),
        (friction - holding) * (h / inertia) - turning * plant.curvature * h,
        (state.torque - holding) * (h / inertia),
        (slowing - known) * plant.curvature * ((1.0 - slip) * h),
    )
