"""Whether a law of a user is the one that it declares: its traced step against the declared numbers, written out.

The law says its numbers and what its state means (:mod:`wspd_design.controllers.observer_form`). Compared is what it
makes of that and what it commands, where the band of slip needs it: all sensors healthy, the demanded pressure
there, speeds of the range, friction and torque above zero, pulses within one sample, the error below the braking curve.
Elsewhere the law may do what it wants. All combinations of wheelsets that fill and that vent are gone through, and the
start from rolling wheels with every scale of the speed that the box asks for.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from math import ceil, inf, isclose
from typing import Any, TypeAlias

from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.graph_field import UndecidedError
from wspd_design.certificates.setting.graph_in_region import POINTS, Known, Value, values
from wspd_design.codegen.gains import Gain, with_gains
from wspd_design.codegen.sampled import flat, measurement_of
from wspd_design.controllers.observer_form import Observed, ObservedWheelset, ObserverForm
from wspd_design.controllers.protocol import VehicleMeasurement
from wspd_design.model.number import Number, exp, log, sqrt

LEAST = Fraction(2, 1000)
"""Of the full torque: above it a law may take a logarithm as it is."""
SETTLED = 2.0  # s, after which observer and filter have settled
SLOWING, NUDGE, WOBBLE = 0.4, 0.02, 1e-3  # m/s2, -, rad/s: of the states that signs are looked at
MISTOLD = 0.01  # -, more than the noise that a band bears makes of the lowest speed
DIGITS = 1e-9  # relative, what rounding may make of a number
FILL, VENT = 1, -1

Numbers: TypeAlias = dict[str, Number]
Range: TypeAlias = tuple[float, float]


@dataclass(frozen=True, slots=True)
class _Graphs:
    """What a law does, what the declared one does, and quantities of which the range is known."""

    names: tuple[str, ...]  # of the numbers that are compared
    own: Any
    declared: Mapping[int, Any]  # by the way of the valves of all wheelsets
    known_names: tuple[str, ...]
    known: Any


@dataclass(frozen=True, slots=True)
class _Traced:
    start: _Graphs  # functions of (measurement, gains)
    step: _Graphs  # of (state, measurement, gains)
    gains: tuple[float, ...]


def not_declared(law: Any, problem: Problem, slips: Range) -> str:
    """Say in what a law differs from the one that it declares; empty if it does not.

    Parameters
    ----------
    law : TorqueObserver
        With ``start`` and ``step`` of a law of a vehicle.
    problem : Problem
        Its ranges of speed and of the radius of the wheels.
    slips : tuple of float
        Least and largest slip that the reference has.
    """
    try:
        traced = _traced(law)
        return _in_start(traced, law, problem) or _in_step(traced, law, problem, slips)
    except UndecidedError as reason:
        return f"has a step without a value for some numbers ({reason})"
    except Exception as reason:  # the user's code may fail in any way
        return f"cannot be compared with the numbers that it declares ({type(reason).__name__}: {reason})"


def _traced(law: Any) -> _Traced:
    """Trace with the floats of the law as inputs, so that no product of them is rounded."""
    import casadi as ca

    found: list[float] = []
    with_gains(law, found.append)
    gains = ca.SX.sym("gains", len(found))
    places = iter(range(len(found)))
    law = with_gains(law, lambda value: Gain(float(value), gains[next(places)]))
    form = law.observer_form
    m = ca.SX.sym("m", len(flat(_measured(form, [0.0] * law.wheelsets, 0.0, [0.0] * law.wheelsets))))
    seen = measurement_of(m.elements(), law.wheelsets)
    initial = law.start(seen)
    state = ca.SX.sym("state", len(initial))
    before = law.observed(tuple(state.elements()))
    following, commands = law.step(tuple(state.elements()), seen)
    asked = dict(enumerate(commands, start=1))
    own = {_fill(k): each.fill for k, each in asked.items()} | {
        _vent(k): each.vent for k, each in asked.items()
    }
    own = _named(law.observed(following), own)
    samples = {way: _sample(form, law.sample_time, before, seen, way) for way in (FILL, VENT)}
    begun, scaled = _begun(form, seen)
    return _Traced(
        start=_graphs([m, gains], _named(law.observed(initial)), {FILL: begun}, scaled),
        step=_graphs(
            [state, m, gains], own, {way: each for way, (each, _) in samples.items()}, samples[FILL][1]
        ),
        gains=tuple(map(float, found)),
    )


def _graphs(inputs: Sequence[Any], own: Numbers, declared: Mapping[int, Numbers], known: Numbers) -> _Graphs:
    import casadi as ca

    def function(numbers: Sequence[Number]) -> Any:
        return ca.Function("numbers", list(inputs), [ca.vertcat(*(ca.SX(each) for each in numbers))])

    return _Graphs(
        names=tuple(own),
        own=function(list(own.values())),
        declared={way: function([each[name] for name in own]) for way, each in declared.items()},
        known_names=tuple(known),
        known=function(list(known.values())),
    )


def _fill(wheelset: int) -> str:
    return f"share of filling of wheelset {wheelset}"


def _vent(wheelset: int) -> str:
    return f"share of venting of wheelset {wheelset}"


def _named(observed: Observed, commands: Numbers | None = None) -> Numbers:
    """Give what is compared its names, in an order in which a number comes after those that it follows from."""
    found = {
        "scale of the train speed": observed.scale,
        "train speed": observed.speed,
        "acceleration of the train": observed.acceleration,
    }
    for k, each in enumerate(observed.wheelsets, start=1):
        found[f"observed speed of wheelset {k}"] = each.speed
        found[f"observed friction torque of wheelset {k}"] = each.friction_torque
    found |= commands or {}
    for k, each in enumerate(observed.wheelsets, start=1):
        found[f"mean torque of wheelset {k}"] = each.mean_torque
    return found


def _begun(form: ObserverForm, seen: VehicleMeasurement) -> tuple[Numbers, Numbers]:
    """Start with rolling wheels."""
    scale = form.wheel_radius * seen.wheel_speeds[0] / seen.speed
    torques = [pressure * form.full_torque / form.full_pressure for pressure in seen.pressures]
    wheelsets = tuple(map(ObservedWheelset, seen.wheel_speeds, torques, torques))
    begun = Observed(scale * seen.speed, 0.0, scale, wheelsets)
    return _named(begun), {"told": seen.speed, "scale": scale, "speed": scale * seen.speed}


def _sample(
    form: ObserverForm, h: Number, before: Observed, seen: VehicleMeasurement, way: int
) -> tuple[Numbers, Numbers]:
    """One sample of the declared law in which the valves of all wheelsets fill, or vent; and what is known there."""
    speed = before.scale * seen.speed
    new = 1.0 - exp(-h / form.acceleration_time)
    acceleration = before.acceleration + new * ((speed - before.speed) / h - before.acceleration)
    slip = form.slip / sqrt(speed) if form.falls else form.slip
    wanted_speed = (1.0 - slip) * speed / form.wheel_radius
    wanted_rate = (1.0 - (slip / 2.0 if form.falls else slip)) * acceleration / form.wheel_radius
    inertia, theta, available = (
        form.wheelset_inertia,
        exp(-form.observer_rate * h),
        seen.demand * form.full_torque,
    )
    known: Numbers = {
        "demand": seen.demand,
        "told": seen.speed,
        "speed": speed,
        "slip": slip,
        "available": available,
    }
    commands: Numbers = {}
    wheelsets = []
    for k, (was, wheel, pressure) in enumerate(
        zip(before.wheelsets, seen.wheel_speeds, seen.pressures, strict=True), start=1
    ):
        expected = was.speed + h * (was.friction_torque - was.mean_torque) / inertia
        r = wheel - expected
        tau = was.friction_torque + inertia * (1.0 - theta) ** 2 * r / h
        torque = pressure * form.full_torque / form.full_pressure
        error = wheel - wanted_speed + form.ahead * h * ((tau - torque) / inertia - wanted_rate)
        target = tau - inertia * (wanted_rate - form.approach_rate * error)
        room, left = available - torque, available - target
        fill = form.time_share * form.fill_time * log(room / left) / h
        vent = form.time_share * form.vent_time * log(torque / target) / h
        if way == FILL:
            end = exp(-fill * h / form.fill_time)
            mean = available - room * (form.fill_time / h * (1.0 - end) + (1.0 - fill) * end)
        else:
            end = exp(-vent * h / form.vent_time)
            mean = torque * (form.vent_time / h * (1.0 - end) + (1.0 - vent) * end)
        wheelsets.append(ObservedWheelset(expected + (1.0 - theta**2) * r, tau, mean))
        commands |= {_fill(k): fill if way == FILL else 0.0, _vent(k): vent if way == VENT else 0.0}
        known |= {f"way {k}": target - torque, f"pulse {k} of filling": fill, f"pulse {k} of venting": vent}
        known |= {f"torque {k}": torque, f"torque {k} wanted": target}
        known |= {f"torque {k} left": room, f"torque {k} left when wanted": left, f"friction {k}": tau}
        known |= {f"sliding {k}": speed - form.wheel_radius * wheel, f"error {k}": error}
    return _named(Observed(speed, acceleration, before.scale, tuple(wheelsets))) | commands, known


def _range(name: str, form: ObserverForm, problem: Problem, slips: Range, ways: Sequence[int]) -> Range:
    """Range of what is known in a sample."""
    kind, _, rest = name.partition(" ")
    full, least = float(form.full_torque), float(LEAST * Fraction(form.full_torque))
    worn, told = problem.span("wheel radius"), _told(form, problem)
    match kind:
        case "told":
            return told
        case "speed":
            return told[0] * form.wheel_radius / worn[1], told[1] * form.wheel_radius / worn[0]
        case "slip":
            return slips
        case "demand":
            return 0.0, 1.0
        case "available":
            return 0.0, full
        case "torque":
            return least, full - least
        case "error":
            slew = form.torque_slew
            return -inf, inf if slew is None else slew / form.wheelset_inertia / form.approach_rate**2
        case "way" | "pulse":
            number, _, valve = rest.partition(" of ")
            way = ways[int(number) - 1] * (-1 if valve == "venting" else 1)
            longest = 1.0 if kind == "pulse" else inf
            return (0.0, longest) if way == FILL else (-inf, 0.0)
        case _:  # friction and sliding
            return 0.0, inf


def _measured(
    form: ObserverForm, wheels: Sequence[float], speed: float, torques: Sequence[float], demand: float = 1.0
) -> VehicleMeasurement:
    pressures = tuple(each / form.full_torque * form.full_pressure for each in torques)
    return VehicleMeasurement(
        speed=speed,
        wheel_speeds=tuple(wheels),
        torques=tuple(torques),
        healthy=(1.0,) * len(wheels),
        pressures=pressures,
        acceleration=-SLOWING,
        demand=demand,
        reservoir=form.full_pressure,
    )


def _inputs(seen: Sequence[VehicleMeasurement], gains: Sequence[float]) -> list[list[Value]]:
    """Measurements with healthy sensors and numbers of the law; all else is free."""
    fixed = flat(seen[0]._replace(speed=None, demand=None, acceleration=None, reservoir=None))
    count = len(seen[0].healthy)
    numbers = [flat(each) for each in seen]
    measured = []
    for k in range(len(fixed)):
        name = 0 if k < count else k  # one train speed is told to all
        whole = 3 * count <= k < 4 * count
        free = Value.free([each[k] for each in numbers], "measured", name)
        measured.append(Value.of(1.0) if whole else free)
    return [measured, [Value.of(each) for each in gains]]


def _in_start(traced: _Traced, law: Any, problem: Problem) -> str:
    """Compare the starts with wheels that roll without a brake, smaller than the nominal ones or larger."""
    form, graphs = law.observer_form, traced.start
    worn = problem.span("wheel radius")
    scales = form.wheel_radius / worn[1], form.wheel_radius / worn[0]
    for low, high in ((scales[0], min(1.0, scales[1])), (max(1.0, scales[0]), scales[1])):
        if low >= high:
            continue
        inner = [low + (high - low) * (k + 1) / (POINTS + 1) for k in range(POINTS)]
        seen = []
        for k, scale in enumerate(inner):
            speed = _speed(problem, k)
            wheel = scale * speed / form.wheel_radius
            seen.append(
                _measured(form, [wheel] * law.wheelsets, speed, [form.full_torque / 4.0] * law.wheelsets, 0.0)
            )
        inputs = _inputs(seen, traced.gains)
        measured = inputs[0]
        for k in range(law.wheelsets, 2 * law.wheelsets):
            measured[k] = measured[law.wheelsets]  # all roll alike
        measured[-2] = Value.of(0.0)
        (known,) = values(graphs.known, inputs, ())
        told = _told(form, problem)
        ends = {"told": told, "scale": (low, high), "speed": (low * told[0], high * told[1])}
        facts = [Known(value, *ends[name]) for name, value in zip(graphs.known_names, known, strict=True)]
        found = _difference(graphs, FILL, inputs, facts, None)
        if found:
            return f"{found}, when it starts on wheels of {form.wheel_radius / inner[1]:.3g} m that roll"
    return ""


def _in_step(traced: _Traced, law: Any, problem: Problem, slips: Range) -> str:
    """Compare the steps for all ways of the valves."""
    form, graphs, count = law.observer_form, traced.step, law.wheelsets
    settled = [_settled(law, problem, number) for number in range(POINTS)]
    states = [
        Value.free(numbers, "state", k)
        for k, numbers in enumerate(zip(*(state for state, _ in settled), strict=True))
    ]
    for ways in product((FILL, VENT), repeat=count):
        seen = []
        for _, measured in settled:
            nudged = [each * (1.0 - NUDGE * way) for each, way in zip(measured.pressures, ways, strict=True)]
            torques = [each * form.full_torque / form.full_pressure for each in nudged]
            seen.append(measured._replace(pressures=tuple(nudged), torques=tuple(torques)))
        inputs = [states, *_inputs(seen, traced.gains)]
        (known,) = values(graphs.known, inputs, ())
        facts = [
            Known(value, *_range(name, form, problem, slips, ways))
            for name, value in zip(graphs.known_names, known, strict=True)
        ]
        for name, fact in zip(graphs.known_names, facts, strict=True):
            if not all(fact.low <= real <= fact.high for real in fact.value.real):
                return f"is not found to hold its reference: {name} is {fact.value.real[0]:.4g} once it has settled"
        found = _difference(graphs, FILL, inputs, facts, ways)
        if found:
            return found
    return ""


def _difference(
    graphs: _Graphs,
    way: int,
    inputs: Sequence[Sequence[Value]],
    known: Sequence[Known],
    ways: Sequence[int] | None,
) -> str:
    """Name the first number that is another one than declared."""
    (own,) = values(graphs.own, inputs, known)
    declared = {key: values(each, inputs, ())[0] for key, each in graphs.declared.items()}
    for k, name in enumerate(graphs.names):
        *_, number = name.split()
        wanted = declared[ways[int(number) - 1] if ways and number.isdigit() else way][k]
        if own[k].field == wanted.field:
            continue
        apart = next(
            (
                pair
                for pair in zip(own[k].real, wanted.real, strict=True)
                if not isclose(*pair, rel_tol=DIGITS)
            ),
            None,
        )
        if apart is None:
            return (
                f"gives the {name} of the law that it declares only for numbers that were tried, or but for rounding: "
                "what stands in step must be worked out there from the declared numbers, and branch no further"
            )
        return f"gives {apart[0]:.6g} for the {name}, and the law that it declares {apart[1]:.6g}"
    return ""


def _told(form: ObserverForm, problem: Problem) -> Range:
    """Train speeds that may be told in the range of the claim [m/s]."""
    wrong = MISTOLD + form.slip_error / (1.0 - form.slip)
    return (1.0 - wrong) * problem.speeds[0], (1.0 + wrong) * problem.speeds[1]


def _speed(problem: Problem, number: int) -> float:
    low, high = problem.speeds
    return float(low * (high / low) ** ((number + 1.0) / (POINTS + 1.0)))


def _settled(law: Any, problem: Problem, number: int) -> tuple[Sequence[float], VehicleMeasurement]:
    """State of a law that has held its reference for some time, and what it sees next."""
    form, h = law.observer_form, law.sample_time
    samples = ceil(SETTLED / h)
    worn = problem.span("wheel radius")
    radius = worn[1] + (worn[0] - worn[1]) * number / POINTS / 2.0
    speed = _speed(problem, number) + SLOWING * h * samples
    torques = [form.full_torque * (0.3 + 0.02 * number + 0.01 * k) for k in range(law.wheelsets)]
    rolling = [speed / radius] * law.wheelsets
    state = law.start(_measured(form, rolling, speed, torques, 0.0))
    for sample in range(samples + 1):
        seen_speed = form.wheel_radius / radius * speed
        slip = form.slip / sqrt(seen_speed) if form.falls else form.slip
        wheels = [(1.0 - slip) * speed / radius + WOBBLE * (1.0 + number + k) for k in range(law.wheelsets)]
        measured = _measured(form, wheels, speed, torques)
        if sample < samples:
            state, _ = law.step(state, measured)
            speed -= SLOWING * h
    return tuple(map(float, state)), measured
