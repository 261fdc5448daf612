"""Attacks on what is said about loops behind a sampled valve: recovery, poles, Lyapunov functions, invariant sets."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import numpy as np

from tests.attack import linear, motion
from tests.attack.case import Case, Stated
from tests.attack.laws import feedback_duty
from tests.attack.plant import holding_torque, slip_pole
from tests.attack.search import Attack, Points
from tests.attack.statements import box, plant_at

DEVIATION = 0.05  # of the slip that full venting has to bring back
SETTLED = 1e-3  # of the slip from sample to sample, at the end of a run
NEVER = -1.0  # margin where the thing that is spoken about does not exist


def hard_limits(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """A deviation is held for a sample at frozen speed, then vented away."""

    def margin(x: Points) -> Any:
        plant = plant_at(case, x)
        torque = np.clip(holding_torque(plant, case.slip, x["speed"]), 0.0, plant.max_torque)
        state = motion.wheels(case.slip + DEVIATION, x["speed"], torque)
        motion.hold(plant, state, case.sample_time, steps=12, frozen=True)
        motion.vent(plant, state, 3.0, steps=90, frozen=True)
        back = case.slip - state.slip
        return np.minimum(case.slips[1] - state.highest, back + 0.02)

    return [
        Attack(
            check=stated.check,
            statement=f"full venting brings a deviation of {DEVIATION:g} back below {case.slips[1]:g}",
            box=box(case, names, speed=case.speeds),
            margin=margin,
            cost=100,
        )
    ]


def _equilibrium(case: Case, stated: Stated, names: tuple[str, ...]) -> Attack:
    def margin(x: Points) -> Any:
        slip, _ = linear.equilibrium(case, plant_at(case, x), x["speed"])
        return np.where(np.isnan(slip), NEVER, case.tolerance - abs(slip - case.slip))

    return Attack(
        check=stated.check,
        statement=f"the loop has an equilibrium within {case.tolerance:g} of slip {case.slip:g}",
        box=box(case, names, speed=case.speeds),
        margin=margin,
        cost=40,
    )


def lpv_lyapunov(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """The loop with true pulses has an equilibrium near its reference, and settles."""
    return [_equilibrium(case, stated, names), _settles(case, stated, names)]


def functions(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """Quadratic functions of a file fall around any slip within the tolerance, taken as the equilibrium."""
    return [
        _falls(case, stated, names, Pieces(case, proof), sampled=sampled)
        for proof in stated.quadratics
        for sampled in (True, False)
    ]


PIECEWISE = {"f": "fill_time", "v": "vent_time", "t": "max_torque", "i": "wheelset_inertia"}


class Pieces:
    """Functions of a proof and the box of each, as columns: P and rate, continuous and sampled."""

    def __init__(self, case: Case, proof: Mapping[str, Any]) -> None:
        plant, bounds = case.data.plant, case.data.bounds
        root = {name: bounds.get(name, (getattr(plant, name),) * 2) for name in PIECEWISE.values()}
        waiting, boxes = [root], []
        for step in proof["steps"]:
            box = waiting.pop()
            if step == ".":
                boxes.append(box)
                continue
            low, high = box[name := PIECEWISE[step]]
            middle = (low + high) / 2
            waiting += [{**box, name: (middle, high)}, {**box, name: (low, middle)}]
        self.low, self.high = (
            {name: np.array([box[name][end] for box in boxes]) for name in root} for end in (0, 1)
        )
        self.numbers = np.array([[float(Fraction(each)) for each in piece] for piece in proof["pieces"]]).T


def _falls(case: Case, stated: Stated, names: tuple[str, ...], pieces: Pieces, *, sampled: bool) -> Attack:
    """V falls; y is the error of the sliding speed that the law sees, the second number R T/I with its radius."""
    count = pieces.numbers.shape[1]

    def margin(x: Points) -> Any:
        piece = np.minimum((x["piece"] * count).astype(int), count - 1)
        own = {
            name: pieces.low[name][piece] + x[f"along {name}"] * (pieces.high[name] - pieces.low[name])[piece]
            for name in PIECEWISE.values()
        }
        plant = plant_at(case, {**x, **own})
        share = holding_torque(plant, x["slip"], x["speed"]) / plant.max_torque
        possible = (share > 1e-6) & (share < 1.0 - 1e-6)
        q = linear.difference_rate(plant, x["slip"], x["speed"])
        seen = plant.with_numbers({"wheel_radius": case.model.wheel_radius})
        scale = seen.wheel_radius * case.model.max_torque / plant.wheelset_inertia
        share = np.where(possible, share, 0.5)
        if sampled:
            duty = linear.duty_of(plant, share, case.sample_time)
            matrix = linear.sampled_map(case, seen, x["slip"], x["speed"], duty, q=q)
        else:
            matrix = linear.averaged(case, seen, share, q)
        one = np.ones(np.shape(q))
        matrix = matrix * np.array([[one, 1.0 / scale], [scale, one]])
        p, rate = (
            pieces.numbers[4:7, piece] if sampled else pieces.numbers[:3, piece],
            pieces.numbers[7 if sampled else 3],
        )
        worst = linear.contraction(matrix, p) if sampled else linear.growth(matrix, p)
        return np.where(possible, (rate[piece] if sampled else -rate[piece]) - worst, np.nan)

    near = (case.slip - case.tolerance, case.slip + case.tolerance)
    free = [name for name in names if name not in PIECEWISE.values()]
    along = {f"along {name}": (0.0, 1.0) for name in PIECEWISE.values()}
    return Attack(
        check=stated.check,
        statement=f"the {count} functions fall, {'per sample with true pulses' if sampled else 'continuously'}",
        box=box(case, free, speed=case.speeds, slip=near, piece=(0.0, 1.0), **along),
        margin=margin,
        cost=4,
        slack=1e-9,
    )


def _settles(case: Case, stated: Stated, names: tuple[str, ...]) -> Attack:
    """The nonlinear loop with true pulses, from its equilibrium with a small deviation, comes to rest."""

    def margin(x: Points) -> Any:
        plant = plant_at(case, x)
        slip, _ = linear.equilibrium(case, plant, x["speed"])
        lost = np.isnan(slip)
        slip = np.where(lost, case.slip, slip)
        torque = np.clip(holding_torque(plant, slip, x["speed"]), 0.0, plant.max_torque)
        state = motion.wheels(slip + 0.002, x["speed"], torque)
        seen = motion.sampled_run(case, plant, state, 300)
        swing = abs(np.diff(seen[-20:], axis=0)).max(axis=0)
        return np.where(lost, NEVER, SETTLED - swing)

    return Attack(
        check=stated.check,
        statement="the loop with true pulses settles at frozen speed",
        box=box(case, names, speed=case.speeds),
        margin=margin,
        cost=2000,
    )


def routh_lag(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """Poles of the loop with the averaged valve at frozen speed, about any slip within the tolerance."""
    ranges = {"speed": case.speeds}
    if case.law == "torque-feedback":
        ranges["slip"] = (case.slip - case.tolerance, case.slip + case.tolerance)

        def margin(x: Points) -> Any:
            plant = plant_at(case, x)
            share = holding_torque(plant, x["slip"], x["speed"]) / plant.max_torque
            possible = (share > 0.0) & (share < 1.0)
            seen = plant.with_numbers({"wheel_radius": case.model.wheel_radius})
            pole = slip_pole(plant, x["slip"], x["speed"])
            matrix = linear.averaged(case, seen, np.where(possible, share, 0.5), pole)
            return np.where(possible, -linear.abscissa(matrix), np.nan)

    else:

        def margin(x: Points) -> Any:
            return -linear.surface_poles(case, plant_at(case, x), x["speed"])

    return [
        Attack(
            check=stated.check,
            statement="all poles behind the averaged valve lie in the left half-plane",
            box=box(case, names, **ranges),
            margin=margin,
            unit="1/s",
            cost=20,
        )
    ]


def sampled_invariance(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """One sample with true pulses, from the sets of the file: slip and torque stay in the sets of their speed."""
    return [_stays(case, stated, names, [Cells(each) for each in sets]) for sets in stated.sets]


class Cells:
    """One window of speed with its cells of (slip, level), level = torque over T_max + tilt (slip - reference)."""

    def __init__(self, window: dict[str, Any]) -> None:
        self.low, self.high, self.tilt = (float(window[key]) for key in ("low", "high", "tilt"))
        self.size = int(window["per_unit"])
        self.cells = np.array(
            [
                (int(slip), level)
                for slip, flat in window["columns"].items()
                for start, end in zip(flat[::2], flat[1::2], strict=True)
                for level in range(start, end)
            ]
        )
        self.codes = np.sort(self._code(self.cells[:, 0], self.cells[:, 1]))

    def _code(self, slip: Any, level: Any) -> Any:
        return slip.astype(np.int64) * 2**32 + level.astype(np.int64)

    def holds(self, slip: Any, level: Any) -> Any:
        """Whether states are in the set; those on an edge by rounding count as inside."""
        found = np.zeros(np.shape(slip), bool)
        for dx in (-1e-7, 1e-7):
            for dy in (-1e-7, 1e-7):
                code = self._code(np.floor(slip * self.size + dx), np.floor(level * self.size + dy))
                place = np.minimum(np.searchsorted(self.codes, code), len(self.codes) - 1)
                found |= self.codes[place] == code
        return found


def _stays(case: Case, stated: Stated, names: tuple[str, ...], windows: list[Cells]) -> Attack:
    def margin(x: Points) -> Any:
        plant, full = plant_at(case, x), case.model.max_torque
        index = np.minimum((x["window"] * len(windows)).astype(int), len(windows) - 1)
        result = np.full(np.shape(x["window"]), np.inf)
        for k in np.unique(index):
            here, chosen = windows[k], index == k
            cell = here.cells[np.minimum((x["cell"] * len(here.cells)).astype(int), len(here.cells) - 1)]
            slip = (cell[:, 0] + x["along"]) / here.size
            level = (cell[:, 1] + x["across"]) / here.size
            share = level - here.tilt * (slip - case.slip)
            chosen = chosen & (share >= 0.0) & (share <= 1.0)  # others are torques that no brake has
            speed = here.low + (here.high - here.low) * x["place"]
            state = motion.wheels(slip, speed, np.clip(share, 0.0, 1.0) * full)
            duty = feedback_duty(case, slip, speed, state.torque)
            motion.pulse(plant, state, duty, case.sample_time, steps=8, frozen=False)
            inside = state.speed < windows[-1].low  # below the lowest window nothing is said
            for each in windows:
                moved = state.torque / full + each.tilt * (state.slip - case.slip)
                within = (state.speed >= each.low) & (state.speed <= each.high)
                inside |= within & each.holds(state.slip, moved)
            distance = abs(state.slip - case.slip)
            result = np.where(chosen, np.where(inside, 1.0 - distance, -distance - 1e-3), result)
        return result

    return Attack(
        check=stated.check,
        statement="a sample maps the sets of slip and torque into themselves",
        box=box(
            case,
            names,
            window=(0.0, 1.0),
            cell=(0.0, 1.0),
            along=(0.0, 1.0),
            across=(0.0, 1.0),
            place=(0.0, 1.0),
        ),
        margin=margin,
        cost=20,
    )
