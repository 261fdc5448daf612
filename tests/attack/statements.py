"""What the statements of certificates have in common: plants at points, boxes, and quantities that proofs bound."""

import re
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from tests.attack import linear
from tests.attack.case import Case, Inequality, Stated, bounds_of
from tests.attack.laws import feedback_duty, sliding_torque, surface_rate
from tests.attack.plant import (
    GRAVITY,
    STEP,
    Plant,
    averaged_rate,
    creep_force,
    deceleration,
    drift,
    gain,
    holding_torque,
    resistance,
    slip_pole,
    slip_rate,
    slowing,
    static_load,
)
from tests.attack.search import Attack, Points

ROUNDING = 1e-9  # relative, of a bound that a file states


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


def reserve(case: Case, stated: Stated) -> float:
    """Return the reaching rate eta that a claim states, else :func:`own_reserve`."""
    said = re.search(r"eta = ([0-9.]+)", stated.claim)
    return float(said[1]) if said else own_reserve(case)


def own_reserve(case: Case) -> float:
    """Return the reaching rate that brings a rolling wheel to the surface above the lowest speed [m/s2]."""
    low, high = case.speeds
    names = [name for name in case.data.bounds if name in Plant.__dataclass_fields__]
    return largest_deceleration(case, names) * case.slip / float(np.log(high / low))


def surface_torque(case: Case, plant: Plant, slip: Any, speed: Any) -> Any:
    """Torque u* that holds the surface [N m]."""
    return (-drift(plant, slip, speed) + surface_rate(case) * (case.slip - slip)) / gain(plant, speed)


def needed_gain(case: Case, plant: Plant, slip: Any, speed: Any, eta: float, *, side: int = 0) -> Any:
    """Gain W0 at which the surface attracts with eta, from the rate of sbar itself [m/s2].

    Without switching, v sbar' = -v (F + G u) + v c e is what the model misses; W0 adds rho W0 against it. It is needed
    above the surface (side 1), below it (-1), or on both sides (0).
    """
    plain = sliding_torque_without_push(case, slip, speed)
    rest = speed * (surface_rate(case) * (case.slip - slip) - slip_rate(plant, slip, speed, plain))
    ratio = gain(plant, speed) / gain(case.model, speed)
    return ((side * rest if side else abs(rest)) + eta) / ratio


def sliding_torque_without_push(case: Case, slip: Any, speed: Any) -> Any:
    """Torque of the sliding-mode law on its surface [N m]."""
    on_surface = -(case.slip - slip) / surface_rate(case)
    return sliding_torque(case, slip, speed, on_surface)


# --- inequalities that proofs state


def inequality(case: Case, stated: Stated, each: Inequality, names: tuple[str, ...]) -> Attack | None:
    """Attack the bound of a quantity that the file states, if the quantity is known here."""
    found = quantity_of(each.quantity)
    if found is None:
        return None
    quantity, unit = found
    wide = {name: case.data.bounds[name] for name in names if name in each.known}
    eta = own_reserve(case)

    def margin(points: Points) -> Any:
        x = {**each.known, **points}
        value = quantity(case, plant_at(case, x), x, eta)
        return each.bound - value if each.relation == "<=" else value - each.bound

    return Attack(
        check=stated.check,
        statement=f"{each.quantity} {each.relation} {each.bound:.6g}",
        box={**each.ranges, **wide} or {"nothing": (0.0, 1.0)},
        margin=margin,
        unit=unit,
        slack=ROUNDING * abs(each.bound),
    )


Quantity = Callable[[Case, Plant, Points, float], Any]


def quantity_of(name: str) -> tuple[Quantity, str] | None:
    """Return what a quantity of a file is, in equations of its own, and its unit; None if it is not known here."""
    held = re.fullmatch(r"rate of the torque that holds slip ([0-9.]+)", name)
    if held:
        slip = float(held[1])
        return lambda c, p, x, _e: torque_rate(c, p, x.get("slip", slip), x["speed"]), "1/s"
    return QUANTITIES.get(name)


def torque_rate(case: Case, plant: Plant, slip: Any, speed: Any) -> Any:
    """Rate of the torque that holds a slip, averaged, over T_max [1/s]; the law measures with its own radius."""
    torque = holding_torque(plant, slip, speed)
    seen = 1.0 - case.model.wheel_radius / plant.wheel_radius * (1.0 - slip)
    return averaged_rate(plant, torque, feedback_duty(case, seen, speed, torque)) / plant.max_torque


