"""Inside the boundary layer the valve lag must leave the loop stable: Routh's conditions at each speed."""

from typing import TYPE_CHECKING, NamedTuple

from wspd_design.certificates import laws
from wspd_design.certificates.checking import certified, level, series
from wspd_design.certificates.domain import KMH
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.slip_pole import pole_map
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy, torque_demand
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.model.generated import sliding_surface
from wspd_design.model.generated.slip import slip_gain

if TYPE_CHECKING:
    from wspd_design.certificates.domain import Array

NAME, TITLE = "routh_lag", "Loop inside the layer with valve lag"


class Cubic(NamedTuple):
    """Coefficients of q^3, q^2, q, 1."""

    third: "Array"
    second: "Array"
    first: "Array"
    constant: "Array"


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Evaluate Routh's conditions of the loop inside the layer over a grid of speeds."""
    import numpy as np

    law = problem.controller
    if not isinstance(law, (AdaptiveFuzzy, SlidingMode)):
        return laws.no_surface(
            problem, NAME, "The loop inside the boundary layer is stable with the valve lag."
        )
    lag = max(problem.vehicle.brake.fill_time, problem.vehicle.brake.vent_time)
    poles = pole_map(problem)
    gain = slip_gain(poles.speeds, problem.vehicle.wheel_inertia, problem.vehicle.wheel_radius)
    if isinstance(law, SlidingMode):
        layer_rate = law.gains.switching_gain / poles.speeds / law.gains.boundary_layer
        rate = law.gains.surface_rate
        cubic = Cubic(*sliding_surface.lag_characteristic(poles.nominal, lag, rate, layer_rate))
        frozen = "design model equal to the plant"
        form = "k = W K_P/Phi"
    else:
        layer_rate = gain * torque_per_surface(law) * law.gains.proportional_gain
        rate = law.gains.integral_gain / law.gains.proportional_gain
        # Without an equivalent control the plant's own pole stays in the loop: k - p in place of c + k.
        cubic = Cubic(
            *sliding_surface.lag_characteristic(poles.nominal, lag, 0.0, layer_rate - poles.nominal)[:3],
            layer_rate * rate,
        )
        frozen = "weights and bound frozen at their initial values"
        form = "k = G K_P du/ds, k - p in place of c + k"
    margins = np.array(
        [cubic.second, cubic.first, cubic.constant, cubic.second * cubic.first - cubic.third * cubic.constant]
    )
    conditions = ("p tau < 1", "coefficient of q > 0", "k c > 0", "(1 - p tau)(c + k) > tau k c")
    margins = margins / np.stack(
        [np.ones_like(gain), abs(layer_rate) + rate, abs(layer_rate * rate), abs(layer_rate) + rate]
    )
    tightest = int(np.argmin(margins.min(axis=0)))
    failed = [text for text, value in zip(conditions, margins[:, tightest], strict=True) if value <= 0.0]
    unstable = (margins.min(axis=0) <= 0.0).sum()
    speed = float(poles.speeds[tightest])
    where = (
        Point(name="speed", value=speed * KMH, unit="km/h"),
        Point(name="slip pole", value=float(poles.nominal[tightest]), unit="1/s"),
        Point(name="k", value=float(layer_rate[tightest]), unit="1/s"),
    )
    speeds = poles.speeds * KMH
    axes = ("speed [km/h]", "Routh margin [-]")
    low, high = problem.speeds[0] * KMH, problem.speeds[1] * KMH
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"Inside the boundary layer, with the valve lag tau = {lag:g} s, the loop is stable at slip "
        f"{problem.slip:g} from {low:.3g} to {high:.3g} km/h: p tau < 1 and (1 - p tau)(c + k) > tau k c.",
        status=Status.REFUTED if failed else Status.EVIDENCE,
        explanation=(
            f"Unstable at {unstable} of {len(speeds)} speeds. Worst at {speed * KMH:.3g} km/h, where "
            f"these are violated: {'; '.join(failed)}. The slip cannot settle inside the layer and swings "
            "through it."
            if failed
            else f"Tightest at {speed * KMH:.3g} km/h. Small deviations of the slip die out despite the lag."
        ),
        margin=Range(low=None, high=float(margins.min()), unit="-"),
        worst_point=where,
        witness=where if failed else (),
        assumptions=("frozen train speed", "nominal parameters", "averaged valve", "no sampling", frozen),
        method=f"Routh's conditions of the linearized loop, {form}",
        resolution=f"{len(speeds)} speeds",
        reference="eqs. (14), (23); findings, section 2, Routh with lag",
        series=(
            series("smallest Routh margin", *axes, speeds, margins.min(axis=0)),
            level("limit", *axes, speeds, 0.0),
        ),
    )


def torque_per_surface(law: AdaptiveFuzzy) -> float:
    """Slope du/ds of the law on the surface, with what it adapts frozen at the start [N m]."""
    gains = law.gains
    step = 1e-3 * gains.boundary_layer
    above, below = (
        torque_demand(gains, side * step, gains.initial_weights, gains.initial_bound) for side in (1.0, -1.0)
    )
    return float(above - below) / (2.0 * step)
