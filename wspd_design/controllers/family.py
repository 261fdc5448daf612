"""The families of laws: one row for each, from which all tables of laws are made.

A new law needs its class and its record of gains, a row here, and the rule that chooses its gains
(``design/selection.py``). Nothing else has to know it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy, AdaptiveFuzzyGains
from wspd_design.controllers.baselines.knorr_bremse import KnorrBremse
from wspd_design.controllers.baselines.mitsubishi import Mitsubishi
from wspd_design.controllers.baselines.scales import (
    KnorrBremseScales,
    MitsubishiScales,
    TrenitaliaScales,
    scaled_knorr_bremse,
    scaled_mitsubishi,
    scaled_trenitalia,
)
from wspd_design.controllers.baselines.trenitalia import Trenitalia
from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.controllers.fuzzy_surface import FuzzySurface, FuzzySurfaceGains
from wspd_design.controllers.gains import GainForm, gain_forms
from wspd_design.controllers.given import Given
from wspd_design.controllers.integral_smc import IntegralSmc, IntegralSmcGains
from wspd_design.controllers.observer_smc import ObserverSmc, ObserverSmcGains
from wspd_design.controllers.protected import protection
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.protocol import Law
from wspd_design.controllers.references import ReferenceKind
from wspd_design.controllers.sliding_mode import SlidingMode, SlidingModeGains
from wspd_design.controllers.super_twisting import SuperTwisting, SuperTwistingGains
from wspd_design.controllers.torque_feedback import TorqueFeedback, TorqueFeedbackGains
from wspd_design.controllers.tracking import Tracking, tracking
from wspd_design.controllers.wheel_law import WheelLaw
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_knorr_bremse, load_mitsubishi, load_trenitalia
from wspd_design.parameters.schema import PRESETS, Preset
from wspd_design.parameters.words import did_you_mean

INDUSTRY = "law of the industry"


Builder: TypeAlias = Callable[[Given], Law]


@dataclass(frozen=True, slots=True, kw_only=True)
class Family:
    """A family of laws."""

    name: str
    title: str  # a noun phrase, as it stands within a sentence
    origin: str  # where the law comes from
    law: type  # class of the controllers
    build: Builder
    gains: type | None = None  # record of the gains; None for a law that is not designed
    tables: Callable[[Preset], object] | None = None  # of a law whose numbers come in presets
    scales: type | None = None  # record of the factors by which such a table is tuned
    scaled: Callable[[Any, Any], object] | None = None  # table with its factors
    reference: ReferenceKind | None = None  # of a law of a vehicle where its specification states none
    equations: tuple[
        str, ...
    ] = ()  # numbers of the paper's equations that it rests on, besides those of the plant

    @property
    def heading(self) -> str:
        """Title at the start of a sentence."""
        return self.title[0].upper() + self.title[1:]

    @property
    def forms(self) -> tuple[GainForm, ...]:
        """Gains of a design, in the order of its file; of a law that decides by a table, the factors on it."""
        record = self.gains or self.scales
        return () if record is None else gain_forms(record)


def _with_model(law: type) -> Builder:
    """Build a law that knows its design model."""
    return lambda given: law(
        name=given.name,
        sample_time=given.sample_time,
        vehicle=given.vehicle,
        rail=given.rail,
        gains=given.numbers,
    )


def _with_table(law: type) -> Builder:
    """Build a law that decides by a table."""
    return lambda given: law(
        name=given.name,
        sample_time=given.sample_time,
        wheel_radius=given.vehicle.wheel_radius,
        table=given.numbers,
    )


def _adaptive_fuzzy(given: Given) -> Law:
    return AdaptiveFuzzy(
        name=given.name,
        sample_time=given.sample_time,
        wheel_radius=given.vehicle.wheel_radius,
        max_torque=given.vehicle.brake.max_torque,
        gains=given.numbers,
    )


def _unprotected(given: Given) -> Law:
    return Unprotected(name=given.name, sample_time=given.sample_time)


def _tracking(given: Given, law: Callable[[Tracking], WheelLaw]) -> Law:
    """Build the protection of a law that asks for a torque."""
    gains, inertia = given.numbers, given.vehicle.wheelset_inertia
    return protection(
        given,
        lambda valve: law(tracking(gains, valve, inertia)),
        time_share=gains.valve_time_share,
    )


def _observer_smc(given: Given) -> Law:
    gains = given.numbers
    return _tracking(given, lambda tracking: ObserverSmc(tracking=tracking, torque_slew=gains.torque_slew))


def _super_twisting(given: Given) -> Law:
    gains, radius = given.numbers, given.vehicle.wheel_radius
    return _tracking(
        given,
        lambda tracking: SuperTwisting(
            tracking=tracking, integral_rate=gains.integral_rate, layer=gains.layer / radius
        ),
    )


def _integral_smc(given: Given) -> Law:
    gains, radius = given.numbers, given.vehicle.wheel_radius
    return _tracking(
        given,
        lambda tracking: IntegralSmc(
            tracking=tracking, switching_gain=gains.switching_gain / radius, layer=gains.layer / radius
        ),
    )


def _fuzzy_surface(given: Given) -> Law:
    law = FuzzySurface(
        sample_time=given.sample_time, wheel_radius=given.vehicle.wheel_radius, gains=given.numbers
    )
    return protection(given, lambda _: law)


_SLIDING_MODE_EQUATIONS = ("20", *(str(number) for number in range(22, 29)))

FAMILIES: dict[str, Family] = {
    family.name: family
    for family in (
        Family(
            name="afsmc",
            title="adaptive fuzzy sliding mode",
            origin="eqs. (29) to (42)",
            law=AdaptiveFuzzy,
            gains=AdaptiveFuzzyGains,
            build=_adaptive_fuzzy,
            equations=(*_SLIDING_MODE_EQUATIONS, *(str(number) for number in range(29, 49))),
        ),
        Family(
            name="smc",
            title="sliding mode with a friction model",
            origin="eqs. (22) to (26)",
            law=SlidingMode,
            gains=SlidingModeGains,
            build=_with_model(SlidingMode),
            equations=_SLIDING_MODE_EQUATIONS,
        ),
        Family(
            name="torque-feedback",
            title="static feedback of sliding speed and torque",
            origin="not in the paper",
            law=TorqueFeedback,
            gains=TorqueFeedbackGains,
            build=_with_model(TorqueFeedback),
        ),
        Family(
            name="observer-smc",
            title="sliding mode through the observed friction and the valve",
            origin="not in the paper",
            law=Protection,
            gains=ObserverSmcGains,
            build=_observer_smc,
            reference="falling",
        ),
        Family(
            name="super-twisting",
            title="super-twisting sliding mode through the observed friction and the valve",
            origin="not in the paper",
            law=Protection,
            gains=SuperTwistingGains,
            build=_super_twisting,
            reference="falling",
        ),
        Family(
            name="integral-smc",
            title="integral sliding mode through the observed friction and the valve",
            origin="not in the paper",
            law=Protection,
            gains=IntegralSmcGains,
            build=_integral_smc,
            reference="falling",
        ),
        Family(
            name="afsmc-mended",
            title="adaptive fuzzy sliding mode on a surface that the valve moves at once",
            origin="eqs. (29) to (42) on another surface",
            law=Protection,
            gains=FuzzySurfaceGains,
            build=_fuzzy_surface,
            reference="falling",
        ),
        Family(
            name="trenitalia",
            title="speed and acceleration bands of Trenitalia",
            origin=f"{INDUSTRY}, eq. (16)",
            law=Trenitalia,
            tables=load_trenitalia,
            scales=TrenitaliaScales,
            scaled=scaled_trenitalia,
            build=_with_table(Trenitalia),
        ),
        Family(
            name="knorr-bremse",
            title="decision table of Knorr-Bremse",
            origin=f"{INDUSTRY}, eqs. (17), (18)",
            law=KnorrBremse,
            tables=load_knorr_bremse,
            scales=KnorrBremseScales,
            scaled=scaled_knorr_bremse,
            build=_with_table(KnorrBremse),
        ),
        Family(
            name="mitsubishi",
            title="fuzzy rules of Mitsubishi",
            origin=f"{INDUSTRY}, Table 5",
            law=Mitsubishi,
            tables=load_mitsubishi,
            scales=MitsubishiScales,
            scaled=scaled_mitsubishi,
            build=_with_table(Mitsubishi),
        ),
        Family(
            name="none",
            title="brake without wheel slide protection",
            origin="for comparison",
            law=Unprotected,
            build=_unprotected,
        ),
    )
}
"""All families by name, in the order of tables."""


def designed() -> tuple[Family, ...]:
    """Return the families whose gains can be designed."""
    return tuple(family for family in FAMILIES.values() if family.gains is not None)


def with_numbers() -> tuple[Family, ...]:
    """Return the families that a design file can hold: those that are designed, and tables with factors."""
    return tuple(family for family in FAMILIES.values() if family.forms)


def with_presets() -> tuple[Family, ...]:
    """Return the families whose tables come in presets."""
    return tuple(family for family in FAMILIES.values() if family.tables is not None)


def designed_family(name: str) -> Family:
    """Return a family whose gains can be designed.

    Raises
    ------
    UserError
        If there is none of that name.
    """
    family = FAMILIES.get(name)
    if family is not None and family.gains is not None:
        return family
    raise _no_such_law(name, "designed", designed())


def tunable_family(name: str) -> Family:
    """Return a family whose numbers can be tuned.

    Raises
    ------
    UserError
        If there is none of that name.
    """
    family = FAMILIES.get(name)
    if family is not None and family.forms:
        return family
    raise _no_such_law(name, "tuned", with_numbers())


def _no_such_law(name: str, what: str, families: tuple[Family, ...]) -> UserError:
    names = [each.name for each in families]
    return UserError(f'law "{name}" cannot be {what}{did_you_mean(name, names)}; choose {" or ".join(names)}')


def preset_of(family: Family, name: str) -> Preset:
    """Return a preset of the tables of a family.

    Raises
    ------
    UserError
        If there is no such preset.
    """
    for preset in PRESETS:
        if preset == name:
            return preset
    choice = " or ".join(f"{family.name}:{preset}" for preset in PRESETS)
    raise UserError(f'unknown preset "{name}" of {family.name}; write {choice}')
