"""Preloads with which a vehicle is at rest where its places are: no static run is needed.

The vertical forces of all springs that carry, and of all wheels, that hold every body: of the many that do, those with
the least sum of squares. Where the two wheels of an axle carry different loads, their cones push the wheelset sideways;
at rest the rails hold it by friction, with a force that stays.
"""

from typing import Any

from wspd_design.parameters.errors import UserError
from wspd_design.plants.multibody.mechanics import mechanics
from wspd_design.plants.multibody.records import Multibody
from wspd_design.plants.multibody.wheels import Wheel

_HELD = 1e-9  # of the weight: what may be left of it in any coordinate


def balanced(model: Multibody, rest: Any = None) -> Multibody:
    """Return the vehicle with the preloads that hold it at rest.

    Parameters
    ----------
    model : Multibody
        With numbers.
    rest : casadi.Function, optional
        What :func:`rest_function` made for this topology, where many are balanced.

    Raises
    ------
    UserError
        If nothing holds some body.
    """
    import numpy as np

    pull, load = at_rest(model, rest)
    forces, *_ = np.linalg.lstsq(load, -pull, rcond=None)
    forces -= np.linalg.lstsq(load, pull + load @ forces, rcond=None)[0]  # once more, for the last digits
    left = np.abs(pull + load @ forces)
    weight = model.numbers["mass"]
    if left.max() > _HELD * weight:
        k = int(left.argmax())
        raise UserError(
            f"nothing in multibody vehicle {model.name} holds {model.coordinates[k]} against the weight "
            f"({left[k]:.3g} N or N m are left); let a spring with a vertical stiffness carry there."
        )
    return model.with_preloads(dict(zip(model.preload_names, forces.tolist(), strict=True)))


def at_rest(model: Multibody, rest: Any = None) -> tuple[Any, Any]:
    """Return the generalized forces at rest without preloads [n], and those of 1 N of each preload [n x preloads]."""
    import numpy as np

    values = (rest or rest_function(model))(list(model.numbers.values()))
    pull, load = (np.array(value) for value in values)
    return pull[:, 0], load


def rest_function(model: Multibody) -> Any:
    """Return :func:`at_rest` as a CasADi function of the numbers of a topology, in their order."""
    import casadi as ca

    names, n, given = model.preload_names, len(model.coordinates), ca.SX.sym("given", len(model.numbers))
    q, v, p = ca.SX.sym("q", n), ca.SX.sym("v", n), ca.SX.sym("p", len(names))
    loaded_model = model.with_numbers(
        dict(zip(model.numbers, ca.vertsplit(given), strict=True))
    ).with_preloads(dict(zip(names, ca.vertsplit(p), strict=True)))
    loaded = mechanics(loaded_model, q, v)
    force = loaded.force
    for wheel in loaded.wheels:
        force[wheel.first : wheel.first + 6] += force_at_rest(loaded_model, wheel)
    state = ca.vertcat(q, v, p)
    placed = ca.substitute([force, ca.jacobian(force, p)], [state], [ca.SX.zeros(state.size1())])
    return ca.Function("rest", [given], [ca.densify(each) for each in placed])


def force_at_rest(model: Multibody, wheel: Wheel) -> Any:
    """Return what a wheel puts on the coordinates of its wheelset at rest [6]: its load, and half of what holds it."""
    name = model.wheelset_names[wheel.axle]
    load, sideways = model.preloads[f"{name}.{wheel.side}"], model.preloads[f"{name}.sideways"]
    return -wheel.approach_row.T * load + wheel.displacement_row.T * (0.5 * sideways)
