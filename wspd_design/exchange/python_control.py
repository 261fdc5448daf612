"""Plants and laws as systems of python-control: simulate, linearize and connect them with its tools."""

from typing import TYPE_CHECKING, Any

from wspd_design.codegen.functions import quarter_plant
from wspd_design.codegen.laws import law_constants
from wspd_design.controllers.protocol import Law, Measurement, acts_on_vehicle
from wspd_design.model.brake import flow_rates
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.taken import check_rail, check_vehicle
from wspd_design.parameters.units import KMH
from wspd_design.simulation.taken import check_law

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Vector = NDArray[np.float64]

SEEN = Measurement._fields
"""Inputs of a law of one wheelset: train speed [m/s], wheel speed [rad/s], torque [N m]."""
DECIDED = ("fill", "vent")
"""Outputs of a law of one wheelset: shares of the coming sample time."""


def slip_system(vehicle: Vehicle, rail: Rail, *, speed_kmh: float) -> Any:
    """Return slip and torque of one wheelset at a frozen train speed, eq. (19) with the averaged valve.

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        Numbers of the model.
    speed_kmh : float
        Train speed [km/h].

    Returns
    -------
    control.NonlinearIOSystem
        Continuous. Inputs ``fill`` and ``vent``, shares of time [-]; states and outputs ``slip`` [-] and ``torque``
        per wheelset [N m].

    Raises
    ------
    UserError
        If an argument is of another kind or the speed is not above zero.
    """
    import control
    import numpy as np

    check_vehicle(vehicle, by="slip_system", whole=False)
    check_rail(rail, by="slip_system")
    if not 0.0 < speed_kmh < 540.0:
        raise UserError(f"speed_kmh = {speed_kmh:g} must be above 0 and below 540 km/h")
    brake, speed = vehicle.brake, speed_kmh / KMH
    unit = brake.max_torque / brake.max_pressure

    def rates(_time: float, state: "Vector", inputs: "Vector", _params: dict[str, Any]) -> "Vector":
        slip, torque = map(float, state)
        fill, vent = map(float, inputs)
        dynamics = slip_dynamics(vehicle, rail, slip, speed)
        filling, venting = flow_rates(brake, torque / unit)
        slipping = dynamics.drift + dynamics.gain * torque
        return np.array([slipping, unit * (fill * filling - vent * venting)])

    return control.nlsys(
        rates,
        None,
        inputs=list(DECIDED),
        outputs=["slip", "torque"],
        states=["slip", "torque"],
        name=f"slip of {vehicle.name} on {rail.name}",
    )


def quarter_system(vehicle: Vehicle, rail: Rail) -> Any:
    """Return the quarter model, eqs. (1), (2), (8), (9), while the wheel turns.

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        Numbers of the model.

    Returns
    -------
    control.NonlinearIOSystem
        Continuous. Inputs ``fill`` and ``vent`` [-]; states and outputs ``speed`` [m/s], ``wheel_speed`` [rad/s] and
        ``pressure`` [Pa]. Lock and standstill are events, which it does not know.

    Raises
    ------
    UserError
        If an argument is of another kind, or the brake is not that of eqs. (8), (9).
    """
    import control
    import numpy as np

    check_vehicle(vehicle, by="quarter_system", whole=False)
    check_rail(rail, by="quarter_system")
    function = quarter_plant(vehicle, rail)

    def rates(time: float, state: "Vector", inputs: "Vector", _params: dict[str, Any]) -> "Vector":
        return np.array(function(time, state, inputs)).ravel()

    names = ["speed", "wheel_speed", "pressure"]
    return control.nlsys(
        rates,
        None,
        inputs=list(DECIDED),
        outputs=names,
        states=names,
        name=f"quarter of {vehicle.name} on {rail.name}",
    )


def vehicle_system(vehicle: Vehicle, rail: Rail, *, speed_kmh: float, slip: float = 0.0) -> Any:
    """Return the whole multibody vehicle, linearized where it rolls or where brakes hold a slip at all wheelsets.

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        A vehicle with a multibody file, and the friction under it.
    speed_kmh : float
        Train speed [km/h].
    slip : float
        Slip of all wheelsets [-]; 0: they roll.

    Returns
    -------
    control.StateSpace
        Deviations, with the names of :class:`wspd_design.analysis.state_space.VehicleLinearization`: inputs are the
        torques of the axles and the heights of the track under them, outputs speed, wheel speeds, slips and loads.

    Raises
    ------
    UserError
        If an argument is of another kind, the vehicle has no multibody file, or speed or slip are out of range.
    """
    from wspd_design.analysis.running import running_vehicle, steady
    from wspd_design.analysis.state_space import linearization
    from wspd_design.analysis.vehicle_modes import with_totals_of

    check_vehicle(vehicle, by="vehicle_system")
    check_rail(rail, by="vehicle_system")
    model, contact = with_totals_of(vehicle)
    running = steady(running_vehicle(model, contact, rail), speed_kmh / KMH, slip=slip)
    return linearization(running).state_space()


