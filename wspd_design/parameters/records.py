"""The records that carry numbers: plain SI floats, without their history.

The history of each number (unit, source, status) stays with the entry it was loaded from (``provenance``); its bounds
stay with the record. The hashes in designs and certificates contain the names of these records and of this module, so
that a record that moves makes every design of a user outdated.
"""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from wspd_design.parameters.bounds import EXACT, Bounds
from wspd_design.parameters.later import later
from wspd_design.parameters.schema import BuildUp, ValveKind

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from wspd_design.parameters.table import Table


@dataclass(frozen=True, slots=True, kw_only=True)
class Constants:
    """Numbers that belong to no vehicle and no rail: gravity and the conventions near standstill.

    Attributes
    ----------
    gravity : float [m/s2]
    slip_regularization_speed : float [m/s]
        Slip is referred to at least this speed.
    stop_speed : float [m/s]
        A stop ends here.
    time_limit : float [s]
        A stop that takes longer ends without standstill.
    """

    gravity: float
    slip_regularization_speed: float
    stop_speed: float
    time_limit: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Steel:
    """Steel of wheels and rails, and the shape of a rail head."""

    young: float  # Pa, Young's modulus
    poisson: float  # -, Poisson's ratio
    rail_crown: float  # m, radius of the rail head where wheels run


@dataclass(frozen=True, slots=True, kw_only=True)
class Brake:
    """Electro-pneumatic brake of one wheelset, eqs. (8)-(14).

    Attributes
    ----------
    max_torque : float [N m]
        Per wheelset, of an axle with share 1.
    max_pressure : float [Pa]
    supply_rate : float [1/s]
        Build-up of the supply pressure, eq. (8); of the main pipe.
    fill_time : float [s]
        T_F, or the time of the orifice.
    vent_time : float [s]
        T_V, likewise.
    disturbance_gain : float [-]
        Of T_d, the vibration of the pads at the onset of braking.
    disturbance_decay : float [1/s]
    disturbance_frequency : float [Hz]
    build_up : BuildUp
        "main-pipe" or "electro-pneumatic".
    build_up_delay : float [s]
        Until an electro-pneumatic demand rises.
    build_up_ramp : float [s]
        In which it rises evenly to the full pressure.
    valve : ValveKind
        "lag" or "orifice".
    critical_pressure_ratio : float [-]
        Of the orifices, ISO 6358; that of an ideal nozzle.
    hold_leak : float [1/s]
        Rate at which a held cylinder loses its pressure.
    dead_time : float [s]
        From a command to the valve.
    shortest_pulse : float [s]
        That opens a valve.
    longest_release : float [s]
        Without filling, after which the watchdog fills; 0: there is none.
    cylinder_volume : float [m3]
        Of all brake cylinders of one wheelset, with their pipes.
    reservoir_volume : float [m3]
        Of the one reservoir of the vehicle; 0: it does not run low.
    reservoir_pressure : float [Pa]
        Above the atmosphere at the start; 0: max_pressure.
    axle_shares : tuple[float, ...] [-]
        Of max_torque, from the front, 0 without a brake; empty: all 1.
    bounds : Bounds
    """

    max_torque: float
    max_pressure: float
    supply_rate: float = 0.0
    fill_time: float
    vent_time: float
    disturbance_gain: float
    disturbance_decay: float
    disturbance_frequency: float
    build_up: BuildUp = "main-pipe"
    build_up_delay: float = 0.0
    build_up_ramp: float = 0.0
    valve: ValveKind = "lag"
    critical_pressure_ratio: float = 0.528
    hold_leak: float = 0.0
    dead_time: float = 0.0
    shortest_pulse: float = 0.0
    longest_release: float = 0.0
    cylinder_volume: float = 0.0
    reservoir_volume: float = 0.0
    reservoir_pressure: float = 0.0
    axle_shares: tuple[float, ...] = ()
    bounds: Bounds = EXACT

    @property
    def supply_pressure(self) -> float:
        """Pressure of the reservoir at the start, above the atmosphere [Pa]."""
        return self.reservoir_pressure or self.max_pressure


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact:
    """Wheel-rail contact ellipse and elasticity, eq. (6).

    Attributes
    ----------
    shear_modulus : float [Pa]
    semi_axis_rolling : float [m]
        Of the ellipse along the rail, a.
    semi_axis_lateral : float [m]
        Across the rail, b.
    kalker_c11 : float [-]
    reference_load : float [N]
        Wheel load at which a and b are given.
    bounds : Bounds
    """

    shear_modulus: float
    semi_axis_rolling: float
    semi_axis_lateral: float
    kalker_c11: float
    reference_load: float
    bounds: Bounds = EXACT