def recoverable_share(case: Case, plant: Plant, slip: Any, speed: Any) -> Any:
    """Part d/d_max of the recoverable deviation that 0.05 takes, (A/X)^2 + A p (1 + abs(p) T_V)/g = 1 at d_max."""
    pole, fall = slip_pole(plant, slip, speed), -drift(plant, case.slip, speed)
    slope = pole / fall * (1.0 + abs(pole) * plant.vent_time)
    reach = case.slips[1] - case.slip
    grown = 2.0 / (slope + np.sqrt(slope**2 + 4.0 / reach**2))  # the positive root of (A/X)^2 + A slope = 1
    return 0.05 * np.exp(pole * case.sample_time) / grown


def normal_slope(points: Points) -> Any:
    """Slope of -f/(mu0 Q) in the slip over v, for a wheel whose gradient is ``steepness`` at slip and speed 1."""
    z, ratio, sliding = (points[name] for name in ("steepness", "kS/kA", "sliding_speed"))
    ratio_, decay = points["friction_ratio"], points["friction_decay"]

    def force(slip: Any) -> Any:
        friction = ratio_ + (1.0 - ratio_) * np.exp(-decay * sliding * slip)
        gradient = np.pi * z / (4.0 * static_load_of(points) * friction) * slip
        return 2.0 / np.pi * friction * (gradient / (1.0 + gradient**2) + np.arctan(ratio * gradient))

    return -np.imag(force(1.0 + STEP * 1j)) / STEP / sliding


def static_load_of(points: Points) -> Any:
    """Load of one of eight wheels [N]."""
    return points["normal_mass"] * GRAVITY / 8.0


QUANTITIES: dict[str, tuple[Quantity, str]] = {
    "deceleration a": (lambda _c, p, x, _e: deceleration(p, x["slip"], x["speed"]), "m/s2"),
    "deceleration": (lambda _c, p, x, _e: deceleration(p, x["slip"], x["speed"]), "m/s2"),
    "adhesion force f": (
        lambda _c, p, x, _e: creep_force(p, x["slip"], x["speed"], static_load(p) * p.load_share),
        "N",
    ),
    "input gain G": (lambda _c, p, x, _e: 1e6 * gain(p, x["speed"]), "1/s per MN m"),
    "rate of the input gain G' = G a/v": (
        lambda _c, p, x, _e: 1e6 * gain(p, x["speed"]) * slowing(p, x["slip"], x["speed"]) / x["speed"],
        "1/s2 per MN m",
    ),
    "(abs(r) + eta)/rho": (lambda c, p, x, e: needed_gain(c, p, x["slip"], x["speed"], e), "m/s2"),
    "(r + eta)/rho": (lambda c, p, x, e: needed_gain(c, p, x["slip"], x["speed"], e, side=1), "m/s2"),
    "(eta - r)/rho": (lambda c, p, x, e: needed_gain(c, p, x["slip"], x["speed"], e, side=-1), "m/s2"),
    "u* - eta/g": (lambda c, p, x, e: _ideal(c, p, x) - _room(p, x, e), "N m"),
    "u* + eta/g": (lambda c, p, x, e: _ideal(c, p, x) + _room(p, x, e), "N m"),
    "u*": (lambda c, p, x, _e: _ideal(c, p, x), "N m"),
    "slip pole": (lambda c, p, x, _e: slip_pole(p, x.get("slip", c.slip), x["speed"]), "1/s"),
    "slip pole less a/v": (
        lambda c, p, x, _e: linear.difference_rate(p, x.get("slip", c.slip), x["speed"]),
        "1/s",
    ),
    "holding torque": (lambda c, p, x, _e: holding_torque(p, x.get("slip", c.slip), x["speed"]), "N m"),
    "growth within a sample": (
        lambda c, p, x, _e: np.exp(slip_pole(p, x["slip"], x["speed"]) * c.sample_time),
        "-",
    ),
    "share of the recoverable deviation": (
        lambda c, p, x, _e: recoverable_share(c, p, x["slip"], x["speed"]),
        "-",
    ),
    "slope of the creep force over mu0 Q v, falling": (lambda _c, _p, x, _e: normal_slope(x), "s/m"),
}


def _ideal(case: Case, plant: Plant, x: Points) -> Any:
    return surface_torque(case, plant, x["slip"], x["speed"])


def _room(plant: Plant, x: Points, eta: float) -> Any:
    return eta / (gain(plant, x["speed"]) * x["speed"])