def law_system(law: Law) -> Any:
    """Return a law as a sampled system: its own ``step``.

    Parameters
    ----------
    law : Law
        Of one wheelset, or of a vehicle.

    Returns
    -------
    control.NonlinearIOSystem
        With the sample time of the law. Inputs ``speed`` [m/s], ``wheel_speed`` [rad/s] and ``torque`` [N m], outputs
        ``fill`` and ``vent`` [-]; those of a law of a vehicle have the wheelset behind their names, and the rest of
        what :class:`VehicleMeasurement` has follows. States: what the law remembers; :func:`law_start` returns the
        first one.
    """
    import control
    import numpy as np

    check_law(law, by="law_system")
    kernels = law_constants(law)
    inputs, outputs = seen_names(law), decided_names(law)

    def stepped(state: "Vector", seen: "Vector") -> "Vector":
        return np.array(kernels.step(state, seen, [])).ravel()

    def update(_time: float, state: "Vector", seen: "Vector", _params: dict[str, Any]) -> "Vector":
        return stepped(state, seen)[: kernels.states]

    def output(_time: float, state: "Vector", seen: "Vector", _params: dict[str, Any]) -> "Vector":
        return stepped(state, seen)[kernels.states :]

    return control.nlsys(
        update,
        output,
        inputs=inputs,
        outputs=outputs,
        states=[f"x{k + 1}" for k in range(kernels.states)],
        dt=law.sample_time,
        name=law.name,
    )


def law_start(law: Law, seen: "Vector") -> "Vector":
    """Return the state of a law before the first sample.

    Parameters
    ----------
    law : Law
        The law.
    seen : array_like
        What it sees then, in the order of the inputs of :func:`law_system`.
    """
    import numpy as np

    check_law(law, by="law_start")
    return np.array(law_constants(law).start(seen, [])).ravel()


def linear_law(law: Law, *, state: "Vector", seen: "Vector") -> Any:
    """Return a law linearized about a state and a measurement, by derivatives of CasADi.

    Parameters
    ----------
    law : Law
        The law.
    state : array_like
        What it remembers there.
    seen : array_like
        What it sees there, in the order of the inputs of :func:`law_system`.

    Returns
    -------
    control.StateSpace
        Sampled, for deviations; names as in :func:`law_system`. Where the law switches or is at a limit, it is that
        of this side.
    """
    import casadi as ca
    import control
    import numpy as np

    check_law(law, by="linear_law")
    kernels = law_constants(law)
    x, m = ca.SX.sym("x", kernels.states), ca.SX.sym("m", len(seen_names(law)))
    step = kernels.step(x, m, ca.SX(0, 1))
    function = ca.Function("derivatives", [x, m], [ca.jacobian(step, x), ca.jacobian(step, m)])
    by_state, by_seen = (np.array(each) for each in function(np.asarray(state), np.asarray(seen)))
    n = kernels.states
    return control.ss(
        by_state[:n],
        by_seen[:n],
        by_state[n:],
        by_seen[n:],
        law.sample_time,
        inputs=seen_names(law),
        outputs=decided_names(law),
        states=[f"x{k + 1}" for k in range(n)],
        name=law.name,
    )


def seen_names(law: Law) -> list[str]:
    """Names of what a law sees, in the order of its traced functions."""
    if not acts_on_vehicle(law):
        return list(SEEN)
    of_wheelsets = ("speed", "wheel_speed", "torque", "healthy", "pressure")
    names = [f"{name}_{k}" for name in of_wheelsets for k in range(1, law.wheelsets + 1)]
    return [*names, "acceleration", "demand", "reservoir"]


def decided_names(law: Law) -> list[str]:
    """Names of what a law decides, in the order of its traced functions."""
    if not acts_on_vehicle(law):
        return list(DECIDED)
    return [f"{name}_{k}" for name in DECIDED for k in range(1, law.wheelsets + 1)]