@dataclass(frozen=True, slots=True, kw_only=True)
class Pads:
    """Friction of the pads or blocks of one wheelset, relative to that behind the torque at full pressure.

    Empty tables stand for friction that does not depend on speed or temperature.

    Attributes
    ----------
    kind : str
        "disc" or "tread".
    speeds : tuple[float, ...] [m/s]
        Of the wheel rim, rising.
    speed_factors : tuple[float, ...] [-]
    temperatures : tuple[float, ...] [K]
        Above that before the stop, rising.
    temperature_factors : tuple[float, ...] [-]
    heat_capacity : float [J/K]
        Per wheelset, of what the friction heats.
    cooling : float [W/K]
        Per wheelset.
    bounds : Bounds
    """

    kind: str = "disc"
    speeds: tuple[float, ...] = ()
    speed_factors: tuple[float, ...] = ()
    temperatures: tuple[float, ...] = ()
    temperature_factors: tuple[float, ...] = ()
    heat_capacity: float = math.inf
    cooling: float = 0.0
    bounds: Bounds = EXACT


@dataclass(frozen=True, slots=True, kw_only=True)
class DynamicBrake:
    """Electrodynamic brake of one wheelset, for which its friction brake stands back.

    Attributes
    ----------
    torque : float [N m]
        Per wheelset, at most.
    power : float [W]
        Per wheelset, at most.
    build_up_time : float [s]
        Time constant with which the torque comes and goes.
    fade_speed : float [m/s]
        Of the wheel rim, below it the torque falls in proportion.
    cut_out_speed : float [m/s]
        Of the wheel rim, where nothing is left of it.
    drop_slip : float [-]
        Beyond it the brake of the wheelset drops out for the rest of the stop.
    axle_shares : tuple[ float, ... ]
        Of torque and power, from the front, 0 without a motor; empty: all 1.
    bounds : Bounds
    """

    torque: float
    power: float = math.inf
    build_up_time: float
    fade_speed: float
    cut_out_speed: float
    drop_slip: float = 1.0
    axle_shares: tuple[float, ...] = ()
    bounds: Bounds = EXACT


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackBrake:
    """Magnetic track brake of the vehicle: magnets that rub on the rails, outside the adhesion of the wheels.

    Attributes
    ----------
    force : float [N]
        Of all magnets.
    build_up_time : float [s]
        Time constant; 0 for a force that is there at once.
    cut_out_speed : float [m/s]
        Below it the magnets are lifted; 0 where they stay down.
    speeds : tuple[float, ...] [m/s]
        Rising.
    speed_factors : tuple[float, ...] [-]
        Of the force.
    bounds : Bounds
    """

    force: float
    build_up_time: float = 0.0
    cut_out_speed: float = 0.0
    speeds: tuple[float, ...] = ()
    speed_factors: tuple[float, ...] = ()
    bounds: Bounds = EXACT


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Vehicle:
    """A vehicle on bogies or single axles, eqs. (1)-(4); what it stands on is told by ``parameters.gear``.

    Attributes
    ----------
    name : str
    mass : float [kg]
    wheelsets : int
    wheel_radius : float [m]
    wheelset_inertia : float [kg m2]
        All that rotates with one wheelset.
    wheel_damping : float [N m s]
        Per wheel at t = 0, B_W.
    wheel_damping_decay : float [1/s]
    resistance_constant : float [N]
        Of the running resistance of the whole vehicle, a0 of eq. (4).
    resistance_linear : float [N s/m]
        The same, a1.
    resistance_quadratic : float [N s2/m2]
        The same, a2.
    body_mass : float [kg]
        Of one body.
    bogie_mass : float [kg]
        Each, complete with its wheelsets; of a single axle, the wheelset with what it carries.
    body_height : float [m]
        Centre of gravity above the rail.
    bogie_height : float [m]
    traction_rod_height : float [m]
    bogie_spacing : float [m]
        Distance of the bogie centres, or of single axles.
    wheelbase : float [m]
        Of one bogie, first to last axle.
    body_pitch_frequency : float [Hz]
    bogie_pitch_frequency : float [Hz]
    pitch_damping_ratio : float [-]
    brake : Brake
    contact : Contact
    axles_per_bogie : int
        1 where single axles carry the body.
    bodies : int
        More than one: an articulated train on as many bogies and one.
    pads : Pads or None
        None: pad friction is constant.
    dynamic : DynamicBrake or None
    track_brake : TrackBrake or None
    multibody : str
        Name or path of the file of the plants with all degrees of freedom; empty: none.
    bounds : Bounds
        Of the numbers above; brake, contact and the like have their own.
    """

    name: str
    mass: float
    wheelsets: int
    wheel_radius: float
    wheelset_inertia: float
    wheel_damping: float
    wheel_damping_decay: float
    resistance_constant: float
    resistance_linear: float
    resistance_quadratic: float
    body_mass: float
    bogie_mass: float
    body_height: float
    bogie_height: float
    traction_rod_height: float
    bogie_spacing: float
    wheelbase: float = 0.0
    body_pitch_frequency: float
    bogie_pitch_frequency: float = 0.0
    pitch_damping_ratio: float
    brake: Brake
    contact: Contact
    axles_per_bogie: int = 2
    bodies: int = 1
    pads: Pads | None = None
    dynamic: DynamicBrake | None = None
    track_brake: TrackBrake | None = None
    multibody: str = ""
    bounds: Bounds = EXACT

    def __repr__(self) -> str:
        """Say in one line what this is."""
        return (
            f"<Vehicle {self.name}: {self.mass / 1e3:g} t, {self.wheelsets} wheelsets, brakes of "
            f"{self.brake.max_torque / 1e3:g} kN m per wheelset>"
        )

    def _repr_html_(self) -> str:
        return str(later("notebook.vehicles", "vehicle_card")(self))

    def table(self) -> "Table":
        """Return all numbers with unit, bounds and meaning; print it or let a notebook show it."""
        table: Table = later("notebook.vehicles", "vehicle_table")(self)
        return table

    @property
    def wheel_inertia(self) -> float:
        """Moment of inertia per wheel, I_W of eq. (2) [kg m2]."""
        return self.wheelset_inertia / 2.0

    @property
    def brake_shares(self) -> tuple[float, ...]:
        """Torque of the brake of each axle over ``brake.max_torque``, from the front; 0 without a brake."""
        return self.brake.axle_shares or (1.0,) * self.wheelsets

    @property
    def dynamic_shares(self) -> tuple[float, ...]:
        """Torque and power of the electrodynamic brake of each axle over those of ``dynamic``; 0 without one."""
        if self.dynamic is None:
            return (0.0,) * self.wheelsets
        return self.dynamic.axle_shares or (1.0,) * self.wheelsets

    @property
    def braked(self) -> tuple[bool, ...]:
        """Tell which axles have a brake on their wheels, of friction or electrodynamic."""
        pairs = zip(self.brake_shares, self.dynamic_shares, strict=True)
        return tuple(friction > 0.0 or dynamic > 0.0 for friction, dynamic in pairs)

    @property
    def brakes_alike(self) -> bool:
        """Tell whether all axles have the same brakes."""
        return len(set(zip(self.brake_shares, self.dynamic_shares, strict=True))) == 1

    def dynamic_of(self, axle: int) -> DynamicBrake | None:
        """Return the electrodynamic brake of one axle, counted from 0 at the front."""
        if self.dynamic is None:
            return None
        share = self.dynamic_shares[axle]
        power = share * self.dynamic.power if share else 0.0
        return replace(self.dynamic, torque=share * self.dynamic.torque, power=power)

    def brake_of(self, axle: int) -> Brake:
        """Return the brake of one axle, counted from 0 at the front; one without a brake has no torque."""
        return replace(self.brake, max_torque=self.brake_shares[axle] * self.brake.max_torque)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Rail:
    """Adhesion of one rail condition by Polach's law, eqs. (5)-(7).

    Attributes
    ----------
    name : str
    mu0 : float [-]
        Friction coefficient without sliding.
    friction_ratio : float [-]
        A = mu_infinity / mu0.
    friction_decay : float [s/m]
        With which the friction falls over the sliding speed, B.
    adhesion_reduction : float [-]
        Of the stiffness while adhering, kA.
    slip_reduction : float [-]
        Of the stiffness while sliding, kS.
    bounds : Bounds
    """

    name: str
    mu0: float
    friction_ratio: float
    friction_decay: float
    adhesion_reduction: float
    slip_reduction: float
    bounds: Bounds = EXACT

    def __repr__(self) -> str:
        """Say in one line what this is."""
        return (
            f"<Rail {self.name}: mu0 {self.mu0:g}, A {self.friction_ratio:g}, B {self.friction_decay:g} s/m, "
            f"kA {self.adhesion_reduction:g}, kS {self.slip_reduction:g}>"
        )

    def _repr_html_(self) -> str:
        return str(later("notebook.vehicles", "rail_card")(self))

    def table(self) -> "Table":
        """Return the coefficients with unit, bounds and meaning."""
        table: Table = later("notebook.vehicles", "rail_table")(self)
        return table

    def plot(
        self,
        vehicle: Vehicle,
        *,
        speeds_kmh: tuple[float, ...] = (20.0, 60.0, 120.0),
        ax: "Axes | None" = None,
    ) -> "Axes":
        """Plot the adhesion over slip under the wheels of a vehicle, a curve for each train speed.

        Parameters
        ----------
        vehicle : Vehicle
            Whose contact and static wheel load count.
        speeds_kmh : tuple of float
            Train speeds [km/h].
        ax : Axes, optional
            Where to draw; new axes by default.

        Returns
        -------
        Axes
            Slip [-] over adhesion [-].
        """
        axes: Axes = later("plotting.rails", "plot_adhesion")(self, vehicle, speeds_kmh=speeds_kmh, ax=ax)
        return axes


