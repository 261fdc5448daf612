"""The three laws of the designs in equations of their own, on arrays: SI units, torque in N m, duty in 0 to 1."""

from typing import Any

import numpy as np

from tests.attack.case import Case
from tests.attack.plant import drift, gain, holding_torque

LEAST_SPEED = 0.1  # m/s, below which the laws take this one


def saturated(x: Any) -> Any:
    """Return x held to -1 to 1; analytic inside, so that a complex step passes."""
    return np.where(np.real(x) > 1.0, 1.0, np.where(np.real(x) < -1.0, -1.0, x))


def surface_rate(case: Case) -> float:
    """Return c = K_I/K_P [1/s]."""
    if "surface_rate" in case.gains:
        return float(case.gains["surface_rate"])
    return float(case.gains["integral_gain"]) / float(case.gains["proportional_gain"])


def layer(case: Case) -> float:
    """Return Phi/K_P [-]."""
    return float(case.gains["boundary_layer"]) / float(case.gains.get("proportional_gain", 1.0))


def surface(case: Case, slip: Any, integral: Any) -> Any:
    """Return sbar = e + c int e [-]."""
    return case.slip - slip + surface_rate(case) * integral


def sliding_torque(case: Case, slip: Any, speed: Any, integral: Any) -> Any:
    """Torque of the sliding-mode law, before the limits of the brake [N m]: u = (-F + c e + W0/v sat)/G."""
    error = case.slip - slip
    push = case.gains["switching_gain"] / speed * saturated(surface(case, slip, integral) / layer(case))
    wanted = -drift(case.model, slip, speed) + surface_rate(case) * error + push
    return wanted / gain(case.model, speed)


def memberships(case: Case, variable: Any) -> Any:
    """Normalized rule strengths of the fuzzy law, rules along the first axis."""
    shape = (-1,) + (1,) * np.ndim(variable)
    centres = np.asarray(case.gains["centres"], float).reshape(shape)
    widths = np.asarray(case.gains["widths"], float).reshape(shape)
    distances = ((variable - centres) / widths) ** 2
    raw = np.exp(np.real(distances).min(axis=0) - distances)
    return raw / raw.sum(axis=0)


def fuzzy_torque(case: Case, variable: Any, weights: Any, bound: Any) -> Any:
    """Torque of the adaptive law, eqs. (35) to (37); weights along the first axis [N m]."""
    push = bound * saturated(variable / case.gains["boundary_layer"])
    return (weights * memberships(case, variable)).sum(axis=0) + push


def dead_zone(case: Case, variable: Any) -> Any:
    """Part of s outside the boundary layer."""
    width = case.gains["boundary_layer"]
    return variable - width * saturated(variable / width)


def adaptation(case: Case, variable: Any, speed: Any) -> tuple[Any, Any]:
    """Rates of weights and bound, (41) and (42) [N m/s]."""
    driving = dead_zone(case, variable) if case.gains["dead_zone"] else variable
    if case.gains["scheduled_rates"]:
        driving = driving / np.maximum(speed, LEAST_SPEED)
    unit = case.gains["torque_unit"]
    weights = case.gains["weight_rate"] * unit * driving * memberships(case, variable)
    return weights, case.gains["bound_rate"] * unit * abs(driving)


def feedback_duty(case: Case, slip: Any, speed: Any, torque: Any, *, limited: bool = True) -> Any:
    """Duty of the torque feedback: the torque that holds the model, corrected by two errors."""
    full = case.model.max_torque
    held = holding_torque(case.model, case.slip, speed) / full
    error = speed * (case.slip - slip)
    duty = held + case.gains["sliding_gain"] * error - case.gains["torque_gain"] * (torque / full - held)
    return np.clip(duty, 0.0, 1.0) if limited else duty


def sampled_duty(case: Case, slip: Any, speed: Any, torque: Any, integral: Any) -> Any:
    """Duty of a law of one wheelset at a sample, the adaptive one left out."""
    if case.law == "torque-feedback":
        return feedback_duty(case, slip, speed, torque)
    demand = sliding_torque(case, np.maximum(slip, 0.0), np.maximum(speed, LEAST_SPEED), integral)
    return np.clip(demand / case.model.max_torque, 0.0, 1.0)
