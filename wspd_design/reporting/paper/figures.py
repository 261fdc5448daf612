"""Figures 3 and 9 to 21 of the paper, from our own stops."""

from dataclasses import dataclass
from functools import partial

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Figure, Heading, Paragraph
from wspd_design.reporting.figures import paper
from wspd_design.reporting.figures.drawing import KILO, KMH, picture
from wspd_design.reporting.text import references
from wspd_design.studies.paper.evidence import CONSTANT_RAILS, FALLING_RAILS, RAILS, StopFigures
from wspd_design.studies.paper.reproduction import Reproduction
from wspd_design.studies.paper.section7 import Section7

SLIP_FIGURES = {"trenitalia": 9, "knorr-bremse": 11, "mitsubishi": 13, "afsmc": 15}
"""The paper's figure of the slip with each controller; that of the velocities follows."""

RULE_TABLES = ("trenitalia", "knorr-bremse", "mitsubishi")
TITLES = {
    "trenitalia": "Trenitalia",
    "knorr-bremse": "Knorr-Bremse",
    "mitsubishi": "Mitsubishi",
    "afsmc": "the adaptive fuzzy law",
}
DRY, WET = zip(CONSTANT_RAILS, FALLING_RAILS, strict=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """The stops that the paper's figures are drawn from, and what tells these figures from those of other stops."""

    stops: Section7
    prefix: str = "paper"  # of the anchors
    remark: str = ""  # at the end of each caption

    def anchor(self, number: int) -> str:
        """Return the anchor of a figure of the paper."""
        return f"{self.prefix}-figure-{number}"


def figures(made: Reproduction) -> tuple[Block, ...]:
    """Return the section with the paper's figures."""
    drawn = [_friction(made), *figures_of(Setting(stops=made.small))]
    return (
        Heading(text="The figures of Section 7", anchor="figures"),
        Paragraph(
            text="Our stops with the quantities and axes of the paper, (a) dry and (b) wet. Left: the friction that "
            "reproduces Table 10; right: that of Polach (2005). Our wheelsets are counted from the front, as they "
            "meet the rail; the paper counts the other way, so that its wheelsets 3 and 4 are in front. Its "
            "wheelset 1, of Figures 17 to 20, is taken to be our last one, wheelset 4."
        ),
        Paragraph(text=("They are ", *references([each.anchor for each in drawn]), ".")),
        *drawn,
    )


def figures_of(setting: Setting) -> tuple[Figure, ...]:
    """Return Figures 9 to 21 of the paper from the stops on one model."""
    drawn: list[Figure] = []
    for controller, number in SLIP_FIGURES.items():
        drawn += [_slips(setting, controller, number), _velocities(setting, controller, number + 1)]
    return (
        *drawn,
        *(_torques(setting, rails, number) for rails, number in ((DRY, 17), (WET, 18))),
        *(_inputs(setting, rails, number) for rails, number in ((DRY, 19), (WET, 20))),
        _forces(setting),
    )


def _friction(made: Reproduction) -> Figure:
    peaks = "; ".join(
        f"{each.rail} at {each.speed * KMH:.0f} km/h at most {each.force.max() / KILO:.1f} kN at slip "
        f"{each.slip[each.force.argmax()]:.2f}, {each.force[-1] / KILO:.1f} kN locked"
        for each in made.friction
    )
    return Figure(
        svg=picture(partial(paper.friction_curves, curves=made.friction), height=4.0),
        caption="Figure 3 of the paper: friction force of one wheel over its slip, under the static load. The "
        "paper's optimum of 0.1 to 0.2 exists on Polach's rails at low speed only; where the force does not fall, "
        "there is none.",
        alt=f"Friction force over slip: {peaks}.",
        anchor="paper-figure-3",
    )


def _slips(setting: Setting, controller: str, number: int) -> Figure:
    draw = partial(
        paper.slips,
        trials=setting.stops.trials,
        controller=controller,
        slip_reference=setting.stops.specification.slip,
    )
    stops = [setting.stops.evidence.stop(controller, rail) for rail in RAILS]
    return Figure(
        svg=picture(draw, height=3.75),
        caption=f"Figure {number} of the paper: slip ratio of the wheelsets with {TITLES[controller]}. Dashed: "
        f"{setting.stops.specification.slip:g}.{_sensitivity(stops)}{setting.remark}",
        alt="Slip ratio over time: "
        + "; ".join(
            f"{each.rail} mean {each.metrics.slip_mean:.3f}, largest {each.metrics.slip_max:.3f} above 10 km/h, "
            f"a wheelset locked for {each.metrics.lock_time:.2f} s"
            for each in stops
        )
        + ".",
        anchor=setting.anchor(number),
    )


def _velocities(setting: Setting, controller: str, number: int) -> Figure:
    draw = partial(
        paper.velocities,
        trials=setting.stops.trials,
        controller=controller,
        wheel_radius=setting.stops.vehicle.wheel_radius,
    )
    return Figure(
        svg=picture(draw, height=3.75),
        caption=f"Figure {number} of the paper: velocity of the wheelsets, at the rim, and of the locomotive with "
        f"{TITLES[controller]}.{setting.remark}",
        alt="Velocity over time: "
        + "; ".join(
            f"{rail} from {setting.stops.evidence.initial_speed * KMH:.0f} km/h to standstill in "
            f"{setting.stops.evidence.stop(controller, rail).metrics.stopping_time:.2f} s"
            for rail in RAILS
        )
        + ".",
        anchor=setting.anchor(number),
    )


def _torques(setting: Setting, rails: tuple[str, str], number: int) -> Figure:
    draw = partial(paper.torques, trials=setting.stops.trials, controllers=RULE_TABLES, rails=rails)
    return Figure(
        svg=picture(draw, height=4.6),
        caption=f"Figure {number} of the paper: braking torque of its wheelset 1, {_word(rails)} rails, with the "
        f"rule tables.{setting.remark}",
        alt="Braking torque over time: "
        + "; ".join(
            f"{name} on {rail} {setting.stops.evidence.stop(name, rail).history.torque_frequency:.2f} cycles per second"
            for name in RULE_TABLES
            for rail in rails
        )
        + ".",
        anchor=setting.anchor(number),
    )


def _inputs(setting: Setting, rails: tuple[str, str], number: int) -> Figure:
    draw = partial(paper.input_and_torque, trials=setting.stops.trials, controller="afsmc", rails=rails)
    shares = [100.0 * setting.stops.evidence.stop("afsmc", rail).metrics.saturated_share for rail in rails]
    said = numbers.listing([f"{share:.1f} % on {rail}" for share, rail in zip(shares, rails, strict=True)])
    return Figure(
        svg=picture(draw, height=3.6),
        caption=f"Figure {number} of the paper: input and braking torque of its wheelset 1, {_word(rails)} rails, "
        f"with the adaptive fuzzy law. The input is 0 or 1 in {said} of the samples."
        f"{setting.remark}",
        alt=f"Input and braking torque over time; the input is 0 or 1 in {said} of the samples.",
        anchor=setting.anchor(number),
    )


def _forces(setting: Setting) -> Figure:
    draw = partial(paper.vertical_forces, trials=setting.stops.trials, controller="afsmc", rails=WET)
    loads = setting.stops.evidence.mean_loads
    low, high = min(loads), max(loads)
    return Figure(
        svg=picture(draw, height=2.6),
        caption="Figure 21 of the paper: vertical forces on two wheelsets, wet rails, with the adaptive fuzzy law."
        f"{setting.remark}",
        alt=f"Vertical force over time: on average {low / KILO:.0f} kN on the lightest and {high / KILO:.0f} kN on "
        f"the heaviest wheelset on {CONSTANT_RAILS[1]}.",
        anchor=setting.anchor(21),
    )


def _sensitivity(stops: list[StopFigures]) -> str:
    rails = [each.rail for each in stops if each.check.sensitive]
    if not rails:
        return ""
    return f" On {numbers.listing(rails)} the closed loop is sensitive: this is one of many courses."


def _word(rails: tuple[str, str]) -> str:
    return "dry" if rails == DRY else "wet"
