"""The energy of the adaptive fuzzy law: bounds from the repaired V, and why (44) as printed is false."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from wspd_design.certificates import domain, findings, laws
from wspd_design.certificates.balls import Ball, above, ball, below, point
from wspd_design.certificates.checking import certified, level, series
from wspd_design.certificates.domain import KMH
from wspd_design.certificates.plant import plant_dynamics, plant_forces, plant_variables
from wspd_design.certificates.proof.claim import Claim
from wspd_design.certificates.proof.engine import Finding, enclose, engine, settle, versions
from wspd_design.certificates.proof_run import exact_plant
from wspd_design.certificates.reaching import reserve
from wspd_design.certificates.records import Certificate, Hypothesis, Point, Problem, Range, Series, Status
from wspd_design.certificates.sliding_exists import torque_claim
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy, AdaptiveFuzzyGains, firing_strengths
from wspd_design.model.generated import sliding_surface
from wspd_design.model.slip import slip_dynamics

NAME, TITLE = "afsmc_energy", "Energy of the adaptive law"
TORQUE_TOLERANCE, DECELERATION_TOLERANCE = 50.0, 0.05  # N m, m/s2
CHOICES = 401  # of the constant ideal weight
SPEEDS = 41
LIMITS = 5  # hypotheses that hold without limits of the brake; the others speak about those


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Bound what the repaired law does, or refute the printed argument at a point."""
    law = problem.controller
    if not isinstance(law, AdaptiveFuzzy):
        return laws.not_applicable(
            problem, NAME, "V does not rise and bounds error and weights.", "is not the adaptive fuzzy law"
        )
    domain.box(problem)
    return _bounds(problem, law) if law.gains.dead_zone else _refutation(problem, law)


@dataclass(frozen=True, slots=True, kw_only=True)
class Energy:
    """What V(0) bounds, for ideal weights that are all alike."""

    weight: float  # N m, ideal
    bound: float  # N m, psi
    start: Ball  # N m s, V(0)
    integral: Ball  # s, of abs(s_D)
    weight_error: Ball  # N m, norm of the distance of the weights from the ideal ones
    highest_bound: Ball  # N m, of psi_hat


def energy(
    problem: Problem,
    gains: AdaptiveFuzzyGains,
    lowest: float,
    highest: float,
    eta: float,
    factor: float,
) -> Energy:
    """Bounds for all time, from V = v s_D^2/(2 g) + abs(b~)^2/(2 alpha1) + psi~^2/(2 alpha2).

    With g = R/I_w, s_D' = G (u* - u) outside the layer, and the adaptation with s_D,
    V' = s_D (u* - b*'w) - psi abs(s_D) - a s_D^2/(2 g). The rule strengths sum to one, so that weights that are all
    beta make b*'w = beta, and any psi >= abs(u* - beta) + eta/g gives V' <= -(eta/g) abs(s_D) where a >= 0: the
    integral of abs(s_D) is at most V(0) g/eta. beta and psi are free: those that make V(0) smallest are taken.

    Where the command leaves [0, T_max] and pushes further in the direction that s_D asks for, the adaptation is
    held and V' = s_D (u* - T) - a s_D^2/(2 g) <= -(eta/g) abs(s_D), because u* stays inside by eta/g. Where it
    leaves the range against s_D, the limit moves T towards u*, which only makes V' smaller.

    Parameters
    ----------
    problem : Problem
        Bounds of the parameters and the highest speed.
    gains : AdaptiveFuzzyGains
        Law.
    lowest, highest : float
        Lower bound of u* - eta/g and upper bound of u* + eta/g on the domain [N m].
    eta : float
        Reaching rate [m/s2].
    factor : float
        Of s_D^2/(2 g) in V: the speed at the start [m/s]; in sigma = integral of dt/v it is 1.
    """
    unit = gains.torque_unit
    # The law adapts with s, which counts K_P times s / K_P.
    rates = [point(unit) * gains.proportional_gain * rate for rate in (gains.weight_rate, gains.bound_rate)]
    starts = [point(unit) * weight for weight in gains.initial_weights]
    guessed = point(unit) * gains.initial_bound

    def adaptive(beta: float) -> tuple[Ball, float]:
        """What weights and bound contribute to V(0), and psi."""
        bound = max(
            math.nextafter(highest - beta, math.inf), math.nextafter(beta - lowest, math.inf), above(guessed)
        )
        squares = sum(((point(beta) - b) ** 2 for b in starts), point(0.0))
        return squares / rates[0] / 2 + (point(bound) - guessed) ** 2 / rates[1] / 2, bound

    span = highest - lowest
    choices = [lowest - span + 3.0 * span * k / (CHOICES - 1) for k in range(CHOICES)]
    beta = min(choices, key=lambda choice: float(adaptive(choice)[0]))
    stored, bound = adaptive(beta)
    light, heavy = (point(each) for each in problem.inertia_bounds)
    radius = point(problem.vehicle.wheel_radius)
    outside = point(gains.slip_reference) - point(gains.boundary_layer) / gains.proportional_gain
    distance = (
        outside if outside > 0 else point(0.0)
    )  # from the layer, of a rolling wheel or one that slips more
    kinetic = point(factor) * distance**2 / 2
    start = kinetic * heavy / radius + stored
    return Energy(
        weight=beta,
        bound=bound,
        start=start,
        integral=kinetic / eta + stored * radius / light / eta,
        weight_error=(2 * rates[0] * start).sqrt(),
        highest_bound=point(bound) + (2 * rates[1] * start).sqrt(),
    )


