"""Points at which sentences of version 0.1.0 were false, with the right values: inputs for whoever mends the claims.

Speeds in m/s unless a name ends in ``kmh``. ``test_counterexamples.py`` computes every number again by equations that
share nothing with the package. The names A1 to A9 are those of the audit.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from tests.attack.case import Bounds, Case, read_data
from tests.attack.plant import Plant, creep_force, gain, slip_pole

# --- the designs that were audited, as files of their own would state them

SMC = {
    "surface_rate": 0.3846153846153846,
    "switching_gain": 9.646990353291994,
    "boundary_layer": 0.025,
}
TORQUE_FEEDBACK = {
    "polach-wet": {"sliding_gain": 3.907810377265587, "torque_gain": 29.0},
    "polach-dry": {"sliding_gain": 13.977711672243533, "torque_gain": 29.0},
    "coach": {"sliding_gain": 5.522570702056442, "torque_gain": 14.0},
}
SPEEDS, SLIPS, REFERENCE = (10.0 / 3.6, 120.0 / 3.6), (0.02, 0.6), 0.14


def smc(rail: str = "polach-wet", free: Bounds | None = None) -> Case:
    """Return the sliding-mode law of the paper's vehicle, sampled every 100 ms."""
    return _case("smc", SMC, 0.1, rail, free)


def torque_feedback(rail: str = "polach-wet", free: Bounds | None = None) -> Case:
    """Return the law with torque feedback of the paper's vehicle, sampled every 20 ms."""
    return _case("torque-feedback", TORQUE_FEEDBACK[rail], 0.02, rail, free)


def _case(law: str, gains: dict[str, float], sample_time: float, rail: str, free: Bounds | None) -> Case:
    data = read_data("er24pc", rail)
    return Case(
        law=law,
        gains=gains,
        slip=REFERENCE,
        speeds=SPEEDS,
        slips=SLIPS,
        tolerance=0.05,
        sample_time=sample_time,
        model=data.plant,
        data=type(data)(plant=data.plant, body=data.body, bounds=data.bounds | (free or {})),
    )


# --- A1: laws on the slip alone that are stable where "no law" was said to be


@dataclass(frozen=True, slots=True, kw_only=True)
class SlipOnly:
    """A law with a memory of its own at a frozen speed on the dry rail, and the poles of its loop [1/s]."""

    kind: str  # lead filter, or internal copy of the valve
    speed: float  # m/s
    poles: tuple[complex, ...]


SLIP_ONLY = (
    SlipOnly(kind="lead", speed=5.0, poles=(-6.0, -6.0, -1.0 / 0.6)),
    SlipOnly(kind="lead", speed=10.0, poles=(-6.0, -6.0, -1.0 / 0.6)),
    SlipOnly(kind="lead", speed=20.0, poles=(-6.0, -6.0, -1.0 / 0.6)),
    SlipOnly(kind="lead", speed=26.0, poles=(-6.0, -6.0, -1.0 / 0.6)),
    SlipOnly(kind="copy", speed=5.0, poles=(-4.206 + 9.608j, -4.206 - 9.608j, -1.0 / 0.6)),
    SlipOnly(kind="copy", speed=20.0, poles=(-7.663 + 7.161j, -7.663 - 7.161j, -1.0 / 0.6)),
)


def slip_only_loop(kind: str, plant: Plant, speed: float, *, lag: float = 0.6) -> tuple[Any, float]:
    """Matrix of the loop in (e, torque error, memory) at frozen speed, and the trace of the law's own memory.

    The lead filter z' = -b z + e has b = p + 12 and a gain that puts a double pole at -6; the copy of the valve
    z' = (u - z)/lag commands u = kappa e - K z with K = 10. Both read the slip and nothing else.
    """
    p, g = float(slip_pole(plant, REFERENCE, speed)), float(gain(plant, speed))
    if kind == "lead":
        b = p + 12.0
        k = lag * (p * b + 36.0) / g
        rows = [[p, -g, 0.0], [k / lag, -1.0 / lag, k * (1.0 / lag - b) / lag], [1.0, 0.0, -b]]
        return np.array(rows), -b
    feedback = 10.0
    kappa = (1.0 + feedback) * (p + 6.0) / g
    own = -(1.0 + feedback) / lag
    rows = [[p, -g, 0.0], [kappa / lag, -1.0 / lag, -feedback / lag], [kappa / lag, 0.0, own]]
    return np.array(rows), own