@dataclass(frozen=True, slots=True, kw_only=True)
class RailProfile:
    """Rails one after the other along the track, each from its start on.

    Attributes
    ----------
    name : str
    starts : tuple[float, ...] [m]
        Rising from 0.
    rails : tuple[str, ...]
        Names or paths.
    """

    name: str
    starts: tuple[float, ...]
    rails: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class PaperGains:
    """The gains that Section 7 of the paper prints for its adaptive fuzzy sliding-mode controller."""

    proportional_gain: float  # K_P
    integral_gain: float  # K_I
    weight_rate: float  # alpha_1
    bound_rate: float  # alpha_2
    initial_weights: tuple[float, ...]  # b_hat(0)
    initial_bound: float  # psi_hat(0)
    centres: tuple[float, ...]  # of the membership functions, in s
    widths: tuple[float, ...]
    boundary_layer: float  # Phi, in s
    torque_unit: float  # N m, what one unit of u stands for


@dataclass(frozen=True, slots=True, kw_only=True)
class TrenitaliaTable:
    """Thresholds and pulses of the Trenitalia controller, eq. (16) and Table 3."""

    lower_speed_ratio: float  # V_min / v
    upper_speed_ratio: float  # V_max / v
    acceleration_limit: float  # m/s2, ACC
    deceleration_limit: float  # m/s2, DEC
    fill_pulse: float  # share of the sample time
    vent_pulse: float  # share of the sample time


