"""What each PROVED certificate says, as statements whose margin an attacker can compute with equations of its own."""

import re
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from tests.attack import linear, motion
from tests.attack.case import Case, Inequality, Stated, bounds_of
from tests.attack.laws import layer, sliding_torque, surface_rate
from tests.attack.plant import (
    GRAVITY,
    Plant,
    creep_force,
    deceleration,
    drift,
    gain,
    holding_torque,
    resistance,
    slip_pole,
    slip_rate,
    static_load,
)
from tests.attack.search import Attack, Points

Builder = Callable[[Case, Stated, tuple[str, ...]], list[Attack]]

DEVIATION = 0.05  # of the slip that full venting has to bring back
SETTLED = 1e-3  # of the slip from sample to sample, at the end of a run
NEVER = -1.0  # margin where the thing that is spoken about does not exist
ROUNDING = 1e-9  # relative, of a bound that a file states
LEAST_SPEED = 1e-3  # m/s, for what is claimed at all speeds above 0


def attacks(case: Case, stated: Stated, names: Iterable[str]) -> list[Attack]:
    """Return the attacks on a certificate over the numbers with these names; none if nothing is known about it."""
    names = tuple(names)
    own = BUILDERS[stated.check](case, stated, names) if stated.check in BUILDERS else []
    found = (_inequality(case, stated, each, names) for each in stated.inequalities)
    return own + [each for each in found if each is not None]


# --- helpers


def plant_at(case: Case, points: Points) -> Plant:
    """Return the plant with the numbers of the points."""
    return case.data.plant.with_numbers(dict(points))


def box(case: Case, names: Iterable[str], **extra: tuple[float, float]) -> dict[str, tuple[float, float]]:
    """Return the bounds of the numbers beside other ranges."""
    return {**extra, **bounds_of(case, names)}


def largest_deceleration(case: Case, names: Iterable[str]) -> float:
    """Return a_max: full friction on all wheels and the resistance at the highest speed [m/s2]."""
    free = bounds_of(case, names)
    plant = case.data.plant
    top = {each: free.get(each, (getattr(plant, each),) * 2) for each in Plant.__dataclass_fields__}
    worst = plant.with_numbers({each: top[each][1] for each in top if each.startswith("resistance")})
    return float(top["mu0"][1] * GRAVITY + resistance(worst, case.speeds[1]) / top["mass"][0])


def reserve(case: Case, stated: Stated, names: Iterable[str]) -> float:
    """Return the reaching rate eta that a claim states, else the one that brings a rolling wheel to the surface."""
    said = re.search(r"eta = ([0-9.]+)", stated.claim)
    if said:
        return float(said[1])
    low, high = case.speeds
    return largest_deceleration(case, names) * case.slip / float(np.log(high / low))


def surface_torque(case: Case, plant: Plant, slip: Any, speed: Any) -> Any:
    """Torque u* that holds the surface [N m]."""
    return (-drift(plant, slip, speed) + surface_rate(case) * (case.slip - slip)) / gain(plant, speed)


def needed_gain(case: Case, plant: Plant, slip: Any, speed: Any, eta: float) -> Any:
    """Gain W0 at which the surface attracts with eta, from the rate of sbar itself [m/s2].

    Without switching, v sbar' = -v (F + G u) + v c e is what the model misses; W0 adds rho W0 against it.
    """
    plain = sliding_torque_without_push(case, slip, speed)
    rest = speed * (surface_rate(case) * (case.slip - slip) - slip_rate(plant, slip, speed, plain))
    ratio = gain(plant, speed) / gain(case.model, speed)
    return (abs(rest) + eta) / ratio


def sliding_torque_without_push(case: Case, slip: Any, speed: Any) -> Any:
    """Torque of the sliding-mode law on its surface [N m]."""
    on_surface = -(case.slip - slip) / surface_rate(case)
    return sliding_torque(case, slip, speed, on_surface)


# --- inequalities that proofs state