def _bounds(problem: Problem, law: AdaptiveFuzzy) -> Certificate:
    """Theorem for the repaired law."""
    gains, limit = law.gains, problem.vehicle.brake.max_torque
    eta = reserve(problem)
    least, most, deceleration = claims(problem, law)
    low, high = enclose(least, tolerance=TORQUE_TOLERANCE), enclose(most, tolerance=TORQUE_TOLERANCE)
    braking = settle(deceleration, tolerance=DECELERATION_TOLERANCE)
    enclosed = findings.status(low, high)
    signs = smallest_gain(gains)
    hypotheses = (
        exact("K_P, K_I, Phi and both adaptation rates are positive", signs > 0.0),
        exact("the adaptation rates do not depend on the speed", not gains.scheduled_rates),
        Hypothesis(text="G > 0 on the domain: a quotient of positive numbers", status=Status.PROVED),
        findings.hypothesis("the train decelerates, a >= 0, on the domain", braking),
        Hypothesis(text="psi >= abs(u* - beta) + eta/g on the domain", status=enclosed),
        Hypothesis(
            text=f"eta/g <= u* <= {limit / 1e3:g} kN m - eta/g on the domain",
            status=inside(low, high, limit),
        ),
        exact("the adaptation is held while the command pushes beyond the brake", gains.hold_when_saturated),
    )
    status = laws.of_theorem(hypotheses)
    where: tuple[Point, ...] = ()
    if signs > 0.0 and enclosed is Status.PROVED:
        found = energy(
            problem, gains, float(low.claim.bound), float(high.claim.bound), eta, problem.speeds[1]
        )
        integral, error, top = (above(x) for x in (found.integral, found.weight_error, found.highest_bound))
        numbers = f"the integral of abs(s_D) is at most {_up(integral)} s, the weights stay within "
        numbers += f"{_up(error / 1e3)} kN m of {found.weight / 1e3:.3g} kN m, and psi_hat below {_up(top / 1e3)} kN m"
        where = (
            Point(name="V(0)", value=above(found.start), unit="N m s"),
            Point(name="bound of the integral of abs(s_D)", value=integral, unit="s"),
            Point(name="bound of the distance of the weights", value=error, unit="N m"),
            Point(name="bound of psi_hat", value=top, unit="N m"),
            Point(name="psi", value=found.bound, unit="N m"),
        )
        layer = gains.boundary_layer / gains.proportional_gain
        seconds = integral / layer
        meaning = f"The surface is more than one further layer, {layer:.3g}, away for at most {_up(seconds)} s in all."
    else:
        numbers, meaning = "V bounds error and weights", "There is no bound to state."
    open_ones = [each.text for each in hypotheses if each.status is not Status.PROVED]
    unlimited = laws.of_theorem(hypotheses[:LIMITS]) is Status.PROVED
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"From a slip below the reference at {problem.speeds[1] * KMH:.3g} km/h on, without an integral of the "
        f"error yet and as long as the slip stays on {domain.described(problem)}, {numbers}.",
        status=status,
        explanation=f"{meaning} "
        + (f"Not shown: {'; '.join(open_ones)}." if open_ones else "All that it needs is proved.")
        + (" Without limits of the brake the bounds are proved." if open_ones and unlimited else ""),
        margin=Range(
            low=min(float(low.claim.bound), limit - float(high.claim.bound)),
            high=min(low.extreme.high or math.inf, limit - (high.extreme.low or -math.inf)),
            unit="N m",
        ),
        worst_point=where,
        hypotheses=hypotheses,
        assumptions=(
            "T = u inside the limits of the brake: no valve lag, no sampling, continuous adaptation",
            "slip reference constant",
            "the slip stays in the range of the domain",
        ),
        method="repaired Lyapunov function V; torques and deceleration enclosed by interval branch and bound and "
        "replayed by the checker; the rest in balls",
        resolution=f"{low.boxes + high.boxes + braking.boxes} boxes; torques within {TORQUE_TOLERANCE:g} N m",
        reference="eqs. (39)-(44) repaired; docs/theory.md#energy",
        undecided=findings.undecided(low, high, braking),
        engine=engine(),
        proofs=findings.proofs(low, high, braking),
    )


