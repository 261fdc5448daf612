"""What the statements of certificates have in common: plants at points, boxes, and quantities that proofs bound."""

import re
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from tests.attack import linear
from tests.attack.case import Case, Inequality, Stated, bounds_of
from tests.attack.laws import sliding_torque, surface_rate
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

ROUNDING = 1e-9  # relative, of a bound that a file states
LEAST_SPEED = 1e-3  # m/s, for what is claimed at all speeds above 0


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


def inequality(case: Case, stated: Stated, each: Inequality, names: tuple[str, ...]) -> Attack | None:
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