@dataclass(frozen=True, slots=True, kw_only=True)
class KnorrBremseTable:
    """Slide regions, acceleration limits and decisions of the Knorr-Bremse controller, eqs. (17)-(18)."""

    slide_slopes: tuple[float, ...]  # -, of each region limit over train speed
    slide_offsets: tuple[float, ...]  # m/s
    slide_caps: tuple[float, ...]  # m/s, above 60 km/h
    acceleration_limits: tuple[float, ...]  # m/s2, rising
    decisions: tuple[tuple[float, ...], ...]  # row: acceleration, column: slide region; + fill, - vent
    pulses: tuple[float, ...]  # share of the sample time for |u| = 0..3


@dataclass(frozen=True, slots=True, kw_only=True)
class MitsubishiTable:
    """Membership centres and rules of the Mitsubishi fuzzy controller, Table 5."""

    slide_centres: tuple[float, ...]  # m/s
    rate_centres: tuple[float, ...]  # m/s2, of d sigma/dt
    rules: tuple[tuple[float, ...], ...]  # output level y; row: rate, column: slide
    duty_offset: float
    duty_gain: float


@dataclass(frozen=True, slots=True, kw_only=True)
class SpectrumCoefficients:
    """Coefficients of one track irregularity spectrum S(W), eq. (49), with W in rad/m.

    S is in m2/(rad/m) for displacements and in rad2/(rad/m) for the cross level.
    """

    beta0: float
    beta2: float
    gamma0: float
    gamma2: float
    gamma4: float
    gamma6: float


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackSpectrum:
    """Spectra of the track irregularities of one line quality set, eq. (49) and Table 9."""

    name: str
    rows: dict[str, SpectrumCoefficients]  # by direction and level, such as "vertical-high"
    shortest_wavelength: float  # m
    longest_wavelength: float  # m
    one_sided: bool  # the whole variance lies at W > 0