def smallest_gain(gains: AdaptiveFuzzyGains) -> float:
    """Return the smallest of the gains that must be positive; one that is no number counts as the smallest."""
    needed = (
        gains.weight_rate,
        gains.bound_rate,
        gains.proportional_gain,
        gains.integral_gain,
        gains.boundary_layer,
    )
    return -math.inf if any(math.isnan(each) for each in needed) else min(needed)


def claims(problem: Problem, law: AdaptiveFuzzy) -> tuple[Claim, Claim, Claim]:
    """Claims about u* - eta/g, u* + eta/g and the deceleration on the domain."""
    deceleration = Claim(
        name="deceleration",
        variables=plant_variables(problem),
        expression=lambda x: plant_dynamics(problem, x).deceleration,
        form=lambda x: plant_forces(problem, x).deceleration,
        relation=">=",
        bound=Fraction(0),
        unit="m/s2",
    )
    limit = problem.vehicle.brake.max_torque
    return torque_claim(problem, law, ">=", 0.0), torque_claim(problem, law, "<=", limit), deceleration


def inside(low: Finding, high: Finding, limit: float) -> Status:
    """Whether u* stays inside the range of the brake by eta/g."""
    if findings.status(low, high) is Status.PROVED and low.claim.bound >= 0 and high.claim.bound <= limit:
        return Status.PROVED
    least, most = low.extreme.high, high.extreme.low
    assert least is not None
    assert most is not None
    return Status.REFUTED if least < 0.0 or most > limit else Status.UNDECIDED