def _inequality(case: Case, stated: Stated, each: Inequality, names: tuple[str, ...]) -> Attack | None:
    """Attack the bound of a quantity that the file states, if the quantity is known here."""
    if each.quantity not in QUANTITIES:
        return None
    quantity, unit = QUANTITIES[each.quantity]
    eta = reserve(case, stated, names)
    down_to_standstill = stated.check == "barbalat"
    speeds = (LEAST_SPEED, case.speeds[1]) if down_to_standstill else case.speeds
    ranges = {"speed": speeds} | ({"slip": case.slips} if "slip" in each.over else {})

    def margin(points: Points) -> Any:
        slip = points.get("slip", case.slip)
        value = quantity(case, plant_at(case, points), slip, points["speed"], eta)
        return each.bound - value if each.relation == "<=" else value - each.bound

    return Attack(
        check=stated.check,
        statement=f"{each.quantity} {each.relation} {each.bound:.6g}",
        box=box(case, names, **ranges),
        margin=margin,
        unit=unit,
        slack=ROUNDING * abs(each.bound),
    )


QUANTITIES: dict[str, tuple[Callable[[Case, Plant, Any, Any, float], Any], str]] = {
    "deceleration a": (lambda _c, p, s, v, _e: deceleration(p, s, v), "m/s2"),
    "deceleration": (lambda _c, p, s, v, _e: deceleration(p, s, v), "m/s2"),
    "adhesion force f": (lambda _c, p, s, v, _e: creep_force(p, s, v, static_load(p)), "N"),
    "input gain G": (lambda _c, p, _s, v, _e: 1e6 * gain(p, v), "1/s per MN m"),
    "rate of the input gain G' = G a/v": (
        lambda _c, p, s, v, _e: 1e6 * gain(p, v) * deceleration(p, s, v) / v,
        "1/s2 per MN m",
    ),
    "(abs(r) + eta)/rho": (needed_gain, "m/s2"),
    "u* - eta/g": (
        lambda c, p, s, v, e: surface_torque(c, p, s, v) - e / (gain(p, v) * v),
        "N m",
    ),
    "u* + eta/g": (
        lambda c, p, s, v, e: surface_torque(c, p, s, v) + e / (gain(p, v) * v),
        "N m",
    ),
    "slip pole": (lambda _c, p, s, v, _e: slip_pole(p, s, v), "1/s"),
    "slip pole less a/v": (lambda _c, p, s, v, _e: linear.difference_rate(p, s, v), "1/s"),
    "holding torque": (lambda _c, p, s, v, _e: holding_torque(p, s, v), "N m"),
}


# --- claims with more than inequalities of one point


