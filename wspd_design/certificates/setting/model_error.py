"""What the design model of a sliding-mode law does not know of the plant: r and rho of the reaching condition.

With Psi = v F and rho = (inertia of the design model) / (true inertia) the law makes
v sbar' = r - rho W0 sat(sbar / layer), r = (1 - rho) v c e - Psi + rho Psi_hat at a constant reference.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from wspd_design.certificates.kernel.claim import Variable
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.adhesion_edges import Ranges
from wspd_design.certificates.setting.domain import BASIC, INERTIA, SLIP, SPEED
from wspd_design.certificates.setting.plant import (
    Values,
    complete,
    model_forces,
    model_variables,
    plant_dynamics,
    plant_forces,
    plant_variables,
    records_of,
)
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import Number
from wspd_design.model.slip import slip_dynamics

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array


class Mismatch(NamedTuple):
    """What the design model of a law does not know of the plant."""

    residual: "Array"  # m/s2, r
    inertia_ratio: "Array"  # -, rho


def mismatch(
    problem: Problem, law: SlidingMode, points: "Array", others: Mapping[str, float] | None = None
) -> Mismatch:
    """Evaluate r and rho at points of the domain.

    Parameters
    ----------
    problem : Problem
        The closed loop.
    law : SlidingMode
        With its design model.
    points : ndarray
        Columns as in ``domain.BASIC``.
    others : mapping, optional
        Further numbers of the plant that are not nominal, by their names in the table.
    """
    slip, speed = points[:, SLIP], points[:, SPEED]
    columns = {name: points[:, k] for k, name in enumerate(BASIC)}
    plant = plant_dynamics(problem, complete(problem, {**(others or {}), **columns}))
    model = slip_dynamics(law.vehicle, law.rail, slip, speed)
    ratio = law.vehicle.wheelset_inertia / points[:, INERTIA]
    error = sliding_surface.slip_error(law.gains.slip_reference, slip)
    closing = (1.0 - ratio) * speed * law.gains.surface_rate * error
    return Mismatch(residual=closing - speed * plant.drift + ratio * speed * model.drift, inertia_ratio=ratio)


def variables(
    problem: Problem, law: SlidingMode, *, uses: Sequence[str], hold: Iterable[str], ranges: Ranges
) -> tuple[Variable, ...]:
    """Return the quantities of plant and design model, as in :func:`plant_variables`."""
    plant = plant_variables(problem, uses=uses, hold=hold, ranges=ranges)
    return plant + model_variables(law.vehicle, law.rail)


def inertia_ratio(x: Values) -> Number:
    """Return rho [-]."""
    return x["model wheelset inertia"] / x["wheelset inertia"]


def residual(problem: Problem, law: SlidingMode, x: Values) -> Number:
    """Return r from the kernels [m/s2]."""
    model = slip_dynamics(*records_of(x, law.vehicle, law.rail, "model "), x["slip"], x["speed"])
    ratio, speed = inertia_ratio(x), x["speed"]
    error = sliding_surface.slip_error(law.gains.slip_reference, x["slip"])
    closing = (1.0 - ratio) * speed * law.gains.surface_rate * error
    return closing - speed * plant_dynamics(problem, x).drift + ratio * speed * model.drift


def residual_over_ratio(problem: Problem, law: SlidingMode, x: Values) -> Number:
    """Return r / rho, arranged so that the inertia of the plant stands in few places [m/s2]."""
    plant, model = plant_forces(problem, x), model_forces(x, law.vehicle, law.rail)
    slip, speed = x["slip"], x["speed"]
    inverse = x["wheelset inertia"] / x["model wheelset inertia"]
    error = sliding_surface.slip_error(law.gains.slip_reference, slip)
    torque = plant.creep_force * x["wheel radius"] ** 2 - model.creep_force * x["model wheel radius"] ** 2
    damping = speed * (1.0 - slip) * (x["model wheel damping"] - x["wheel damping"])
    closing = (inverse - 1.0) * speed * law.gains.surface_rate * error
    slowing = (1.0 - slip) * (inverse * plant.deceleration - model.deceleration)
    return closing + (torque + damping) * 2.0 / x["model wheelset inertia"] + slowing
