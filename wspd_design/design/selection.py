"""Designs of the laws: for each the rule that chooses its gains, in one table."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, replace

from wspd_design.certificates.memory import recall
from wspd_design.controllers.family import Family, designed_family, tunable_family
from wspd_design.design.fuzzy_surface_gains import fuzzy_surface_gains
from wspd_design.design.industry import PRINTED, named_with, usual_table
from wspd_design.design.printed_gains import printed_gains
from wspd_design.design.ranges import (
    ADAPTIVE_RANGES,
    FUZZY_SURFACE_RANGES,
    INTEGRAL_SMC_RANGES,
    OBSERVER_SMC_RANGES,
    SLIDING_MODE_RANGES,
    SUPER_TWISTING_RANGES,
    TABLE_RANGES,
    TORQUE_FEEDBACK_RANGES,
    SearchRange,
)
from wspd_design.design.records import Design, Gain, Specification, rail_hash, vehicle_hash
from wspd_design.design.sliding_gains import adaptive_gains, sliding_mode_gains
from wspd_design.design.torque_feedback_gains import torque_feedback_gains
from wspd_design.design.tracking_gains import integral_smc_gains, observer_smc_gains, super_twisting_gains
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.taken import check_rail, check_record, check_vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class GainRules:
    """Where the gains of a law come from."""

    choose: Callable[[Vehicle, Rail, Specification], tuple[Gain, ...]]  # by the rules of the design
    printed: Callable[[], tuple[Gain, ...]] | None = (
        None  # in the paper, which the name of the law stands for
    )
    ranges: Mapping[str, SearchRange] = field(
        default_factory=dict
    )  # where a search looks, by gain; empty: about every rule


RULES: dict[str, GainRules] = {
    "afsmc": GainRules(choose=adaptive_gains, printed=printed_gains, ranges=ADAPTIVE_RANGES),
    "smc": GainRules(choose=sliding_mode_gains, ranges=SLIDING_MODE_RANGES),
    "torque-feedback": GainRules(choose=torque_feedback_gains, ranges=TORQUE_FEEDBACK_RANGES),
    "observer-smc": GainRules(choose=observer_smc_gains, ranges=OBSERVER_SMC_RANGES),
    "super-twisting": GainRules(choose=super_twisting_gains, ranges=SUPER_TWISTING_RANGES),
    "integral-smc": GainRules(choose=integral_smc_gains, ranges=INTEGRAL_SMC_RANGES),
    "afsmc-mended": GainRules(choose=fuzzy_surface_gains, ranges=FUZZY_SURFACE_RANGES),
}
"""Rules by the family of laws."""


def design_controller(
    vehicle: Vehicle, rail: Rail, specification: Specification, *, law: str = "afsmc"
) -> Design:
    """Choose the gains of a slip controller.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle, nominal values.
    rail : Rail
        Design rail, nominal friction; its bounds and those of the vehicle span the uncertainty.
    specification : Specification
        Reference, ranges, tolerance and sample time.
    law : {"afsmc", "smc", "torque-feedback"}
        Adaptive fuzzy sliding mode in its repaired form, sliding mode with a friction model, or static feedback of
        sliding speed and torque.

    Returns
    -------
    Design
        Gains with units and reasons.

    Raises
    ------
    UserError
        If there is no such law, or no rule that chooses its gains.
    """
    check_vehicle(vehicle, by="design_controller", whole=False)
    check_rail(rail, by="design_controller")
    check_record(
        specification, Specification, by="design_controller", remedy="make one, Specification(slip=0.14)"
    )
    family = designed_family(law)
    asked = ["gains", family.name, vehicle_hash(vehicle), rail_hash(rail), asdict(specification)]
    gains = recall(asked, lambda: _rules(family).choose(vehicle, rail, specification))
    return _design(f"{law}-{vehicle.name}-{rail.name}", family, vehicle, rail, specification, gains)


def shipped_design(law: str, vehicle: Vehicle, rail: Rail, specification: Specification) -> Design:
    """Return what a law is before anybody tuned it: the design behind its name, or its table as it is."""
    family = tunable_family(law)
    if family.gains is not None:
        return named_design(law, vehicle, rail, specification)
    assert family.scales is not None
    why, neutral = f"the {usual_table(vehicle)} table as it is", family.scales()
    gains = tuple(
        Gain(name=form.name, value=getattr(neutral, form.name), unit="-", why=why) for form in family.forms
    )
    return _design(law, family, vehicle, rail, specification, gains)


def search_ranges(law: str) -> Mapping[str, SearchRange]:
    """Return where a search looks for the numbers of a law; empty where nothing is stated."""
    if law in RULES:
        return RULES[law].ranges
    return TABLE_RANGES.get(law, {})


def named_design(law: str, vehicle: Vehicle, rail: Rail, specification: Specification) -> Design:
    """Return the design behind the name of a law: printed gains if the paper has them, else those of the rules.

    On a vehicle that the paper does not speak about, the name says that the gains are printed.
    """
    if _rules(designed_family(law)).printed is not None:
        made = paper_design(vehicle, rail, specification, law=law)
        foreign = usual_table(vehicle) != "calibrated"
        return replace(made, name=named_with(law, PRINTED)) if foreign else made
    return replace(design_controller(vehicle, rail, specification, law=law), name=law)


def paper_design(vehicle: Vehicle, rail: Rail, specification: Specification, *, law: str = "afsmc") -> Design:
    """Return the design with the gains that the paper prints for a law."""
    family = designed_family(law)
    printed = _rules(family).printed
    if printed is None:
        raise UserError(f"the paper prints no gains of {law}; leave them to wspd design --law {law}")
    return _design(law, family, vehicle, rail, specification, printed())


def _rules(family: Family) -> GainRules:
    if family.name not in RULES:
        raise UserError(f"no rule chooses the gains of {family.name}; write its design file by hand")
    return RULES[family.name]


def _design(
    name: str,
    family: Family,
    vehicle: Vehicle,
    rail: Rail,
    specification: Specification,
    gains: tuple[Gain, ...],
) -> Design:
    order = [form.name for form in family.forms]
    return Design(
        name=name,
        law=family.name,
        vehicle=vehicle.name,
        vehicle_hash=vehicle_hash(vehicle),
        rail=rail.name,
        rail_hash=rail_hash(rail),
        specification=specification,
        gains=tuple(sorted(gains, key=lambda gain: order.index(gain.name))),
    )