def _gain_positive(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    return [
        Attack(
            check=stated.check,
            statement="G > 0: torque raises the rate of the slip",
            box=box(case, names, speed=case.speeds, slip=case.slips),
            margin=lambda x: (
                slip_rate(plant_at(case, x), x["slip"], x["speed"], 1.0)
                - slip_rate(plant_at(case, x), x["slip"], x["speed"], 0.0)
            ),
            unit="1/s per N m",
        )
    ]


def _well_posed(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    def margin(x: Points) -> Any:
        plant = plant_at(case, x)
        return np.minimum(
            deceleration(plant, x["slip"], x["speed"]),
            creep_force(plant, x["slip"], x["speed"], static_load(plant)),
        )

    return [
        Attack(
            check=stated.check,
            statement="a >= 0 and f >= 0",
            box=box(case, names, speed=case.speeds, slip=case.slips),
            margin=margin,
            unit="m/s2 or N",
        )
    ]


def _surface_hurwitz(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """On the surface e' = -c e: hold the slip there with the true u* and look at the rate of the error."""

    def margin(x: Points) -> Any:
        plant = plant_at(case, x)
        rate = slip_rate(plant, x["slip"], x["speed"], surface_torque(case, plant, x["slip"], x["speed"]))
        return rate * (case.slip - x["slip"])  # e e' = -slip' e must not be positive

    return [
        Attack(
            check=stated.check,
            statement="the error decays on the surface",
            box=box(case, names, speed=case.speeds, slip=case.slips),
            margin=margin,
            unit="1/s",
            slack=1e-9,
        )
    ]


def _reaching(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """Outside the layer, on both sides, v sbar' moves towards the surface at eta at least, for the law as it is."""
    eta = reserve(case, stated, names)

    def margin(x: Points) -> Any:
        plant, error = plant_at(case, x), case.slip - x["slip"]

        def attraction(side: float) -> Any:
            integral = (2.0 * side * layer(case) - error) / surface_rate(case)
            torque = sliding_torque(case, x["slip"], x["speed"], integral)
            rate = -slip_rate(plant, x["slip"], x["speed"], torque) + surface_rate(case) * error
            return -side * x["speed"] * rate - eta

        return np.minimum(attraction(1.0), attraction(-1.0))

    return [
        Attack(
            check=stated.check,
            statement=f"v sbar' points to the surface with at least eta = {eta:.4g} m/s2 outside the layer",
            box=box(case, names, slip=case.slips, speed=case.speeds),
            margin=margin,
            unit="m/s2",
        )
    ]


def _boundary_layer(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """Runs with T = u from inside the layer; what leaves the domain is not spoken about any more."""
    width, c = layer(case), surface_rate(case)

    def margin(x: Points) -> Any:
        plant = plant_at(case, x)
        integral = (width * x["place"] - (case.slip - x["slip"])) / c
        path = motion.layer_run(case, plant, x["slip"], x["speed"], integral, time=6.0, step=0.01)
        worst, alive = np.full(np.shape(x["slip"]), np.inf), np.ones(np.shape(x["slip"]), bool)
        for time, slip, speed, _ in path:
            alive &= (slip >= case.slips[0]) & (slip <= case.slips[1]) & (speed >= case.speeds[0])
            band = 2 * width + motion.transient(case, integral, time)
            worst = np.where(alive, np.minimum(worst, band - abs(case.slip - slip)), worst)
        return worst

    return [
        Attack(
            check=stated.check,
            statement="abs(e) <= 2 Phi/K_P + c abs(E1) exp(-c t) from inside the layer on",
            box=box(case, names, slip=case.slips, speed=case.speeds, place=(-1.0, 1.0)),
            margin=margin,
            cost=600,
            slack=1e-6,
        )
    ]


def _hard_limits(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
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
    """V of the file falls over a sample by its factor, about the equilibrium that the plant has."""
    found = [_equilibrium(case, stated, names)]
    for proof in stated.quadratics:
        p = tuple(_number(each) for each in proof["sampled"])
        factor = _number(proof["contraction"])
        found.append(sampled_fall(case, stated, names, p, factor))
    found.append(_settles(case, stated, names))
    return found


def sampled_fall(
    case: Case,
    stated: Stated,
    names: tuple[str, ...],
    p: tuple[float, ...],
    factor: float,
    *,
    knows_torque: bool = False,
) -> Attack:
    """V falls by a factor squared per sample with true pulses; ``knows_torque`` holds the reference exactly."""

    def margin(x: Points) -> Any:
        plant = plant_at(case, x)
        if knows_torque:
            slip = np.full(np.shape(x["speed"]), case.slip)
            share = np.clip(holding_torque(plant, slip, x["speed"]) / plant.max_torque, 1e-6, 1.0 - 1e-6)
            duty = linear.duty_of(plant, share, case.sample_time)
        else:
            slip, duty = linear.equilibrium(case, plant, x["speed"])
        lost = np.isnan(slip)
        slip, duty = np.where(lost, case.slip, slip), np.where(lost, 0.5, duty)
        found = linear.contraction(linear.sampled_map(case, plant, slip, x["speed"], duty), p)
        return np.where(lost, NEVER, factor - found)

    return Attack(
        check=stated.check,
        statement=f"V falls by the factor {factor:.4g}^2 per sample with true pulses, about the equilibrium",
        box=box(case, names, speed=case.speeds),
        margin=margin,
        cost=60,
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


def _routh_lag(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """Poles of the loop with the averaged valve at frozen speed, about the equilibrium."""
    if case.law == "torque-feedback":

        def margin(x: Points) -> Any:
            plant = plant_at(case, x)
            slip, _ = linear.equilibrium(case, plant, x["speed"], sampled=False)
            lost = np.isnan(slip)
            matrix = linear.continuous_rates(
                case, plant, np.where(lost, case.slip, slip), x["speed"], frozen=True
            )
            return np.where(lost, NEVER, -linear.abscissa(matrix))

    else:

        def margin(x: Points) -> Any:
            return -linear.surface_poles(case, plant_at(case, x), x["speed"])

    found = Attack(
        check=stated.check,
        statement="all poles behind the averaged valve lie in the left half-plane",
        box=box(case, names, speed=case.speeds),
        margin=margin,
        unit="1/s",
        cost=20,
    )
    return [found, *([_equilibrium(case, stated, names)] if case.law == "torque-feedback" else [])]


def _sliding_exists(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """u* leaves room to release; room to apply is asked for only where the brake can hold the surface."""
    eta = reserve(case, stated, names)

    def margin(x: Points) -> Any:
        plant = plant_at(case, x)
        room = eta / (gain(plant, x["speed"]) * x["speed"])
        return surface_torque(case, plant, x["slip"], x["speed"]) - room

    return [
        Attack(
            check=stated.check,
            statement="u* >= eta/g",
            box=box(case, names, slip=case.slips, speed=case.speeds),
            margin=margin,
            unit="N m",
        )
    ]


def _stop_bound(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """No ideal brake stops shorter or sooner than the file says."""
    distance = _said(stated, r"([0-9.]+) m\b", "bound of the distance")
    time = _said(stated, r"([0-9.]+) s\b", "bound of the time")

    def margin(x: Points) -> Any:
        took, way = motion.ideal_stop(plant_at(case, x), np.full(np.shape(x["whole"]), case.speeds[1]))
        return np.minimum(way / distance, took / time) - 1.0

    return [
        Attack(
            check=stated.check,
            statement=f"no ideal stop is shorter than {distance:.2f} m or {time:.2f} s",
            box=box(case, names, whole=(0.0, 1.0)),
            margin=margin,
            cost=2000,
        )
    ]


def _adaptive(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """Runs with T = u: V does not rise, the integral of abs(s_D) and the rate of s_D keep the stated bounds."""
    eta, free = reserve(case, stated, names), box(case, names)
    scheduled = case.gains["scheduled_rates"]
    least = 0.2 if stated.check == "barbalat" else case.speeds[0]
    lowest, highest = torque_range(case, free, eta, speeds=(least, case.speeds[1]))
    constant, bound = (lowest + highest) / 2, (highest - lowest) / 2
    integral = next((v for k, v in stated.points.items() if k.startswith("bound of the integral")), np.inf)
    steepest = next((v for k, v in stated.points.items() if k.startswith("Lipschitz")), np.inf)

    def margin(x: Points) -> Any:
        run = motion.adaptive_run(
            case,
            plant_at(case, x),
            x["start"],
            np.full(np.shape(x["start"]), case.speeds[1]),
            least_speed=least,
            constant=constant,
            bound=bound,
            step=0.002 if scheduled else 0.01,
        )
        worst = np.minimum(1.0 - run.integral / integral, 2e-5 - run.rise)
        return np.where(run.inside, np.minimum(worst, 1.0 - run.rate / steepest), np.inf)

    return [
        Attack(
            check=stated.check,
            statement=f"V never rises, the integral of abs(s_D) is below {integral:.4g}, its rate below {steepest:.4g}",
            box={**free, "start": (case.slips[0], case.slip)},
            margin=margin,
            cost=4000,
        )
    ]


def torque_range(
    case: Case, free: dict[str, tuple[float, float]], eta: float, *, speeds: tuple[float, float]
) -> tuple[float, float]:
    """Smallest u* - eta/g and largest u* + eta/g that scattered points and corners give [N m]."""
    from scipy.stats import qmc

    names = ["slip", "speed", *free]
    ends = np.array([case.slips, speeds, *free.values()]).T
    unit = qmc.Sobol(len(names), seed=1).random(4096).T
    unit = np.concatenate([unit, np.round(unit), np.concatenate([unit[:2], np.round(unit[2:])])], axis=1)
    points = dict(zip(names, ends[0][:, None] + (ends[1] - ends[0])[:, None] * unit, strict=True))
    plant = plant_at(case, points)
    held, room = (
        surface_torque(case, plant, points["slip"], points["speed"]),
        eta / (gain(plant, points["speed"]) * points["speed"]),
    )
    return float((held - room).min()), float((held + room).max())


def _said(stated: Stated, pattern: str, point: str) -> float:
    """Return a number of the claim's own sentence, else of the points beside the margin."""
    found = re.search(r"less than .*?" + pattern, stated.claim) or re.search(r" or " + pattern, stated.claim)
    return float(found[1]) if found else stated.points[point]


def _number(text: Any) -> float:
    from fractions import Fraction

    return float(Fraction(text))


BUILDERS: dict[str, Builder] = {
    "gain_positive": _gain_positive,
    "well_posed": _well_posed,
    "surface_hurwitz": _surface_hurwitz,
    "reaching": _reaching,
    "boundary_layer": _boundary_layer,
    "sliding_exists": _sliding_exists,
    "hard_limits": _hard_limits,
    "lpv_lyapunov": lpv_lyapunov,
    "routh_lag": _routh_lag,
    "stop_bound": _stop_bound,
    "afsmc_energy": _adaptive,
    "barbalat": _adaptive,
}
