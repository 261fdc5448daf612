"""What each kind of parameter file must contain: names, dimensions, shapes and admissible ranges.

The ranges say what is physically possible at all. How far a number is uncertain is said by the ``bounds`` of
the file.
"""

import math
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias, get_args

from wspd_design.parameters.units import Dimension

Shape: TypeAlias = Literal["number", "word", "words", "vector", "matrix", "word matrix"]
Kind: TypeAlias = Literal["constants", "vehicle", "rail", "controller", "track"]
Preset: TypeAlias = Literal["calibrated", "textbook"]
BuildUp: TypeAlias = Literal["main-pipe", "electro-pneumatic"]
ValveKind: TypeAlias = Literal["lag", "orifice"]

PRESETS: tuple[Preset, ...] = ("calibrated", "textbook")
"""Two reconstructions of each baseline: fitted to Table 10, or from conventional practice."""

MITSUBISHI_LEVELS = ("DB", "DM", "DS", "ZO", "IS", "IM", "IB")
"""Output levels of Table 5, from the largest decrease to the largest increase of pressure."""

TRACK_ROWS = tuple(
    f"{row}-{level}" for row in ("lateral", "vertical", "cross-level") for level in ("high", "low")
)
"""Spectra of a track file: direction and level."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantity:
    """What is expected of one entry of a file; the range is in SI units.

    What is optional may be left out, and then the record takes its own default.
    """

    dimension: Dimension
    shape: Shape = "number"
    low: float = -math.inf
    high: float = math.inf
    low_is_allowed: bool = True
    plausible: tuple[float, float] | None = None  # what railways have, with room to spare
    words: tuple[str, ...] = ()  # that a word may be; none: any
    optional: bool = False

    def admits(self, value: float) -> bool:
        """Tell whether an SI value is physically possible."""
        above = value >= self.low if self.low_is_allowed else value > self.low
        return above and value <= self.high

    @property
    def range_text(self) -> str:
        """The admissible range in words."""
        if math.isfinite(self.high):
            return f"in {'[' if self.low_is_allowed else '('}{self.low:g}, {self.high:g}]"
        return "at least 0" if self.low_is_allowed else "above 0"


Schema: TypeAlias = dict[str, Quantity]


def _any(dimension: Dimension, shape: Shape = "number") -> Quantity:
    return Quantity(dimension=dimension, shape=shape)


def _positive(
    dimension: Dimension, shape: Shape = "number", *, plausible: tuple[float, float] | None = None
) -> Quantity:
    return Quantity(dimension=dimension, shape=shape, low=0.0, low_is_allowed=False, plausible=plausible)


def _not_negative(dimension: Dimension, shape: Shape = "number") -> Quantity:
    return Quantity(dimension=dimension, shape=shape, low=0.0)


def _share(shape: Shape = "number", *, zero: bool = True) -> Quantity:
    least = None if zero else (1e-4, 1.0)  # what must not vanish is not next to nothing either
    return Quantity(dimension="ratio", shape=shape, low=0.0, high=1.0, low_is_allowed=zero, plausible=least)


def _at_most(dimension: Dimension, largest: float) -> Quantity:
    return Quantity(dimension=dimension, low=0.0, plausible=(0.0, largest))


def _optional(quantity: Quantity) -> Quantity:
    return replace(quantity, optional=True)


def _word(*words: str) -> Quantity:
    return Quantity(dimension="ratio", shape="word", words=words, optional=True)


_CONSTANTS: Schema = {
    "gravity": _positive("acceleration"),
    "slip_regularization_speed": _positive("speed"),
    "stop_speed": _positive("speed"),
    "time_limit": _positive("time"),
}

_STEEL: Schema = {
    "young": _positive("pressure"),
    "poisson": Quantity(dimension="ratio", low=0.0, high=0.5),
    "rail_crown": _positive("length"),
}

_FURTHER_BRAKES: Schema = {
    "pads.kind": Quantity(dimension="ratio", shape="word", words=("disc", "tread")),
    "pads.speeds": _not_negative("speed", "vector"),
    "pads.speed_factors": _positive("ratio", "vector", plausible=(0.01, 10.0)),
    "pads.temperatures": _not_negative("temperature", "vector"),
    "pads.temperature_factors": _positive("ratio", "vector", plausible=(0.01, 10.0)),
    "pads.heat_capacity": _positive("heat capacity", plausible=(1e3, 1e7)),
    "pads.cooling": _not_negative("heat flow"),
    "dynamic.torque": _positive("torque", plausible=(100.0, 1e6)),
    "dynamic.power": _positive("power", plausible=(1e3, 1e7)),
    "dynamic.build_up_time": _positive("time", plausible=(0.01, 10.0)),
    "dynamic.fade_speed": _positive("speed"),
    "dynamic.cut_out_speed": _positive("speed"),
    "dynamic.drop_slip": _share(zero=False),
    "dynamic.axle_shares": _not_negative("ratio", "vector"),
    "track_brake.force": _positive("force", plausible=(1e3, 1e6)),
    "track_brake.build_up_time": _not_negative("time"),
    "track_brake.cut_out_speed": _not_negative("speed"),
    "track_brake.speeds": _not_negative("speed", "vector"),
    "track_brake.speed_factors": _positive("ratio", "vector", plausible=(0.01, 10.0)),
}

_VEHICLE: Schema = {
    "mass": _positive("mass", plausible=(2e3, 1e6)),
    "wheelsets": Quantity(dimension="ratio", low=1.0, high=32.0),
    "axles_per_bogie": Quantity(dimension="ratio", low=1.0, high=3.0, optional=True),
    "bodies": Quantity(dimension="ratio", low=1.0, high=31.0, optional=True),
    "multibody": _word(),
    "wheel_radius": _positive("length", plausible=(0.1, 1.5)),
    "wheelset_inertia": _positive("inertia", plausible=(5.0, 1e4)),
    "wheel_damping": _not_negative("rotational damping"),
    "wheel_damping_decay": _not_negative("rate"),
    "resistance_constant": _not_negative("force"),
    "resistance_linear": _not_negative("linear resistance"),
    "resistance_quadratic": _not_negative("quadratic resistance"),
    "body_mass": _positive("mass", plausible=(1e3, 1e6)),
    "bogie_mass": _positive("mass", plausible=(100.0, 1e5)),
    "body_height": _positive("length", plausible=(0.1, 6.0)),
    "bogie_height": _positive("length", plausible=(0.05, 3.0)),
    "traction_rod_height": _not_negative("length"),
    "bogie_spacing": _positive("length", plausible=(1.0, 50.0)),
    "wheelbase": replace(_positive("length", plausible=(0.5, 15.0)), optional=True),
    "body_pitch_frequency": _positive("frequency", plausible=(0.05, 100.0)),
    "bogie_pitch_frequency": replace(_positive("frequency", plausible=(0.05, 100.0)), optional=True),
    "pitch_damping_ratio": _not_negative("ratio"),
    "brake.max_torque": _positive("torque", plausible=(100.0, 1e6)),
    "brake.axle_shares": replace(_not_negative("ratio", "vector"), optional=True),
    "brake.max_pressure": _positive("pressure", plausible=(1e4, 1e7)),
    "brake.build_up": _word(*get_args(BuildUp)),
    "brake.supply_rate": _optional(_positive("rate", plausible=(0.01, 1e3))),
    "brake.build_up_delay": _optional(_at_most("time", 10.0)),
    "brake.build_up_ramp": _optional(_positive("time", plausible=(1e-3, 60.0))),
    "brake.valve": _word(*get_args(ValveKind)),
    "brake.fill_time": _positive("time", plausible=(1e-3, 60.0)),
    "brake.vent_time": _positive("time", plausible=(1e-3, 60.0)),
    "brake.critical_pressure_ratio": _optional(_positive("ratio", plausible=(0.1, 0.7))),
    "brake.hold_leak": _optional(_at_most("rate", 1.0)),
    "brake.dead_time": _optional(_at_most("time", 1.0)),
    "brake.shortest_pulse": _optional(_at_most("time", 1.0)),
    "brake.longest_release": _optional(_positive("time", plausible=(0.1, 120.0))),
    "brake.cylinder_volume": _optional(_positive("volume", plausible=(1e-4, 0.1))),
    "brake.reservoir_volume": _optional(_positive("volume", plausible=(1e-3, 5.0))),
    "brake.reservoir_pressure": _optional(_positive("pressure", plausible=(1e4, 2e6))),
    "brake.disturbance_gain": _not_negative("ratio"),
    "brake.disturbance_decay": _positive("rate"),
    "brake.disturbance_frequency": _positive("frequency"),
    "contact.shear_modulus": _positive("pressure", plausible=(1e9, 1e12)),
    "contact.semi_axis_rolling": _positive("length", plausible=(5e-4, 0.05)),
    "contact.semi_axis_lateral": _positive("length", plausible=(5e-4, 0.05)),
    "contact.kalker_c11": _positive("ratio", plausible=(0.1, 20.0)),
    "contact.reference_load": _positive("force", plausible=(1e3, 1e6)),
    **{name: _optional(quantity) for name, quantity in _FURTHER_BRAKES.items()},
    "laden.mass": replace(_positive("mass", plausible=(2e3, 1e6)), optional=True),
    "laden.body_height": replace(_positive("length", plausible=(0.1, 6.0)), optional=True),
    "laden.max_torque": replace(_positive("torque", plausible=(100.0, 1e6)), optional=True),
}

_RAIL: Schema = {
    "mu0": _share(zero=False),
    "friction_ratio": _share(),
    "friction_decay": Quantity(dimension="1/speed", low=0.0, plausible=(0.0, 10.0)),
    "adhesion_reduction": _share(zero=False),
    "slip_reduction": _share(zero=False),
    "profile.starts": Quantity(dimension="length", shape="vector", low=0.0, optional=True),
    "profile.rails": Quantity(dimension="ratio", shape="words", optional=True),
}

_AFSMC: Schema = {
    "proportional_gain": _positive("ratio"),
    "integral_gain": _positive("rate"),
    "weight_rate": _not_negative("rate"),
    "bound_rate": _not_negative("rate"),
    "initial_weights": _any("ratio", "vector"),
    "initial_bound": _not_negative("ratio"),
    "centres": _any("ratio", "vector"),
    "widths": _positive("ratio", "vector"),
    "boundary_layer": _positive("ratio"),
    "torque_unit": _positive("torque"),
}


def _in_each_preset(schema: Schema) -> Schema:
    return {f"{preset}.{name}": quantity for preset in PRESETS for name, quantity in schema.items()}


_TRENITALIA: Schema = {
    "lower_speed_ratio": _share(),
    "upper_speed_ratio": _share(),
    **_in_each_preset(
        {
            "acceleration_limit": _any("acceleration"),
            "deceleration_limit": _any("acceleration"),
            "fill_pulse": _share(),
            "vent_pulse": _share(),
        }
    ),
}

_KNORR_BREMSE: Schema = {
    "slide_slopes": _not_negative("ratio", "vector"),
    "slide_offsets": _not_negative("speed", "vector"),
    "slide_caps": _positive("speed", "vector"),
    "pulses": _share("vector"),
    **_in_each_preset(
        {
            "acceleration_limits": _any("acceleration", "vector"),
            "decisions": Quantity(dimension="ratio", shape="matrix", low=-3.0, high=3.0),
        }
    ),
}

_MITSUBISHI: Schema = {
    "rules": _any("ratio", "word matrix"),
    **_in_each_preset(
        {
            "slide_centres": _not_negative("speed", "vector"),
            "rate_centres": _any("acceleration", "vector"),
            **{f"levels.{level}": _any("ratio") for level in MITSUBISHI_LEVELS},
            "duty_offset": _any("ratio"),
            "duty_gain": _any("ratio"),
        }
    ),
}

# Only the coefficients that do not vanish; the orders of gamma follow from the leading one being a number.
_DISPLACEMENT: Schema = {
    "beta0": _positive("1/length"),
    "gamma0": _positive("1/length^4"),
    "gamma2": _positive("1/length^2"),
    "gamma4": _positive("ratio"),
}
_ANGLE: Schema = {
    "beta2": _positive("1/length^3"),
    "gamma0": _positive("1/length^6"),
    "gamma2": _positive("1/length^4"),
    "gamma4": _positive("1/length^2"),
    "gamma6": _positive("ratio"),
}

_TRACK: Schema = {
    "shortest_wavelength": _positive("length"),
    "longest_wavelength": _positive("length"),
    "sides": Quantity(dimension="ratio", low=1.0, high=2.0),
    **{
        f"{row}.{name}": quantity
        for row in TRACK_ROWS
        for name, quantity in (_ANGLE if row.startswith("cross") else _DISPLACEMENT).items()
    },
}

CONTROLLER_SCHEMAS: dict[str, Schema] = {
    "afsmc": _AFSMC,
    "trenitalia": _TRENITALIA,
    "knorr-bremse": _KNORR_BREMSE,
    "mitsubishi": _MITSUBISHI,
}


CONSTANTS_SCHEMAS: dict[str, Schema] = {"constants": _CONSTANTS, "steel": _STEEL}


def schema_of(kind: Kind, name: str) -> Schema:
    """Return what a file of this kind must contain; each controller and each file of constants has its own schema."""
    if kind == "controller":
        return CONTROLLER_SCHEMAS[name]
    if kind == "constants":
        return CONSTANTS_SCHEMAS[name]
    return {"vehicle": _VEHICLE, "rail": _RAIL, "track": _TRACK}[kind]
