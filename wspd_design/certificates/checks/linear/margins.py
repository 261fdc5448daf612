"""How much the loop near its reference bears: gain, phase, delay and disk margin over speed, also as sampled."""

import math
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from wspd_design.certificates.checks.frame import certified, level, series
from wspd_design.certificates.checks.linear.disk_margin import disk_margin
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.linear_loop import (
    LinearLaw,
    feedback,
    lag_of,
    nominal,
    on_brake,
    outermost,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

NAME, TITLE = "margins", "Margins of the loop"
SPEEDS = 25
DECIBEL = 20.0
MOST_GAIN, MOST_DELAY = 1e3, 10.0  # larger margins are reported as these: factor, s


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


@dataclass(frozen=True, slots=True, kw_only=True)
class Unstable:
    """A speed at which a pole lies outside for certain."""

    speed: float  # m/s
    sampled: bool
    least: float  # real part [1/s] or, of the sampled loop, magnitude [-] that a pole exceeds

    def witness(self, problem: Problem) -> tuple[Point, ...]:
        """Return the point with the nominal parameters."""
        return (
            Point(name="slip", value=problem.slip, unit="-"),
            Point(name="speed", value=self.speed * KMH, unit="km/h"),
            Point(name="mass", value=problem.vehicle.mass, unit="kg"),
            Point(name="wheelset inertia", value=problem.vehicle.wheelset_inertia, unit="kg m2"),
            Point(name="mu0", value=problem.rail.mu0, unit="-"),
            Point(name="magnitude of a sampled pole", value=self.least, unit="-")
            if self.sampled
            else Point(name="real part of a pole", value=self.least, unit="1/s"),
        )


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Work out the margins at speeds over the range, with nominal parameters."""
    import numpy as np

    law = problem.controller
    if not isinstance(law, LinearLaw):
        return laws.no_surface(problem, NAME, "The loop near its reference has margins at every speed.")
    domain.box(problem)
    speeds = np.geomspace(*problem.speeds, SPEEDS)
    continuous = [margins(loop(problem, law, float(v))) for v in speeds]
    sampled = [margins(loop(problem, law, float(v), sample_time=problem.sample_time)) for v in speeds]
    worst = min(range(SPEEDS), key=lambda i: min(continuous[i].disk, sampled[i].disk))
    tightest = min(continuous[worst], sampled[worst], key=lambda each: each.disk)
    stable = tightest.stable
    unstable = [[k for k in range(SPEEDS) if not each[k].stable] for each in (continuous, sampled)]
    beyond = _certain(problem, law, [speeds[each].tolist() for each in unstable])
    speed = (beyond.speed if beyond else float(speeds[worst])) * KMH
    where = (
        Point(name="speed", value=speed, unit="km/h"),
        Point(name="gain margin up", value=_decibel(tightest.gain_up), unit="dB"),
        Point(name="gain margin down", value=_decibel(tightest.gain_down), unit="dB"),
        Point(name="phase margin", value=math.degrees(tightest.phase), unit="deg"),
        Point(name="delay margin", value=tightest.delay, unit="s"),
        Point(name="disk margin", value=tightest.disk, unit="-"),
    )
    status = Status.EVIDENCE
    if not stable:
        status = Status.REFUTED if beyond else Status.UNDECIDED
    x = "speed [km/h]"
    kinds = (("continuous", continuous), ("sampled", sampled))
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"With the nominal parameters the loop near slip {problem.slip:g} is stable at every speed from "
        f"{problem.speeds[0] * KMH:.3g} to {problem.speeds[1] * KMH:.3g} km/h, continuous and sampled every "
        f"{problem.sample_time * 1e3:g} ms, and bears changes of gain and phase at the valve.",
        status=status,
        explanation=(
            f"Tightest at {speed:.3g} km/h: the gain may change by {_decibel(tightest.gain_down):.3g} to "
            f"{_decibel(tightest.gain_up):.3g} dB, the phase by {math.degrees(tightest.phase):.3g} degrees, "
            f"the delay may grow by {tightest.delay * 1e3:.3g} ms; disk margin {tightest.disk:.3g}."
            if stable
            else f"Unstable at {len(unstable[0])} of {SPEEDS} speeds as continuous loop and at {len(unstable[1])} as "
            f"sampled loop: there is no margin. {_exactly(beyond)}"
        ),
        margin=Range(low=None, high=tightest.disk, unit="-"),
        worst_point=where,
        witness=beyond.witness(problem) if beyond else (),
        assumptions=(
            "frozen train speed",
            "averaged valve with the slower of its two time constants",
            "nominal parameters",
            "torque command held over a sample: pulse width modulation without ripple, no computing time",
        ),
        method="python-control on the linear loop opened at the valve command; zero-order hold at the sample time; "
        "disk margin at the extremes of abs(S - 1/2) over all frequencies; a witness by poles that Arb encloses",
        resolution=f"{SPEEDS} speeds; gain margins beyond {_decibel(MOST_GAIN):.0f} dB and delay margins beyond "
        f"{MOST_DELAY:.0f} s are given as these",
        reference="eqs. (14), (19); docs/theory.md#routh; Seiler, Packard and Gahinet (2020), An introduction to "
        "disk margins",
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
    )


def _certain(problem: Problem, law: LinearLaw, speeds: list[list[float]]) -> Unstable | None:
    """Look for a speed at which the loop is unstable for certain, among those where floats say so."""
    for sampled, tried in zip((False, True), speeds, strict=True):
        for speed in tried:
            least = outermost(problem, law, speed, sampled=sampled)
            if least > (1.0 if sampled else 0.0):
                return Unstable(speed=speed, sampled=sampled, least=least)
    return None


def _exactly(beyond: Unstable | None) -> str:
    if beyond is None:
        return "But at none of them exact arithmetic shows a pole outside."
    size = (
        f"a sampled pole has a magnitude of at least {beyond.least:.4g}"
        if beyond.sampled
        else f"a pole has a real part of at least {beyond.least:.3g} 1/s"
    )
    return f"At {beyond.speed * KMH:.3g} km/h {size}, in exact arithmetic."


def loop(problem: Problem, law: LinearLaw, speed: float, *, sample_time: float | None = None) -> Any:
    """Loop opened at the valve command, to be closed by negative feedback.

    Parameters
    ----------
    problem : Problem
        With the nominal plant.
    law : LinearLaw
        Controller.
    speed : float
        Train speed [m/s].
    sample_time : float, optional
        Sampled loop with a zero-order hold and the integral of the law as it is summed [s].

    Returns
    -------
    control.StateSpace
        From duty to duty.
    """
    import control
    import numpy as np

    vehicle = problem.vehicle
    dynamics = nominal(vehicle, problem.rail, problem.slip, speed)
    lag, limit = lag_of(problem), vehicle.brake.max_torque
    gains = on_brake(law, feedback(law, speed), limit)
    plant = control.ss(
        np.array([[dynamics.pole, dynamics.gain * limit], [0.0, -1.0 / lag]]),
        np.array([[0.0], [1.0 / lag]]),
        np.eye(2),
        np.zeros((2, 1)),
    )
    direct = np.array([[gains.proportional / limit, gains.torque]])
    summed = np.array([[gains.integral / limit, 0.0]])
    if not np.any(summed):
        law_block = control.ss([], [], [], direct, sample_time or 0)
    elif sample_time is None:
        law_block = control.ss([[0.0]], summed, [[1.0]], direct)
    else:
        law_block = control.ss([[1.0]], sample_time * summed, [[1.0]], direct, sample_time)
    if sample_time is not None:
        plant = control.c2d(plant, sample_time, "zoh")
    return law_block * plant


def margins(opened: Any) -> Margins:
    """Margins of a loop, from its transfer function [factors, rad, s]."""
    import control
    import numpy as np

    poles = control.feedback(opened, 1).poles()
    sample_time = float(opened.dt)
    inside = np.abs(poles) < 1.0 if sample_time else poles.real < 0.0
    if not inside.all():
        return UNSTABLE
    with warnings.catch_warnings():
        # It says that it interpolates where the polynomial method would lose digits.
        warnings.filterwarnings("ignore", "stability_margins: Falling back", UserWarning)
        gains, phases, _, _, crossings, _ = control.stability_margins(opened, returnall=True)
    # At both ends of the frequency range the loop is real; python-control looks only between them.
    ends = [opened(z, warn_infinite=False).real for z in ((1.0, -1.0) if sample_time else (0.0,))]
    factors = np.array([*gains, *(-1.0 / end for end in ends if -np.inf < end < 0.0)])
    # A phase margin beyond half a turn is one of lead; delay only takes phase away.
    lags = np.radians(np.mod(np.asarray(phases), 360.0))
    delays = lags / np.asarray(crossings)
    return Margins(
        stable=True,
        gain_up=float(np.min(factors[factors > 1.0], initial=MOST_GAIN)),
        gain_down=float(np.max(factors[factors < 1.0], initial=1.0 / MOST_GAIN)),
        phase=float(np.min(np.minimum(lags, 2.0 * np.pi - lags), initial=np.pi)),
        delay=float(np.min(delays, initial=MOST_DELAY)),
        disk=disk_margin(opened.poles(), poles, sampled=bool(sample_time)),
    )


def _decibel(factor: float) -> float:
    return DECIBEL * math.log10(factor)


def _of(found: list[Margins], name: str) -> "Array":
    """One margin over speed."""
    import numpy as np

    return np.array([getattr(each, name) for each in found], dtype=np.float64)
