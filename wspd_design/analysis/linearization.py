"""The slip dynamics linearized at a slip ratio and a train speed."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from wspd_design.codegen.functions import slip_plant
from wspd_design.model.brake import flow_rates
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.later import later
from wspd_design.parameters.records import Brake, Rail, Vehicle
from wspd_design.parameters.taken import check_numbers, check_rail, check_vehicle, notice_of_speed
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from wspd_design.parameters.table import Table

STATES = ("slip", "torque")


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Linearization:
    """Slip and torque near an equilibrium at frozen train speed: x' = A x + B duty.

    The states are the deviations of slip [-] and of the torque per wheelset [N m]. The train speed changes
    slowly against the slip and is held; ``equilibrium_torque`` keeps the slip there.

    Attributes
    ----------
    vehicle : str
    rail : str
    slip : float [-]
    speed : float [m/s]
    equilibrium_torque : float [N m]
        Per wheelset.
    equilibrium_duty : float [-]
        Where the brake cannot hold this slip its torque over T_max, above 1.
    slip_pole : float [1/s]
        Without the valve lag.
    gain : float [1/(N m s)]
        Of the torque, G.
    time_constant : float [s]
        Of the averaged valve at this duty and torque; of lags between T_F and T_V.
    state_matrix : ndarray [1/s, 1/(N m s), N m/s, 1/s]
        A, 2 by 2, row by row.
    input_matrix : ndarray [1/s, N m/s]
        B, 2 by 1.
    """

    vehicle: str
    rail: str
    slip: float
    speed: float
    equilibrium_torque: float
    equilibrium_duty: float
    slip_pole: float
    gain: float
    time_constant: float
    state_matrix: "NDArray[np.float64]"
    input_matrix: "NDArray[np.float64]"

    def __repr__(self) -> str:
        """Say in one line what this is."""
        return (
            f"<Linearization of {self.vehicle} on {self.rail} at slip {self.slip:g} and {KMH * self.speed:g} km/h: "
            f"slip pole {self.slip_pole:.4g} 1/s>"
        )

    def _repr_html_(self) -> str:
        return str(later("notebook.linearizations", "linearization_card")(self))

    def table(self) -> "Table":
        """Return equilibrium, poles and gain with their units."""
        table: Table = later("notebook.linearizations", "linearization_table")(self)
        return table

    def plot(self, *, ax: "Axes | None" = None) -> "Axes":
        """Plot the open-loop poles in the complex plane.

        Parameters
        ----------
        ax : Axes, optional
            Where to draw; new axes by default.

        Returns
        -------
        Axes
            Real over imaginary part [1/s].
        """
        axes: Axes = later("plotting.poles", "plot_linearization")(self, ax=ax)
        return axes

    def poles(self, *, with_lag: bool = True) -> tuple[float, ...]:
        """Open-loop poles [1/s], fastest growing first; ``with_lag`` includes the valve."""
        if not with_lag:
            return (self.slip_pole,)
        import numpy as np

        return tuple(sorted((float(p.real) for p in np.linalg.eigvals(self.state_matrix)), reverse=True))

    def state_space(self, *, with_lag: bool = True) -> Any:
        """Return a ``control.StateSpace`` from duty (or, without lag, torque [N m]) to slip."""
        import control
        import numpy as np

        if with_lag:
            return control.ss(
                self.state_matrix,
                self.input_matrix,
                np.array([[1.0, 0.0]]),
                0.0,
                states=list(STATES),
                inputs=["duty"],
                outputs=["slip"],
                name="slip_plant",
            )
        return control.ss(
            [[self.slip_pole]],
            [[self.gain]],
            [[1.0]],
            0.0,
            states=["slip"],
            inputs=["torque"],
            outputs=["slip"],
            name="slip_plant_without_lag",
        )


def _holding_duty(brake: Brake, share: float) -> float:
    """Duty at which the averaged valve holds a share of the maximum torque, from 0 to 1."""
    if brake.valve == "lag":
        return share * brake.fill_time / ((1.0 - share) * brake.vent_time + share * brake.fill_time)
    filling, venting = flow_rates(brake, share * brake.max_pressure)
    return float(venting / (filling + venting))


def linearize(
    vehicle: Vehicle, rail: Rail, *, slip: float, speed: float | None = None, speed_kmh: float | None = None
) -> Linearization:
    """Linearize eqs. (19) and (14) at a slip ratio and a train speed.

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        Quarter model and friction.
    slip : float
        Slip ratio in (0, 1).
    speed : float, optional
        Train speed, positive [m/s].
    speed_kmh : float, optional
        The same in km/h, in place of ``speed``.

    Returns
    -------
    Linearization
        With Jacobians from CasADi, exact up to rounding.

    Raises
    ------
    UserError
        If an argument is of another kind, or slip or speed are outside their range.
    """
    check_vehicle(vehicle, by="linearize", whole=False)
    check_rail(rail, by="linearize")
    numbers = {"slip": (slip, ""), "speed": (speed, "m/s"), "speed_kmh": (speed_kmh, "km/h")}
    check_numbers("linearize", numbers)
    if (speed is None) == (speed_kmh is None):
        raise UserError("linearize takes one speed: speed=22.2 in m/s, or speed_kmh=80")
    if speed_kmh is not None:
        return linearized(vehicle, rail, slip=slip, speed=speed_kmh / KMH)
    assert speed is not None
    found = linearized(vehicle, rail, slip=slip, speed=speed)
    notice_of_speed(speed, "speed", f"for {speed:g} km/h write speed_kmh={speed:g}")
    return found


def linearized(vehicle: Vehicle, rail: Rail, *, slip: float, speed: float) -> Linearization:
    """Linearize at a train speed that is surely in m/s; otherwise as :func:`linearize`."""
    import numpy as np

    if not 0.0 < slip < 1.0:
        raise UserError(f"slip = {slip:g} must lie in (0, 1); for percent write for example 0.14 or 14 %")
    if not 0.0 < speed < 150.0:
        raise UserError(f"speed = {speed:g} m/s must be above 0 and below 150 m/s (540 km/h)")
    brake = vehicle.brake
    plant = slip_plant(vehicle, rail)
    drift, gain = (float(x) for x in plant.drift_and_gain(slip, speed))
    torque = -drift / gain
    share = torque / brake.max_torque
    # A torque that the brake does not have is asked of a valve at its limit, which fills or vents all the time.
    held = min(max(share, 0.0), 1.0)
    duty = _holding_duty(brake, held)
    a, b = plant.jacobians(slip, torque, speed, duty)
    a, b = np.array(a, dtype=np.float64), np.array(b, dtype=np.float64)
    return Linearization(
        vehicle=vehicle.name,
        rail=rail.name,
        slip=slip,
        speed=speed,
        equilibrium_torque=torque,
        equilibrium_duty=duty if held == share else share,
        slip_pole=float(a[0, 0]),
        gain=gain,
        time_constant=float(-1.0 / a[1, 1]),
        state_matrix=a,
        input_matrix=b,
    )