# --- A2: the equilibrium of a law without an integral, off the nominal parameters


@dataclass(frozen=True, slots=True, kw_only=True)
class Equilibrium:
    """Where the loop with torque feedback settles at a frozen speed, averaged valve with equal lags."""

    rail: str
    speed: float  # m/s
    mass: float  # kg
    wheelset_inertia: float  # kg m2
    mu0: float
    slip: float  # of the equilibrium


EQUILIBRIA = (
    Equilibrium(rail="polach-wet", speed=2.8, mass=61473.0, wheelset_inertia=640.0, mu0=0.24, slip=0.8175),
    Equilibrium(rail="polach-wet", speed=5.0, mass=61473.0, wheelset_inertia=640.0, mu0=0.24, slip=0.4831),
    Equilibrium(rail="polach-wet", speed=2.8, mass=92209.0, wheelset_inertia=860.0, mu0=0.36, slip=0.0275),
)

# --- A3: subclasses that command something else


def braking_always(law: Any) -> Any:
    """Return a law of a subclass of the class of ``law``, with all its numbers, that always brakes fully."""
    from wspd_design.controllers.protocol import Command

    def step(_self: Any, state: Any, _measurement: Any) -> tuple[Any, Any]:
        return state, Command(fill=1.0, vent=0.0)

    kind = type(law)
    evil = type(f"Always{kind.__name__}", (kind,), {"step": step, "__slots__": ()})
    return evil(**{name: getattr(law, name) for name in kind.__dataclass_fields__})


# --- A4: a rail of the same name with other numbers

OTHER_WET = {"mu0": 0.42, "mu0_bounds": (0.41, 0.43)}  # needs W0 15.2 m/s2, the design has 9.65

# --- A5: load shares of the axles

LOAD_SHARES = (1.165, 0.924, 1.067, 0.844)  # of the ER24PC at adhesion 0.27
REPELLED = {"slip": 0.222, "speed": 10.0 / 3.6, "mass": 92209.0, "wheelset_inertia": 860.0, "mu0": 0.36}
REPULSION = {1.0: -0.370, 1.10: 2.088, 1.15: 3.314}  # v sbar' at sbar > Phi by load share [m/s2]; must be < 0
GAIN_BY_LOAD = {  # W0 that is needed, by range of the load share and of the train's deceleration [m/s2]
    ((1.0, 1.0), (0.5, 3.6)): 9.89,
    ((0.85, 1.15), (0.5, 3.6)): 14.10,
    ((0.8, 1.2), (0.3, 3.6)): 15.50,
}

# --- A6: starts from which the boundary layer is not reached


@dataclass(frozen=True, slots=True, kw_only=True)
class Departure:
    """A run with T = u of the sliding-mode law and where it has come to at its end."""

    start_kmh: float
    slip: float
    integral: float  # of e, s
    mass: float
    wheelset_inertia: float
    mu0: float
    end_kmh: float
    end_slip: float
    end_surface: float  # sbar; the layer is 0.025 wide


DEPARTURES = (
    Departure(
        start_kmh=11.0,
        slip=0.6,
        integral=0.0,
        mass=61473.0,
        wheelset_inertia=860.0,
        mu0=0.24,
        end_kmh=10.0,
        end_slip=0.462,
        end_surface=-0.343,
    ),
    Departure(  # the error is 0 at the start and -0.315 when the surface is reached
        start_kmh=72.0,
        slip=0.14,
        integral=1.0,
        mass=76841.0,
        wheelset_inertia=752.0,
        mu0=0.3,
        end_kmh=67.44,
        end_slip=0.455,
        end_surface=0.025,
    ),
)

# --- A7: numbers with bounds that were held

