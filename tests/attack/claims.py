"""What each PROVED certificate says, as statements whose margin an attacker can compute with equations of its own."""

import re
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from tests.attack import motion
from tests.attack.case import Case, Stated, with_axles
from tests.attack.laws import layer, sliding_torque, surface_rate
from tests.attack.plant import creep_force, deceleration, gain, slip_rate, static_load
from tests.attack.sampled_claims import functions, hard_limits, lpv_lyapunov, routh_lag, sampled_invariance
from tests.attack.search import Attack, Points
from tests.attack.statements import box, inequality, plant_at, quantity_of, reserve, surface_torque

Builder = Callable[[Case, Stated, tuple[str, ...]], list[Attack]]


GOOD = ("PROVED", "LIMITATION")  # statuses of claims that are attacked as a whole; proofs are in every file
WHOLE = {  # what is attacked as a whole in place of the quantities that its proofs bound, or by other means
    "routh_lag": "by the poles themselves",
    "derivation": "identities, by the equations of tests/attack/test_equations.py",
}


def attacks(case: Case, stated: Stated, names: Iterable[str]) -> list[Attack]:
    """Return the attacks on a certificate over the numbers with these names; none if nothing is known about it."""
    case, names = with_axles(case, stated), tuple(names)
    builder = BUILDERS.get(stated.check) if stated.status in GOOD else None
    own = builder(case, stated, names) if builder else []
    own = own + functions(case, stated, names)
    found = (inequality(case, stated, each, names) for each in stated.inequalities)
    return own + [each for each in found if each is not None]


def untouched(stated: Stated) -> list[str]:
    """Return what of a certificate has no equations of its own here: bounded quantities, or the whole."""
    if stated.check in WHOLE:
        return []
    unknown = [each.quantity for each in stated.inequalities if quantity_of(each.quantity) is None]
    silent = stated.status in GOOD and not stated.inequalities and stated.check not in BUILDERS
    return [stated.check] if silent else unknown


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
            creep_force(plant, x["slip"], x["speed"], static_load(plant) * plant.load_share),
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
    eta = reserve(case, stated)

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
        coarse = kept(x, 0.01)
        broken = coarse < 0.0  # or too long a step at low speed, which shorter ones tell
        if broken.any():
            coarse[broken] = kept({name: value[broken] for name, value in x.items()}, 0.001)
        return coarse

    def kept(x: Points, step: float) -> Any:
        plant = plant_at(case, x)
        integral = (width * x["place"] - (case.slip - x["slip"])) / c
        path = motion.layer_run(case, plant, x["slip"], x["speed"], integral, time=6.0, step=step)
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


def _sliding_exists(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """u* leaves room to release; room to apply is asked for only where the brake can hold the surface."""
    eta = reserve(case, stated)

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
    """No ideal brake stops shorter or sooner than the file says; its wheelsets are alike, each with its whole load."""
    distance = _said(stated, r"([0-9.]+) m\b", "bound of the distance")
    time = _said(stated, r"([0-9.]+) s\b", "bound of the time")

    def margin(x: Points) -> Any:
        took, way = motion.ideal_stop(plant_at(case, x), np.full(np.shape(x["whole"]), case.speeds[1]))
        return np.minimum(way / distance, took / time) - 1.0

    return [
        Attack(
            check=stated.check,
            statement=f"no ideal stop is shorter than {distance:.2f} m or {time:.2f} s",
            box=box(case, [name for name in names if name != "load_share"], whole=(0.0, 1.0)),
            margin=margin,
            cost=2000,
        )
    ]


def _adaptive(case: Case, stated: Stated, names: tuple[str, ...]) -> list[Attack]:
    """Runs with T = u: V does not rise, the integral of abs(s_D) and the rate of s_D keep the stated bounds."""
    eta, free = reserve(case, stated), box(case, names)
    scheduled = case.gains["scheduled_rates"]
    least = 0.2 if stated.check == "barbalat" else case.speeds[0]
    lowest, highest = torque_range(case, free, eta, speeds=(least, case.speeds[1]))
    constant, bound = (lowest + highest) / 2, (highest - lowest) / 2
    integral = _bound(stated, "bound on the integral of abs(s_D)")
    steepest = _bound(stated, "Lipschitz constant of s_D") if stated.check == "barbalat" else np.inf

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


def _bound(stated: Stated, name: str) -> float:
    """Return a bound that the file states; infinity where it states no bounds at all."""
    if not stated.points:
        return np.inf
    (value,) = (value for each, value in stated.points.items() if each.startswith(name))
    return value


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


BUILDERS: dict[str, Builder] = {
    "gain_positive": _gain_positive,
    "well_posed": _well_posed,
    "surface_hurwitz": _surface_hurwitz,
    "reaching": _reaching,
    "boundary_layer": _boundary_layer,
    "sliding_exists": _sliding_exists,
    "hard_limits": hard_limits,
    "lpv_lyapunov": lpv_lyapunov,
    "routh_lag": routh_lag,
    "sampled_invariance": sampled_invariance,
    "stop_bound": _stop_bound,
    "afsmc_energy": _adaptive,
    "barbalat": _adaptive,
}