def _refutation(problem: Problem, law: AdaptiveFuzzy) -> Certificate:
    """Refute (44) at a state with s = 0, whatever the ideal weights."""
    import numpy as np

    speeds = np.geomspace(*problem.speeds, SPEEDS)
    rates = [printed_rate(problem, law, float(v)) for v in speeds]
    lowest = [below(rate) for rate in rates]
    worst = max(range(SPEEDS), key=lowest.__getitem__)
    refuted = lowest[worst] > 0.0
    where = (
        Point(name="speed", value=float(speeds[worst]) * KMH, unit="km/h"),
        Point(name="slip", value=problem.slip, unit="-"),
        Point(name="integral of the slip error", value=0.0, unit="s"),
        Point(name="least dV2/dt", value=lowest[worst], unit="1/s"),
    )
    share = sum(value > 0.0 for value in lowest)
    return Certificate(
        name=NAME,
        title=TITLE,
        claim="V2 of (43) falls along the printed law as (44) says, dV2/dt <= -G abs(s) (psi - abs(xi)), for some "
        "ideal weights and a psi that bounds the approximation error.",
        status=Status.REFUTED if refuted else Status.UNDECIDED,
        explanation=(
            f"With the slip at its reference, no integral and the initial weights and bound, s = 0 and (44) asks for "
            f"dV2/dt <= 0. At {where[0].value:.3g} km/h it is at least {lowest[worst]:.3g} 1/s, whatever the ideal "
            f"weights: (44) leaves out G'/2 times the squared errors, and G' > 0. The same happens at {share} of "
            f"{SPEEDS} speeds. With the dead zone and the held adaptation the repaired V gives bounds in its place."
            if refuted
            else "At s = 0 the initial weights and bound may be ideal ones, so that this point decides nothing."
        ),
        margin=Range(low=None, high=-lowest[worst], unit="1/s"),
        worst_point=where,
        witness=where if refuted else (),
        assumptions=(
            "T = u: no valve lag, no sampling, no limit of the brake torque, continuous adaptation",
            "nominal parameters",
            "initial weights and bound of the law",
        ),
        method="V2' at s = 0 in balls, minimized over all ideal weights and bounds that (34) admits",
        resolution=f"{SPEEDS} speeds",
        reference="eqs. (33), (34), (39)-(44); docs/theory.md#printed",
        engine=f"python-flint {versions()['python-flint']}",
        series=_plots((speeds * KMH).tolist(), lowest),
    )


def printed_rate(problem: Problem, law: AdaptiveFuzzy, speed: float) -> Ball:
    """Least dV2/dt at s = 0 over all admissible ideal weights and bounds [1/s].

    At s = 0 nothing adapts and V2' = (G'/2)(abs(b~)^2/alpha1 + psi~^2/alpha2) with G' = G a/v. (34) asks for
    psi >= abs(u* - b*'w). With the law's own w, b_hat and psi_hat the errors have to make up for
    d = abs(u* - b_hat'w) - psi_hat; the cheapest way costs d^2/(alpha1 abs(w)^2 + alpha2).
    """
    gains, vehicle = law.gains, problem.vehicle
    exact_numbers = exact_plant(problem, vehicle.mass, vehicle.wheelset_inertia, problem.rail.mu0)
    plant = slip_dynamics(*exact_numbers, point(problem.slip), point(speed))
    ideal = sliding_surface.equivalent_torque(plant.drift, plant.gain, 0.0, 0.0, 0.0) / gains.torque_unit
    strengths = firing_strengths(gains, point(0.0))
    fuzzy = sum((w * b for w, b in zip(strengths, gains.initial_weights, strict=True)), point(0.0))
    lacking = abs(ideal - fuzzy) - gains.initial_bound
    if not lacking > 0:
        return ball(0.0, 0.0)
    cost = lacking**2 / (gains.weight_rate * sum((w * w for w in strengths), point(0.0)) + gains.bound_rate)
    return plant.gain * plant.deceleration / speed / 2 * gains.torque_unit * cost


def _plots(speeds: Sequence[float], lowest: Sequence[float]) -> tuple[Series, ...]:
    import numpy as np

    axes = ("speed [km/h]", "dV2/dt at s = 0 [1/s]")
    return (
        series("at least, as printed", *axes, np.asarray(speeds), np.asarray(lowest)),
        level("at most, as (44) says", *axes, speeds, 0.0),
    )


def exact(text: str, holds: bool) -> Hypothesis:
    """State a condition that is decided by comparing numbers."""
    return Hypothesis(text=text, status=Status.PROVED if holds else Status.REFUTED)


def _up(bound: float) -> str:
    """Write an upper bound so that what stands there is still one."""
    return f"{math.ceil(100.0 * bound) / 100.0:.2f}"