RAIL_AND_RADIUS = ("friction_ratio", "friction_decay", "adhesion_reduction", "slip_reduction", "wheel_radius")
GAIN_BY_RAIL = 10.87  # m/s2, W0 that is needed over those as well; the design has 9.65
UNSTABLE_CORNER = {"fill_time": 0.3, "vent_time": 0.3, "max_torque": 68.7e3}  # inside the file's bounds
UNSTABLE_RADIUS = {"polach-wet": 1.22, "polach-dry": 1.25}  # of the sampled loop there, at least


# --- A7b: venting faster than filling


def coach(vent_time: float) -> Case:
    """Return a coach with T_F 0.3 s and another T_V on low adhesion, its torque feedback designed for 0.3 s."""
    data = read_data("er24pc", "low-adhesion")
    plant = data.plant.with_numbers(
        {
            "mass": 45e3,
            "wheel_radius": 0.46,
            "wheelset_inertia": 130.0,
            "resistance_constant": 600.0,
            "resistance_linear": 8.0,
            "resistance_quadratic": 1.6,
            "max_torque": 6600.0,
            "fill_time": 0.3,
            "vent_time": vent_time,
            "semi_axis_rolling": 6.0e-3,
            "semi_axis_lateral": 4.6e-3,
            "reference_load": 55181.0,
        }
    )
    return Case(
        law="torque-feedback",
        gains=TORQUE_FEEDBACK["coach"],
        slip=REFERENCE,
        speeds=(10.0 / 3.6, 160.0 / 3.6),
        slips=SLIPS,
        tolerance=0.05,
        sample_time=0.02,
        model=plant,
        data=type(data)(plant=plant, body=data.body, bounds={}),
    )


FAST_VENT_SPEED = 40.0 / 3.6
FAST_VENT = {0.10: -0.949, 0.09: -1.130, 0.08: -1.355}  # eigenvalue of the sampled map by T_V
SWINGING = {
    "fill_time": 0.6,
    "vent_time": 0.15,
}  # s, of the ER24PC: the duty swings without end at 5, 10, 20 m/s
SWINGING_SPEEDS, CALM_SPEED = (5.0, 10.0, 20.0), 30.0

# --- A8: load transfer that raises the sum of the adhesion peaks


@dataclass(frozen=True, slots=True, kw_only=True)
class PeakSum:
    """A rail on which unequal loads raise the sum of the peaks; the schema allows it."""

    mu0: float
    friction_ratio: float
    friction_decay: float
    adhesion_reduction: float
    slip_reduction: float
    speed: float  # m/s
    transfer: float  # of the load, up at one axle and down at the other
    rise: float  # relative, at least


PEAK_SUMS = (
    PeakSum(
        mu0=0.42,
        friction_ratio=0.15,
        friction_decay=0.6,
        adhesion_reduction=0.245,
        slip_reduction=0.15 * 0.245,
        speed=57.0 / 3.6,
        transfer=0.3,
        rise=0.0070,
    ),
    PeakSum(  # adhesion that falls and rises again with the slip: kS is far below kA
        mu0=0.3124,
        friction_ratio=0.563,
        friction_decay=0.0,
        adhesion_reduction=1.0,
        slip_reduction=0.00144,
        speed=10.0,
        transfer=0.3,
        rise=0.0335,
    ),
)


def peak_rise(plant: Plant, speed: float, transfer: float) -> float:
    """Return how much two axles with unequal loads hold at most above two with equal ones, relative."""
    slips = np.geomspace(1e-4, 1.0, 20001)
    own = plant.mass * 9.81 / 8.0

    def peak(load: float) -> float:
        return float(np.max(creep_force(plant, slips, speed, load)))

    return (peak((1.0 + transfer) * own) + peak((1.0 - transfer) * own)) / (2.0 * peak(own)) - 1.0


# --- A9: runs of the adaptive law that leave the slips that its theorems speak about

ADAPTIVE = {
    "initial_weights": [27.739821064748522] * 5,
    "initial_bound": 13.190066810319234,
}  # of the audited law
LEAVES = {"mass": 61473.0, "wheelset_inertia": 860.0, "mu0": 0.30, "start": 0.39, "highest": 0.425}
FALLS = {"mass": 61473.0, "wheelset_inertia": 860.0, "mu0": 0.24, "start": 0.02, "lowest": 0.0145}
