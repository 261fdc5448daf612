"""How much the loop near its reference bears: gain, phase, delay and disk margin over speed, also as sampled."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.checks.linear.disk_margin import crossings, disk_margin
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Obligation
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.search.settle import finding
from wspd_design.certificates.setting.linear_loop import law_of, on_brake, valve
from wspd_design.certificates.setting.pulsed_valve import Times, sample_of
from wspd_design.certificates.setting.traced_loop import poles
from wspd_design.certificates.theorems.linear import MARGINS_THEOREM, SPEEDS, decibel
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

MOST_GAIN, MOST_DELAY = 1e3, 10.0  # larger margins are reported as these: factor, s


class Loop(NamedTuple):
    """A loop with one input and one output, opened there; its D is zero, since the brake lags."""

    A: "Array"
    B: "Array"
    C: "Array"
    dt: float  # s, sample time; 0 if it is continuous


@dataclass(frozen=True, slots=True, kw_only=True)
class Margins:
    """What a loop bears at its valve command; all zero for a loop that is unstable as it is."""

    stable: bool
    gain_up: float  # factor that the loop gain bears, above 1
    gain_down: float  # factor below 1
    phase: float  # rad
    delay: float  # s
    disk: float  # -, balanced disk margin, at most 2


UNSTABLE = Margins(stable=False, gain_up=1.0, gain_down=1.0, phase=0.0, delay=0.0, disk=0.0)


def search(problem: Problem) -> Mapping[str, Stated]:
    """Work out the margins at speeds over the range; where a loop is unstable, show it exactly."""
    import numpy as np

    speeds = np.geomspace(*problem.speeds, SPEEDS)
    kinds = {"continuous": _over_speed(problem, sampled=False), "sampled": _over_speed(problem, sampled=True)}
    wanted = {each.key: each for each in MARGINS_THEOREM.obligations(problem)}
    stated = {}
    for key, found in kinds.items():
        for speed, each in zip(speeds, found, strict=True):
            if not each.stable and (shown := _shown(wanted[key], float(speed))) is not None:
                stated[key] = shown
                break
    worst, k = min(
        ((each, k) for found in kinds.values() for k, each in enumerate(found)), key=lambda x: x[0].disk
    )
    numbers = {
        "speed": float(speeds[k]),
        "gain up": worst.gain_up,
        "gain down": worst.gain_down,
        "phase": worst.phase,
        "delay": worst.delay,
        "disk": worst.disk,
    }
    return stated | {"margins": Stated(numbers=numbers)}


def _over_speed(problem: Problem, *, sampled: bool) -> list[Margins]:
    import numpy as np

    span = problem.sample_time if sampled else None
    return [margins(loop(problem, float(v), sample_time=span)) for v in np.geomspace(*problem.speeds, SPEEDS)]


def _shown(obligation: Obligation, speed: float) -> Stated | None:
    stated = Stated(place={"speed": speed})
    try:
        finding(obligation, stated)
    except Refused:
        return None
    return stated


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - samples of the nominal loop
    """Margins over speed."""
    import numpy as np

    speeds, x = np.geomspace(*problem.speeds, SPEEDS), "speed [km/h]"
    kinds = [(kind, _over_speed(problem, sampled=kind == "sampled")) for kind in ("continuous", "sampled")]
    return Figures(
        series=(
            *(series(name, x, "disk margin [-]", speeds * KMH, _of(found, "disk")) for name, found in kinds),
            *(
                series(name, x, "phase margin [deg]", speeds * KMH, np.degrees(_of(found, "phase")))
                for name, found in kinds
            ),
            *(
                series(name, x, "delay margin [s]", speeds * KMH, _of(found, "delay"))
                for name, found in kinds
            ),
            level("half a sample", x, "delay margin [s]", speeds * KMH, problem.sample_time / 2.0),
        ),
        remark=f"Sampled at {SPEEDS} speeds; gain margins beyond {decibel(MOST_GAIN):.0f} dB and delay margins beyond "
        f"{MOST_DELAY:.0f} s are given as these.",
    )


def loop(problem: Problem, speed: float, *, sample_time: float | None = None) -> Loop:
    """Loop opened at the valve command, to be closed by negative feedback.

    Parameters
    ----------
    problem : Problem
        With the nominal plant.
    speed : float
        Train speed [m/s].
    sample_time : float, optional
        Loop sampled with its pulses, and the integrals of the law as they are summed [s].

    Returns
    -------
    Loop
        From duty to duty: first the states of slip and brake, then what the law has summed.
    """
    import numpy as np

    law, brake = law_of(problem), problem.vehicle.brake
    dynamics = slip_dynamics(problem.vehicle, problem.rail, problem.slip, speed)
    gain, limit = dynamics.gain, brake.max_torque
    share = float(-dynamics.drift / gain / limit)
    rates = valve(brake.fill_time, brake.vent_time, share)
    gains = on_brake(law, law.linear_form(speed), limit)
    if sample_time is None:
        a = np.array([[dynamics.pole, gain * limit], [0.0, -rates.decay]])
        b = np.array([[0.0], [rates.rate]])
    else:
        duty = Fraction(share / brake.vent_time / rates.rate)
        fill, vent, pole = (Fraction(float(x)) for x in (brake.fill_time, brake.vent_time, dynamics.pole))
        ends = sample_of(Times((fill, fill), (vent, vent)), (pole, pole), Fraction(sample_time), (duty, duty))
        kept, forced, held, moved, delay = (float(low) for low, _ in ends)
        a = np.array([[kept, gain * limit * forced], [0.0, held]])
        b = np.array([[gain * limit * moved * delay], [moved]])
    direct = np.array([[gains.proportional / limit, gains.torque]])
    summed = np.array([[gains.integral / limit, gains.twice / limit]])
    if not np.any(summed):
        return Loop(a, b, direct, sample_time or 0.0)
    step = sample_time or 1.0
    chain = np.array([[0.0, 0.0], [step, 0.0]]) + (np.eye(2) if sample_time else 0.0)
    fed = np.array([[step, 0.0], [0.0, 0.0]])
    size = 2 if summed[0, 1] else 1
    whole = np.block([[a, np.zeros((2, size))], [fed[:size], chain[:size, :size]]])
    enters, leaves = np.vstack([b, np.zeros((size, 1))]), np.hstack([direct, summed[:, :size]])
    return Loop(whole, enters, leaves, sample_time or 0.0)


def growths_per_sample(problem: Problem) -> list[tuple[float, float]]:
    """Return the largest magnitude of a sampled pole at each speed of the check, and the speed [-, m/s]."""
    import numpy as np

    def magnitude(speed: float) -> float:
        opened = loop(problem, speed, sample_time=problem.sample_time)
        return float(np.abs(np.linalg.eigvals(opened.A - opened.B @ opened.C)).max())

    return [(magnitude(float(speed)), float(speed)) for speed in np.geomspace(*problem.speeds, SPEEDS)]


def margins(opened: Loop, free: int = 0) -> Margins:
    """Margins of a loop, from its poles before and after feedback [factors, rad, s].

    Parameters
    ----------
    opened : Loop
        The loop, sampled or continuous.
    free : int
        Directions along which a sampled loop rests whether it is open or closed: their poles are left out.
    """
    import numpy as np

    before, after = (poles(each, free) for each in (opened.A, opened.A - opened.B @ opened.C))
    sampled = bool(opened.dt)
    inside = np.abs(after) < 1.0 if sampled else after.real < 0.0
    if not inside.all():
        return UNSTABLE
    found = crossings(before, after, sampled=sampled)
    factors = -1.0 / found.real[found.real < 0.0]
    # A phase margin beyond half a turn is one of lead; delay only takes phase away.
    lags = np.mod(np.pi + found.angles, 2.0 * np.pi)
    frequencies = 2.0 * np.arctan(found.frequencies) / opened.dt if sampled else found.frequencies
    return Margins(
        stable=True,
        gain_up=float(np.min(factors[factors > 1.0], initial=MOST_GAIN)),
        gain_down=float(np.max(factors[factors < 1.0], initial=1.0 / MOST_GAIN)),
        phase=float(np.min(np.minimum(lags, 2.0 * np.pi - lags), initial=np.pi)),
        delay=float(np.min(lags / frequencies, initial=MOST_DELAY)),
        disk=disk_margin(before, after, sampled=sampled),
    )


def _of(found: list[Margins], name: str) -> "Array":
    """One margin over speed."""
    import numpy as np

    return np.array([getattr(each, name) for each in found], dtype=np.float64)


CHECK = Check(theorem=MARGINS_THEOREM, search=search, figures=figures)
