"""The sampled loop of the step that runs, at a frozen train speed: where it rests, and what one sample makes there.

The plant is that of a wheelset on the quarter model. Within a sample its slip follows s' = F + p (s - s_k) + G T from
the drift F, the pole p and the gain G at the sampled slip s_k, and the torque T fills, vents and holds as it is
commanded, eq. (9) under full demand. A law of a vehicle commands as many such wheelsets as it has. The step is the
graph of the law itself: no law is written out here a second time.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.traced_law import TracedLaw, state_names
from wspd_design.codegen.sampled import flat
from wspd_design.controllers.offers import slip_reference_of
from wspd_design.controllers.protocol import VehicleMeasurement
from wspd_design.model.generated.slip import wheel_speed_at_slip
from wspd_design.model.number import Number
from wspd_design.model.slip import slip_dynamics

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

SETTLED = 1e-9  # of a residual, in multiples of the usual size of each number
NEWTON_STEPS = 30
WARM_SAMPLES = (0, 1, 100)  # for which the memory is let run at the reference before a rest is looked for
HALVINGS = 12  # of a step that makes it worse
NUDGE = 1e-6  # by which numbers are moved, likewise, to see whether the loop has a slope at its rest
KINK = 1e-3  # share of a nudge by which the loop may depart from its slopes
LEAST_RATE = 1e-7  # 1/s, a pole or sum of rates nearer to 0 is taken for this one
SAME = 1e-7  # what is smaller counts as 0: singular values, slopes
LEAST_SLIP = 1e-6  # by which the search stays off rolling and locked wheels


@dataclass(frozen=True, slots=True, kw_only=True)
class Rest:
    """A state that one sample leaves as it is, and the slopes there.

    States: slips, torques over the full one, memory. The commands are the shares of filling and of venting of the
    first wheelset.
    """

    speed: float  # m/s
    slip: float  # -, of the first wheelset
    closed: "Array"  # what one sample makes of a small deviation
    opened: "Array"  # the same with the commands held
    entered: "Array"  # what the commands make of the state
    commanded: "Array"  # what the state makes of the commands
    free: int  # directions along which the loop rests, too
    without_effect: tuple[str, ...]  # memory without a slope, which nothing else follows to first order

    @property
    def poles(self) -> "NDArray[np.complex128]":
        """Poles of the closed loop, without those of the directions along which it rests, too."""
        return poles(self.closed, self.free)

    @property
    def radius(self) -> float:
        """Largest magnitude of these poles; 0 without any."""
        return float(max(abs(self.poles), default=0.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class NoRest:
    """Why nothing is said about small deviations at a speed, as a clause after "it"."""

    reason: str
    detail: str = ""


class TracedLoop:
    """One sample of the loop of a problem, as a function of state and train speed, with its slopes by CasADi."""

    def __init__(self, problem: Problem, law: TracedLaw) -> None:
        import casadi as ca

        self.problem, self.law = problem, law
        self.wheelsets = count = law.wheelsets or 1
        state, pole, speed = ca.SX.sym("x", 2 * count + law.states), ca.SX.sym("p"), ca.SX.sym("v")
        commands = ca.SX.sym("u", 2 * count)
        slips, shares = state[:count].elements(), state[count : 2 * count].elements()
        seen = ca.vertcat(*self._seen(slips, shares, speed))
        decided = law.step(state[2 * count :], seen)
        following, wanted = decided[: law.states], decided[law.states :]
        moved = [
            _one_sample(problem, speed, pole, slips[k], shares[k], commands[k], commands[count + k])
            for k in range(count)
        ]
        after = ca.vertcat(*(slip for slip, _ in moved), *(share for _, share in moved), following)
        inputs = [state, commands, pole, speed]
        closed = ca.Function("closed", inputs, [after])(state, wanted, pole, speed)
        slopes = [ca.jacobian(after, state), ca.jacobian(after, commands), ca.jacobian(wanted, state)]
        place = [state, pole, speed]
        self._after = ca.Function("after", place, [closed])
        self._slopes = ca.Function("slopes", place, [ca.jacobian(closed, state)])
        self._commands = ca.Function("commands", place, [wanted])
        self._parts = ca.Function("parts", inputs, slopes)

    def rest(self, speed: float) -> Rest | NoRest:
        """Find where the loop rests near its reference at a train speed [m/s], and its slopes there."""
        problem = self.problem
        held = self._held_share(speed)
        if not 0.0 <= held <= 1.0:
            return NoRest(
                reason="needs a torque that the brake does not have", detail=f"{held:.3g} of the full one"
            )
        stuck: list[str] = []
        low, high = problem.near
        for state in self._starts(speed, held):
            found = self._settled(state, speed)
            if isinstance(found, str):
                stuck.append(found)
            elif low <= found[0] <= high:
                return self._with_slopes(found, speed)
            else:
                stuck.append(f"it rests at slip {found[0]:.3g}")
        return NoRest(reason="was not found to rest", detail=stuck[0])

    def _held_slip(self) -> float:
        return slip_reference_of(self.problem.controller) or self.problem.slip

    def _held_share(self, speed: float) -> float:
        """Share of the full torque that holds the reference."""
        problem = self.problem
        plant = slip_dynamics(problem.vehicle, problem.rail, self._held_slip(), speed)
        return float(-plant.drift / plant.gain / problem.vehicle.brake.max_torque)

    def _seen(self, slips: Sequence[Number], shares: Sequence[Number], speed: Number) -> list[Number]:
        """Return what the law measures, on symbols or floats."""
        problem = self.problem
        vehicle, brake = problem.vehicle, problem.vehicle.brake
        wheels = tuple(wheel_speed_at_slip(slip, speed, vehicle.wheel_radius) for slip in slips)
        torques = tuple(brake.max_torque * share for share in shares)
        if self.law.wheelsets is None:
            return [speed, wheels[0], torques[0]]
        slowing = [slip_dynamics(vehicle, problem.rail, slip, speed).deceleration for slip in slips]
        told = VehicleMeasurement(
            speed=speed,
            wheel_speeds=wheels,
            torques=torques,
            healthy=(1.0,) * self.wheelsets,
            pressures=tuple(brake.max_pressure * share for share in shares),
            acceleration=-sum(slowing) / self.wheelsets,
            demand=1.0,
            reservoir=brake.reservoir_pressure or brake.supply_pressure,
        )
        return list(flat(told))

    def _starts(self, speed: float, share: float) -> "Iterator[Array]":
        """Yield states from which a rest is looked for: at the reference, with the torque that holds it."""
        import numpy as np

        count, states = self.wheelsets, self.law.states
        place = [self._held_slip()] * count + [share] * count
        seen = [float(each) for each in self._seen(place[:count], place[count:], speed)]
        memory, done = _numbers(self.law.start(seen)), 0
        for samples in WARM_SAMPLES:
            for _ in range(samples - done):
                memory = _numbers(self.law.step(memory, seen))[:states]
            done = samples
            yield np.array([*place, *memory], dtype=np.float64)

    def _settled(self, state: "Array", speed: float) -> "Array | str":
        """Look for a state that one sample leaves as it is; else say what moves on."""
        import numpy as np

        size = np.maximum(1.0, np.abs(state))
        missing = self._missing(state, speed, size)
        for _ in range(NEWTON_STEPS):
            if not np.all(np.isfinite(missing)):
                return "it gives a number that is not finite"
            if np.max(np.abs(missing)) <= SETTLED:
                return state
            slopes = _matrix(self._slopes(state, self._pole(state, speed), speed))
            slopes = np.nan_to_num(slopes, posinf=0.0, neginf=0.0)
            matrix = (slopes - np.eye(len(state))) * size / size[:, np.newaxis]
            step = size * np.linalg.lstsq(matrix, -missing, rcond=1e-12)[0]
            for _ in range(HALVINGS):
                trial = state + step
                trial[: self.wheelsets] = np.clip(trial[: self.wheelsets], LEAST_SLIP, 1.0 - LEAST_SLIP)
                left = self._missing(trial, speed, size)
                if np.linalg.norm(left) < np.linalg.norm(missing):
                    break
                step = step / 2.0
            else:
                break
            state, missing = trial, left
        return f"{self._name(int(np.argmax(np.abs(missing))))} moves on from sample to sample"

    def _missing(self, state: "Array", speed: float, size: "Array") -> "Array":
        """What one sample changes, in multiples of the usual size of each number."""
        after = _numbers(self._after(state, self._pole(state, speed), speed))
        changed: Array = (after - state) / size
        return changed

    def _name(self, place: int) -> str:
        count = self.wheelsets
        if place < 2 * count:
            return "the slip" if place < count else "the torque"
        return state_names(self.problem.controller, self.law.states)[place - 2 * count]

    def _pole(self, state: "Array", speed: float) -> float:
        """Slip pole of the first wheelset, kept off the rates at which the closed forms divide by 0 [1/s]."""
        problem = self.problem
        brake = problem.vehicle.brake
        pole = float(slip_dynamics(problem.vehicle, problem.rail, float(state[0]), speed).pole)
        for rate in (0.0, 1.0 / brake.fill_time, 1.0 / brake.vent_time):
            if abs(pole + rate) < LEAST_RATE:
                pole = LEAST_RATE - rate
        return pole

    def _with_slopes(self, state: "Array", speed: float) -> Rest | NoRest:
        import numpy as np

        pole = self._pole(state, speed)
        closed = _matrix(self._slopes(state, pole, speed))
        if not np.all(np.isfinite(closed)):
            return NoRest(reason="has no slope where it rests", detail=f"slip {state[0]:.3g}")
        bent = self._bent(state, closed, pole, speed)
        following = np.abs(closed - np.diag(np.diag(closed))).max(axis=0)
        if any(place < 2 * self.wheelsets or following[place] > SAME for place in bent):
            return NoRest(reason="switches where it rests", detail=f"slip {state[0]:.3g}")
        wanted = _numbers(self._commands(state, pole, speed))
        _, entered, commanded = map(_matrix, self._parts(state, wanted, pole, speed))
        if not commanded.any():
            return NoRest(
                reason="rests with commands that answer no small deviation", detail=f"slip {state[0]:.3g}"
            )
        first = [0, self.wheelsets]
        opened = closed - entered[:, first] @ commanded[first]
        values = np.linalg.svd(closed - np.eye(len(closed)), compute_uv=False)
        return Rest(
            speed=speed,
            slip=float(state[0]),
            closed=closed,
            opened=opened,
            entered=entered[:, first],
            commanded=commanded[first],
            free=int(np.sum(values < SAME)),
            without_effect=tuple(self._name(place) for place in sorted(bent)),
        )

    def _bent(self, state: "Array", closed: "Array", pole: float, speed: float) -> set[int]:
        """Places of the numbers that do not follow their slopes on all sides of a state."""
        import numpy as np

        size, most = np.maximum(1.0, np.abs(state)), max(1.0, float(np.max(np.abs(closed))))
        after = _numbers(self._after(state, pole, speed))
        bent: set[int] = set()
        for place in range(len(state)):
            for side in (-NUDGE, NUDGE):
                moved = np.zeros(len(state))
                moved[place] = side * size[place]
                off = (_numbers(self._after(state + moved, pole, speed)) - after - closed @ moved) / size
                bent |= set(np.flatnonzero(~(np.abs(off) <= KINK * NUDGE * most)).tolist())
        return bent


def poles(matrix: "Array", free: int) -> "NDArray[np.complex128]":
    """Eigenvalues of a matrix without so many of those that are nearest to 1."""
    import numpy as np

    found = np.linalg.eigvals(matrix).astype(np.complex128)
    return np.delete(found, np.argsort(np.abs(found - 1.0))[:free])


def _one_sample(
    problem: Problem, speed: Number, pole: Number, slip: Number, share: Number, fill: Number, vent: Number
) -> tuple[Number, Number]:
    """Slip and share of T_max after a sample that fills, then vents, then holds; on symbols of CasADi."""
    import casadi as ca

    brake, h = problem.vehicle.brake, problem.sample_time
    filling, venting = 1.0 / brake.fill_time, 1.0 / brake.vent_time
    plant = slip_dynamics(problem.vehicle, problem.rail, slip, speed)

    def kept(rate: Number, span: Number) -> Number:
        """Integral of exp(-rate s) from 0 to a span."""
        return -ca.expm1(-rate * span) / rate

    first, second = fill * h, vent * h
    crest = 1.0 - (1.0 - share) * ca.exp(-filling * first)
    foot = crest * ca.exp(-venting * second)
    filled = kept(pole, first) - (1.0 - share) * kept(pole + filling, first)
    vented = ca.exp(-pole * first) * crest * kept(pole + venting, second)
    held = ca.exp(-pole * (first + second)) * foot * kept(pole, h - first - second)
    pulled = ca.exp(pole * h) * (filled + vented + held)
    return slip + plant.drift * ca.expm1(pole * h) / pole + plant.gain * brake.max_torque * pulled, foot


def _numbers(found: Any) -> "Array":
    import numpy as np

    return np.array(found, dtype=np.float64).ravel()


def _matrix(found: Any) -> "Array":
    import numpy as np

    return np.array(found, dtype=np.float64)
