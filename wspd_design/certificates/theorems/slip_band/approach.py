"""The way from rolling to the slip reference, one sample after the other, in affine forms over boxes of the rail."""

from collections.abc import Generator, Iterator

import numpy as np

from wspd_design.certificates.kernel.affine import ROUNDING, Affine, Array
from wspd_design.certificates.theorems.slip_band.followed_law import decide
from wspd_design.certificates.theorems.slip_band.followed_plant import NUMBERS, SCALES, Plant, State, plant_of
from wspd_design.certificates.theorems.slip_band.motion import STEP, motion
from wspd_design.controllers.protection import Protection
from wspd_design.parameters.records import Rail, Vehicle

PARAMETERS = 18  # symbols that stand for the numbers of a box and their combinations, and are kept
KEPT = 160  # symbols at the beginning of a sample
STATES = len(State._fields)


def start(speed: float, boxes: int) -> tuple[Array, Array]:
    """Return centers and symbols of a train that rolls, its brake just demanded."""
    centers = np.zeros((boxes, STATES))
    centers[:, State._fields.index("speed")] = speed
    return centers, np.zeros((boxes, STATES, KEPT))


def follow(
    law: Protection,
    vehicle: Vehicle,
    rail: Rail,
    boxes: tuple[Array, Array],
    speed: float,
) -> Generator[tuple[Array, State, Plant], Array | None, None]:
    """Follow the loop from rolling, sample by sample, for many boxes, or for those that it is sent.

    Parameters
    ----------
    law : Protection
        Sliding mode of relative degree two with told speed and constant reference.
    vehicle, rail : Vehicle, Rail
        Nominal numbers.
    boxes : tuple of two arrays
        Centers (boxes, numbers) of :data:`NUMBERS`, and what the symbols do to them (boxes, numbers, symbols).
    speed : float
        At the beginning [m/s].

    Yields
    ------
    tuple of ndarray, State and Plant
        Largest slip within the sample, the state at its end, and the plant in the same symbols.
    """
    middle, spread = boxes
    count = len(middle)
    centers, symbols = start(speed, count)
    fresh_ones = 6 + 2 + 2 * max(1, round(law.sample_time / STEP))
    full = law.valve.brake.max_torque
    while True:
        columns = np.concatenate([symbols, np.zeros((count, STATES, 1 + fresh_ones))], axis=2)
        size = columns.shape[2]
        free = iter(range(KEPT + 1, size))

        def fresh(form: Affine, free: Iterator[int] = free) -> Affine:
            return form.named(next(free))

        state = State(*(Affine(centers[:, k], columns[:, k], np.zeros(count)) for k in range(STATES)))
        rows = np.zeros((count, len(NUMBERS), size))
        rows[:, :, : len(NUMBERS)] = spread
        numbers = {name: Affine(middle[:, k], rows[:, k], np.zeros(count)) for k, name in enumerate(NUMBERS)}
        plant = plant_of(vehicle, rail, full, numbers, len(NUMBERS))
        decided = decide(law, plant, state, fresh)
        moved = motion(plant, law, state, decided, KEPT, fresh)
        following = State(
            speed=moved.speed,
            sliding=moved.sliding,
            innovation=decided.innovation + moved.speed - moved.sliding,
            friction=decided.friction,
            torque=moved.torque,
            acceleration=decided.acceleration,
            change=moved.speed - state.speed,
            supply=moved.supply,
        )
        kept = yield moved.top, following, plant
        centers = np.stack([each.center for each in following], axis=1)
        symbols = _fewer(following)
        if kept is not None:
            centers, symbols, middle, spread = (each[kept] for each in (centers, symbols, middle, spread))
            count = len(middle)


def _fewer(state: State) -> Array:
    """Symbols of a state, the errors among them; what matters least is put into one symbol for each number."""
    slopes = np.stack([each.slopes for each in state], axis=1)
    errors = np.zeros((*slopes.shape[:2], STATES))
    for k, each in enumerate(state):
        errors[:, k, k] = each.error
    kept, rest = slopes[:, :, :PARAMETERS], slopes[:, :, PARAMETERS:]
    rest = np.concatenate([rest, errors], axis=2)
    sizes = np.abs(rest) / SCALES[None, :, None]
    order = np.argsort(sizes.max(axis=1) - sizes.sum(axis=1), axis=1, kind="stable")
    rest = np.take_along_axis(rest, order[:, None, :], axis=2)
    most = KEPT - PARAMETERS - STATES
    boxed = np.zeros((len(rest), STATES, STATES))
    boxed[:, range(STATES), range(STATES)] = np.abs(rest[:, :, most:]).sum(axis=2) * (1.0 + ROUNDING)
    return np.concatenate([kept, rest[:, :, :most], boxed], axis=2)
