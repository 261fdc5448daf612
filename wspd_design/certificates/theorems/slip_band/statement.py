"""What the band of slip is stated about: the law in exact numbers, windows of speed, and a box of constant numbers."""

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import ceil
from typing import TypeAlias

from wspd_design.certificates.records import Problem
from wspd_design.controllers.observer_form import ObserverForm, TorqueObserver
from wspd_design.controllers.observer_smc import ObserverSmc
from wspd_design.controllers.observers.told import ToldSpeed
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.protocol import Law
from wspd_design.controllers.references import ConstantSlip, FallingSlip
from wspd_design.parameters.loading import constants

Interval: TypeAlias = tuple[Fraction, Fraction]

NAMES = ("mass", "wheelset inertia", "wheel radius", "mu0", "max torque", "fill time", "vent time")
"""Numbers that do not change during a stop; their box is halved into cells."""
LETTERS = "mirutfv"
"""Which range a step halves, in the order of :data:`NAMES`; a full stop is a cell."""
Cell: TypeAlias = tuple[Interval, ...]

JERK_FACTORS = (
    Fraction(3, 4),
    Fraction(5, 4),
)  # -, how fast the deceleration rises, of what it does with all wheels at the reference
DRAG = Fraction(1, 2)  # m/s2, more than the resistance takes off
SLOWEST_WINDOW = 1.2  # ratio of the speeds of the slowest window
WIDENING = 0.33  # power of the speed with which the logarithm of that ratio grows


@dataclass(frozen=True, slots=True, kw_only=True)
class BandLaw:
    """Exact numbers of the law."""

    slip: Fraction  # -, reference; at 1 m/s where it falls
    falls: bool  # as 1/sqrt(v)
    slip_error: Fraction  # -, by which the slip that is held may differ from that
    slip_drift: Fraction  # m/s2, most of its rate times the train speed
    sample_time: Fraction  # s, h
    approach_rate: Fraction  # 1/s, k
    ahead: Fraction  # -
    observer_rate: Fraction  # 1/s
    inertia: Fraction  # kg m2
    radius: Fraction  # m
    full_torque: Fraction  # N m
    fill_time: Fraction  # s, that the inversion assumes, as the next
    vent_time: Fraction  # s
    time_share: Fraction  # -, of the nominal times, by which the mean torque is worked out
    least_pulse: Fraction  # s
    dead_band: Fraction  # N m
    dead_band_share: Fraction  # -, of the desired slip
    torque_slew: Fraction | None  # N m/s, of the braking curve; None without one
    acceleration_time: Fraction  # s, of the filter of the train's acceleration
    largest_scale_error: (
        Fraction | None
    )  # -, of the train speed, that it takes from rolling wheels; None: any


def law_of(law: Law) -> BandLaw:
    """Exact numbers of a protection with sliding mode of relative degree two, or of a law that declares its own."""
    if isinstance(law, TorqueObserver):
        return _declared(law.observer_form, law.sample_time)
    assert isinstance(law, Protection)
    core, reference, source = law.core, law.reference, law.source
    assert isinstance(core, ObserverSmc)
    assert isinstance(reference, ConstantSlip | FallingSlip)
    assert isinstance(source, ToldSpeed)
    tracking, valve = core.tracking, law.valve
    share = Fraction(valve.time_share)
    return BandLaw(
        slip=Fraction(reference.slip),
        falls=isinstance(reference, FallingSlip),
        slip_error=Fraction(0),
        slip_drift=Fraction(0),
        sample_time=Fraction(law.sample_time),
        approach_rate=Fraction(tracking.approach_rate),
        ahead=Fraction(tracking.ahead),
        observer_rate=Fraction(law.observer_rate),
        inertia=Fraction(law.wheelset_inertia),
        radius=Fraction(law.wheel_radius),
        full_torque=Fraction(valve.brake.max_torque),
        fill_time=share * Fraction(valve.brake.fill_time),
        vent_time=share * Fraction(valve.brake.vent_time),
        time_share=share,
        least_pulse=Fraction(valve.least_pulse),
        dead_band=Fraction(tracking.dead_band),
        dead_band_share=Fraction(tracking.dead_band_share),
        torque_slew=Fraction(core.torque_slew),
        acceleration_time=Fraction(source.acceleration_time),
        largest_scale_error=Fraction(source.largest_scale_error),
    )


def _declared(form: ObserverForm, sample_time: float) -> BandLaw:
    share = Fraction(form.time_share)
    return BandLaw(
        slip=Fraction(form.slip),
        falls=form.falls,
        slip_error=Fraction(form.slip_error),
        slip_drift=Fraction(form.slip_drift),
        sample_time=Fraction(sample_time),
        approach_rate=Fraction(form.approach_rate),
        ahead=Fraction(form.ahead),
        observer_rate=Fraction(form.observer_rate),
        inertia=Fraction(form.wheelset_inertia),
        radius=Fraction(form.wheel_radius),
        full_torque=Fraction(form.full_torque),
        fill_time=share * Fraction(form.fill_time),
        vent_time=share * Fraction(form.vent_time),
        time_share=share,
        least_pulse=Fraction(0),
        dead_band=Fraction(0),
        dead_band_share=Fraction(0),
        torque_slew=None if form.torque_slew is None else Fraction(form.torque_slew),
        acceleration_time=Fraction(form.acceleration_time),
        largest_scale_error=None,
    )


def box_of(problem: Problem, share: Fraction) -> Cell:
    """Return a share of each range of the box, around the nominal values."""
    box = []
    for name in NAMES:
        (low, high), middle = map(Fraction, problem.span(name)), Fraction(problem.nominal(name))
        box.append((middle + share * (low - middle), middle + share * (high - middle)))
    return tuple(box)


def halved(cell: Cell, letter: str) -> tuple[Cell, Cell]:
    """Both halves of a cell, the lower one first."""
    k = LETTERS.index(letter)
    low, high = cell[k]
    middle = (low + high) / 2
    return (*cell[:k], (low, middle), *cell[k + 1 :]), (*cell[:k], (middle, high), *cell[k + 1 :])


def cells_of(box: Cell, steps: str) -> list[Cell]:
    """Return the cells that steps divide a box into."""
    waiting, found = [box], []
    for step in steps:
        cell = waiting.pop()
        if step == ".":
            found.append(cell)
        else:
            waiting += halved(cell, step)[::-1]
    return found


def fastest_loss(problem: Problem) -> Fraction:
    """Return more than adhesion and resistance take off the train speed [m/s2]."""
    return Fraction(constants().gravity) * Fraction(problem.span("mu0")[1]) + DRAG


def windows_of(problem: Problem) -> tuple[tuple[float, float], ...]:
    """Windows of speed, the slowest first; each reaches down as far as one sample may lead out of it [m/s].

    They widen with the speed: slips move less there.
    """
    low, high = problem.speeds
    whole = 1.0 - (high / low) ** -WIDENING
    count = max(1, ceil(whole / (1.0 - SLOWEST_WINDOW**-WIDENING)))
    edges = [low * (1.0 - k / count * whole) ** (-1.0 / WIDENING) for k in range(count)] + [high]
    loss = float(fastest_loss(problem)) * problem.sample_time
    return tuple((slow - loss, fast) for slow, fast in pairwise(edges))
