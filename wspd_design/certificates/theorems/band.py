"""The band of slip: what a sampled law with friction-torque observer keeps through its real valve, over a whole stop.

See :mod:`wspd_design.certificates.theorems.slip_band` for loop, proof and checker.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import product

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.kernel.claim import Claim, Relation
from wspd_design.certificates.kernel.finding import Finding, Place
from wspd_design.certificates.kernel.obligation import Inequality, Obligation, Special
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.quantities import CONTACT, RAIL
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import creep_slope, domain
from wspd_design.certificates.setting.assumptions import BUILT_UP, Assumption
from wspd_design.certificates.setting.declared_law import not_declared
from wspd_design.certificates.setting.plant import place
from wspd_design.certificates.setting.written_protection import not_written
from wspd_design.certificates.theorems.slip_band.attempt import attempt_of, told_attempt
from wspd_design.certificates.theorems.slip_band.checker import checker
from wspd_design.certificates.theorems.slip_band.departure import (
    LIMIT,
    corners,
    denies,
    holding_share,
    place_ranges,
)
from wspd_design.certificates.theorems.slip_band.friction import NAMES as BOUNDS
from wspd_design.certificates.theorems.slip_band.friction import (
    Friction,
    Part,
    Parts,
    parts_of,
    strip_of,
)
from wspd_design.certificates.theorems.slip_band.reference import (
    reference_text,
    slip_at,
    slips_beside,
    slips_held,
)
from wspd_design.certificates.theorems.slip_band.statement import (
    JERK_FACTORS,
    NAMES,
    Interval,
    law_of,
    windows_of,
)
from wspd_design.certificates.theorems.theorem import Findings, Theorem, all_of, hypothesis
from wspd_design.controllers.observer_form import TorqueObserver
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.references import FallingSlip
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.units import KMH

CELLS = "ellipsoids"
RESERVED = "ellipsoids with a reserve of the brake"
LATE = "ellipsoids with late pulses"
NOISY = "ellipsoids with noise"
DEPARTURE = "start at the reference"
VARIED = (*NAMES, "resistance constant", "resistance linear", "resistance quadratic")
DIRECTIONS: tuple[Relation, Relation] = (">=", "<=")
BOUNDED: dict[str, Callable[[Problem, Ends, Relation, Fraction], Claim]] = {
    "slope": creep_slope.slope_claim,
    "level": creep_slope.level_claim,
    "fading": creep_slope.fading_claim,
}
"""What of the friction is bounded in each window, by the first word of its name."""
DISTURBED = {
    RESERVED: "where holding the reference takes no more than a share of the full pressure",
    LATE: "even if pulses begin late",
    NOISY: "even if speeds are measured with noise",
}


def key(name: str, part: int, window: int, relation: Relation) -> str:
    """Name of the obligation to bound a property of the friction in a part of the steepness, in a window, from 1 on."""
    side = "from" if relation == ">=" else "to"
    return f"{name} {side}, part {part + 1} of the steepness, window {window + 1}"


def claims(problem: Problem) -> dict[str, Claim]:
    """Claims about the friction; whatever bound is proved counts."""
    found = {}
    law, radius = law_of(problem.controller), _radii(problem)
    for (k, window), (part, ends) in product(enumerate(windows_of(problem)), enumerate(_parts(problem))):
        there = replace(contact_held(problem), speeds=window)
        held = slips_held(law, window, radius)
        for name in BOUNDS:
            strip, claim = strip_of(name), BOUNDED[name.split()[0]]
            slips = held if strip is None else slips_beside(law, window, radius, problem.speeds[0], strip)
            for relation in DIRECTIONS:
                whole = claim(there, slips, relation, Fraction(0))
                found[key(name, part, k, relation)] = creep_slope.for_steepness(whole, slips, ends)
    return found


def _parts(problem: Problem) -> tuple[Ends, ...]:
    """Parts of the range of the steepness."""
    return parts_of(creep_slope.steepness_of(contact_held(problem)))


def proved_friction(problem: Problem, findings: Findings) -> tuple[Parts, ...] | None:
    """Proved bounds of the friction for each window, or none if one is open."""
    found, ranges = [], _parts(problem)
    for k in range(len(windows_of(problem))):
        parts = []
        for part, steepness in enumerate(ranges):
            ends = tuple(
                (findings[key(name, part, k, ">=")].low, findings[key(name, part, k, "<=")].high)
                for name in BOUNDS
            )
            if not all(math.isfinite(end) for each in ends for end in each):
                return None
            parts.append(Part(steepness, Friction.of(ends)))
        found.append(tuple(parts))
    return tuple(found)


def varied(problem: Problem) -> tuple[str, ...]:
    """Names of the numbers that vary in the box; the rate of the supply is one of a main pipe."""
    return (*VARIED, *(("supply rate",) if problem.vehicle.brake.build_up == "main-pipe" else ()))


def _radii(problem: Problem) -> Interval:
    low, high = problem.span("wheel radius")
    return Fraction(low), Fraction(high)


def contact_held(problem: Problem) -> Problem:
    """Hold the contact and the shape of the friction at their nominal values."""
    kept = {name: ends for name, ends in problem.bounds.items() if name in varied(problem)}
    return replace(problem, bounds=type(problem.bounds).of(kept))


def held_names(problem: Problem) -> tuple[str, ...]:
    """Names of the numbers with bounds that the claim depends on and holds."""
    return tuple(
        name for name in domain.uncertain(problem) if name in (*CONTACT, *RAIL) and name not in VARIED
    )


def speaks_about(problem: Problem) -> str:
    """Say why the theorem does not speak about a law; empty if it does."""
    law = problem.controller
    if isinstance(law, TorqueObserver):
        reason = _declared_wrong(problem, law)
    elif isinstance(law, Protection):
        reason = not_written(law) or _made_for_another(problem, law)
    else:
        reason = "is not a law of a vehicle with an observer of the friction torque that it declares (observer_form)"
    if reason:
        return reason
    numbers = law_of(law)
    if not numbers.falls and numbers.slip != Fraction(problem.slip):
        return f"holds slip {float(numbers.slip):g}, not {problem.slip:g}"
    dead_time = problem.vehicle.brake.dead_time
    if dead_time >= law.sample_time:
        return f"commands valves that have a dead time of {1e3 * dead_time:g} ms, a sample or more"
    if not isinstance(law, Protection):
        return ""
    if isinstance(law.reference, FallingSlip) and not _largest_slip(problem) < law.reference.largest:
        return f"holds no more than slip {law.reference.largest:g}, which ends its fall inside the range of speed"
    if law.cut_out_speed > problem.speeds[0]:
        return f"holds its valves below {law.cut_out_speed * KMH:.3g} km/h, inside the range of speed"
    return ""


def _made_for_another(problem: Problem, law: Protection) -> str:
    brake, modeled = problem.vehicle.brake, law.valve.brake
    same = (brake.max_pressure, problem.vehicle.wheelsets) == (modeled.max_pressure, law.wheelsets)
    return "" if same else "was made for another vehicle"


def _declared_wrong(problem: Problem, law: TorqueObserver) -> str:
    """Say why a law of a user is not the one that it declares, or one that the theorem does not speak about."""
    vehicle, form = problem.vehicle, law.observer_form
    if form.full_pressure != vehicle.brake.max_pressure or law.wheelsets != vehicle.wheelsets:
        return "was made for another vehicle"
    if vehicle.brake.valve != "lag" or any(share != 1.0 for share in vehicle.brake_shares):
        return "declares one valve with a lag and one full torque for all wheelsets, which the vehicle does not have"
    if min(form.slip_error, form.slip_drift) < 0.0 or not form.slip_error < form.slip:
        return "declares an error or a drift of its slip that cannot be"
    return not_declared(law, problem, slips_held(law_of(law), problem.speeds, _radii(problem)))


def _largest_slip(problem: Problem) -> float:
    """Largest slip of the reference, at the lowest speed that a sample may lead to [-]."""
    law = law_of(problem.controller)
    return slips_held(law, windows_of(problem)[0], _radii(problem))[1]


def _obligations(problem: Problem) -> tuple[Obligation, ...]:
    domain.box(problem, varied(problem))
    if windows_of(problem)[0][0] <= 0.0:
        raise OutsideModel("a sample may end at standstill")
    return (
        *(Inequality(key=name, claim=claim) for name, claim in claims(problem).items()),
        Special(
            key=CELLS,
            text="for every cell of the box and every window of speed no sample leads out of an ellipsoid of the state",
            check=checker(contact_held(problem), problem.controller),
        ),
        *(
            Special(
                key=name,
                text=f"for a share of the box no sample leads out of an ellipsoid of the state, {what}",
                check=checker(contact_held(problem), problem.controller, reserved=name == RESERVED),
            )
            for name, what in DISTURBED.items()
        ),
        Special(
            key=DEPARTURE,
            text="the brake can hold the reference, and no wheel locks in a simulated stop that starts there, settled",
            evaluate=partial(denies, problem),
            within=place_ranges(problem),
        ),
    )


def covered(problem: Problem, findings: Findings, name: str) -> Finding:
    """Return a finding on ellipsoids; it counts only for friction within the bounds of its parts."""
    found, proved = findings[name], proved_friction(problem, findings)
    if found.status is not Status.PROVED:
        return found

    def stated(name: str, part: int, window: int) -> Ends:
        low, high = (found.numbers[f"{name} {part} {window} {end}"] for end in ("low", "high"))
        return low, high

    within = proved is not None and all(
        _lies_in(stated(creep_slope.STEEPNESS, part, k), each.steepness)
        and all(_lies_in(ends, stated(name, part, k)) for name, ends in each.friction.named.items())
        for k, parts in enumerate(proved)
        for part, each in enumerate(parts)
    )
    return found if within else Finding(status=Status.UNDECIDED, asked=found.asked)


def _lies_in(inner: Ends, outer: Ends) -> bool:
    return outer[0] <= inner[0] and inner[1] <= outer[1]


def _tell(problem: Problem, findings: Findings) -> Certificate:
    cells, windows = covered(problem, findings, CELLS), windows_of(problem)
    friction = proved_friction(problem, findings)
    held, reference = held_names(problem), reference_text(law_of(problem.controller))
    within = domain.domain_of(contact_held(problem), varied(problem), held)
    low, high = (speed * KMH for speed in problem.speeds)
    claim = (
        f"Once the state of a wheelset is in its ellipsoid, its slip stays in a band around {reference} at every "
        f"instant, also between samples, from {high:.3g} down to {low:.3g} km/h, and the brake is not the limit, "
        f"while the supply has the share of the full pressure that is told. On "
        f"{within.text}, all of them constant; sampled every "
        f"{problem.sample_time * 1e3:g} ms, with any course of the friction whose slope stays within its proved range."
    )
    explanation, margin = f"No ellipsoids were found. {_dead_band(problem)}.", None
    worst: tuple[Point, ...] = ()
    status = all_of(cells)
    failed = attempt_of(problem, findings[CELLS].effort)
    if cells.status is Status.PROVED:
        share = cells.numbers["share"]
        number = cells.numbers["cells"]
        divided = "The box is one cell" if number == 1 else f"{number:g} cells of the box, each"
        explanation = (
            f"{bands(windows, cells)} {divided} with an ellipsoid for each window of speed, that of a faster window "
            "inside that of the next slower one. "
        )
        explanation += _supplies(windows, cells)
    borne = "".join(
        _borne(problem, windows, each)
        for name in DISTURBED
        if (each := covered(problem, findings, name)).status is Status.PROVED
    )
    if cells.status is Status.PROVED:
        explanation += borne
        if share < 1.0:
            status = Status.UNDECIDED
            part = f"{100.0 * share:.3g} % of each range about its nominal value"
            explanation = f"Shown on {part}, not on all of it. {explanation}"
        else:
            largest = max(cells.numbers[f"band {k} above"] for k in range(len(windows)))
            slip = _largest_slip(problem) + largest
            margin = Range(low=1.0 - slip, high=None, unit="-")
            worst = (Point(name="slip", value=slip, unit="-"),)
    elif borne:
        explanation = borne.strip()
    if failed is not None:
        if cells.status is Status.PROVED and not failed.share > cells.numbers["share"]:
            raise Refused("a search for a share of the box ended that the proof covers")
        explanation += f" {told_attempt(problem, failed)}"
    away = findings[DEPARTURE]
    if away.status is Status.REFUTED and away.stated is not None:
        status, margin = Status.REFUTED, None
        values = {**away.stated.place, "slip": _slip_there(problem, away.stated.place)}
        worst = place(values, ("slip", "speed", *NAMES))
        explanation = f"{_departure(problem, away)} {explanation}"
    return Certificate(
        claim=claim,
        status=status,
        explanation=explanation,
        margin=margin,
        worst_point=worst,
        witness=worst if status is Status.REFUTED else (),
        hypotheses=(
            hypothesis(
                "slope, level and fading of the friction stay in their proved ranges",
                Finding(
                    status=Status.PROVED if friction is not None else Status.UNDECIDED,
                    asked="the friction is bounded in each window",
                ),
            ),
            hypothesis(cells.asked, cells),
            *((hypothesis(away.asked, away),) if away.status is Status.REFUTED else ()),
        ),
        assumptions=(
            "the parameters do not change during the stop; the full pressure is demanded, and the supply rises to it",
            f"{_measured(problem)}; the scale of the train speed was found while rolling",
            "all axles at static load and within their bands; the deceleration of the train rises "
            f"{float(JERK_FACTORS[0]):g} to {float(JERK_FACTORS[1]):g} times as fast as at that deceleration it "
            "would with all wheels at the reference"
            f"{', and its filter has settled' if law_of(problem.controller).falls else ''}",
            f"pulses begin {_beginning(problem)}; the law computes with real numbers{_compared(problem)}",
            "says nothing about the way from rolling into the ellipsoid, nor below the lowest speed",
        ),
        domain=within,
        varied=tuple(name for name in domain.uncertain(problem) if name in varied(problem)),
        held=held,
        method="ellipsoids by linear matrix inequalities in doubles; LDL' in balls at the corners of the sampled loop, "
        "with the friction bounded by interval branch and bound, replayed by the independent checker",
        reference="docs/theory.md#band",
    )


def _compared(problem: Problem) -> str:
    if isinstance(problem.controller, Protection):
        return ""
    return (
        "; its traced start and step are those of the numbers that it declares, compared in a prime field and in "
        "doubles for healthy sensors, speeds of the range and pulses within a sample, except where branches meet"
    )


def _measured(problem: Problem) -> str:
    law = law_of(problem.controller)
    if not law.slip_error:
        return "wheel speed, cylinder pressure and train speed are measured exactly and at once"
    return (
        "wheel speed and cylinder pressure are measured exactly and at once; the train speed that the law is told may "
        f"be wrong, but so that the slip that it holds is within {float(law.slip_error):g} of what it declares and "
        f"moves no faster than by {float(law.slip_drift):g} m/s2 over the train speed"
    )


def _departure(problem: Problem, away: Finding) -> str:
    """Say what happens at the place that denies every band."""
    numbers = away.numbers
    if LIMIT[0] in numbers:
        holding, full = (numbers[name] / 1e3 for name in LIMIT)
        slip = _slip_there(problem, away.stated.place) if away.stated is not None else math.nan
        return (
            f"The brake is the limit in a corner of the box: there holding slip {slip:.3g} takes {holding:.3g} "
            f"kN m, and full pressure gives {full:.3g}. That denies the lower side of a band alone: what keeps the "
            "slip down there, the check slip_limit tells."
        )
    speed = away.stated.place["speed"] if away.stated is not None else math.nan
    return (
        f"In a corner of the box a simulated stop of the quarter model that starts at {speed * KMH:.3g} km/h on the "
        "reference, with observers and filters settled, has locked wheels "
        f"{numbers['lock time']:.2g} s later, at {numbers['lock speed'] * KMH:.3g} km/h: no set around the reference "
        "keeps a band."
    )


def _slip_there(problem: Problem, place: Place) -> float:
    return slip_at(law_of(problem.controller), place["speed"], place["wheel radius"])


def bands(windows: Sequence[tuple[float, float]], cells: Finding) -> str:
    """Say how far the slip strays at the lowest, a middle and the highest speeds."""
    told = [
        f"+{cells.numbers[f'band {k} above']:.2g} and -{cells.numbers[f'band {k} below']:.2g} at "
        f"{windows[k][0] * KMH:.0f} to {windows[k][1] * KMH:.0f} km/h"
        for k in sorted({0, len(windows) // 2, len(windows) - 1})
    ]
    return f"The slip stays within {', '.join(told)} of its reference."


def _supplies(windows: Sequence[tuple[float, float]], cells: Finding) -> str:
    """Say how much of the full pressure the supply must have."""
    told = [100.0 * cells.numbers[f"supply {k}"] for k in range(len(windows))]
    fastest = f"{windows[-1][0] * KMH:.0f} to {windows[-1][1] * KMH:.0f} km/h"
    return (
        f"Of the full pressure the supply must have {told[-1]:.3g} % at {fastest}, and {max(told):.3g} % where it "
        "must have most."
    )


def _borne(problem: Problem, windows: Sequence[tuple[float, float]], found: Finding) -> str:
    """Say what else the band bears, and how wide it is then."""
    numbers, told = found.numbers, []
    if numbers["reserve"] < 1.0:
        told.append(
            f"while holding the reference takes at most {100.0 * numbers['reserve']:.3g} % of the full pressure "
            f"({_most_held(problem)})"
        )
    if numbers["delay"]:
        told.append(
            f"with pulses that begin up to {1e3 * numbers['delay']:.3g} ms late and end in their sample"
        )
    if numbers["noise"]:
        told.append(f"with speeds of wheels and train measured within {numbers['noise']:.3g} m/s")
    below, above = (
        max(numbers.get(f"band {k} {side}", 0.0) for k in range(len(windows))) for side in ("below", "above")
    )
    return (
        f" On {100.0 * numbers['share']:.3g} % of each range the slip also stays in a band {' and '.join(told)}: "
        f"within +{above:.2g} and -{below:.2g} at all speeds."
    )


def _most_held(problem: Problem) -> str:
    """Say which corner of the box takes most of the full pressure at the lowest speed."""
    held = [(holding_share(problem, {**each, "speed": problem.speeds[0]}), each) for each in corners(problem)]
    share, at = max(held, key=lambda each: each[0])
    return (
        f"most of it, {100.0 * share:.3g} % at {problem.speeds[0] * KMH:.3g} km/h, with {at['mass'] / 1e3:.3g} t, "
        f"mu0 = {at['mu0']:.3g} and {at['max torque'] / 1e3:.3g} kN m"
    )


def _beginning(problem: Problem) -> str:
    dead = problem.vehicle.brake.dead_time
    return f"at most {1e3 * dead:.3g} ms after their sample and end in it" if dead else "with the sample"


def _dead_band(problem: Problem) -> str:
    """Compare what the law leaves out with what a sample of venting can do."""
    law = law_of(problem.controller)
    h, speed = float(law.sample_time), problem.speeds[0]
    slip = slip_at(law, speed, problem.vehicle.wheel_radius)
    held = (
        2.0
        * problem.vehicle.wheel_radius
        * float(slip_dynamics(problem.vehicle, problem.rail, slip, speed).creep_force)
    )
    vented = held * -math.expm1(-h / float(law.vent_time))
    sliding = slip * speed / problem.vehicle.wheel_radius
    narrowed = float(law.dead_band_share * law.inertia * law.approach_rate) * sliding
    left_out = min(float(law.dead_band), narrowed)
    return (
        f"At {speed * KMH:.0f} km/h venting takes at most {vented / 1e3:.2g} of {held / 1e3:.3g} kN m off in one "
        f"sample, of which the dead band of {left_out / 1e3:.2g} kN m, drift and the lag of the acceleration must "
        "leave some"
    )


SLIP_BAND = Theorem(
    name="slip_band",
    title="Band of slip of the sampled loop",
    claim="Once the state of a wheelset is in its ellipsoid, its slip stays in a band around the reference.",
    speaks_about=speaks_about,
    obligations=_obligations,
    tell=_tell,
    assumes=BUILT_UP - {Assumption.NO_DEAD_TIME},
)
