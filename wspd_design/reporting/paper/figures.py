"""Figures 3 and 9 to 21 of the paper, from our own stops."""

from functools import partial

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Figure, Heading, Paragraph
from wspd_design.reporting.figures import paper
from wspd_design.reporting.figures.drawing import KILO, KMH, picture
from wspd_design.reporting.text import references
from wspd_design.studies.paper.evidence import CONSTANT_RAILS, FALLING_RAILS, RAILS, StopFigures
from wspd_design.studies.paper.reproduction import Reproduction

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


def figures(made: Reproduction) -> tuple[Block, ...]:
    """Return the section with the paper's figures."""
    drawn: list[Figure] = [_friction(made)]
    for controller, number in SLIP_FIGURES.items():
        drawn += [_slips(made, controller, number), _velocities(made, controller, number + 1)]
    drawn += [
        *(_torques(made, rails, number) for rails, number in ((DRY, 17), (WET, 18))),
        *(_inputs(made, rails, number) for rails, number in ((DRY, 19), (WET, 20))),
        _forces(made),
    ]
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


def _slips(made: Reproduction, controller: str, number: int) -> Figure:
    draw = partial(
        paper.slips, trials=made.trials, controller=controller, slip_reference=made.specification.slip
    )
    stops = [made.evidence.stop(controller, rail) for rail in RAILS]
    return Figure(
        svg=picture(draw, height=3.75),
        caption=f"Figure {number} of the paper: slip ratio of the wheelsets with {TITLES[controller]}. Dashed: "
        f"{made.specification.slip:g}.{_sensitivity(stops)}",
        alt="Slip ratio over time: "
        + "; ".join(
            f"{each.rail} mean {each.metrics.slip_mean:.3f}, largest {each.metrics.slip_max:.3f} above 10 km/h, "
            f"a wheelset locked for {each.metrics.lock_time:.2f} s"
            for each in stops
        )
        + ".",
        anchor=f"paper-figure-{number}",
    )


def _velocities(made: Reproduction, controller: str, number: int) -> Figure:
    draw = partial(
        paper.velocities, trials=made.trials, controller=controller, wheel_radius=made.vehicle.wheel_radius
    )
    return Figure(
        svg=picture(draw, height=3.75),
        caption=f"Figure {number} of the paper: velocity of the wheelsets, at the rim, and of the locomotive with "
        f"{TITLES[controller]}.",
        alt="Velocity over time: "
        + "; ".join(
            f"{rail} from {made.evidence.initial_speed * KMH:.0f} km/h to standstill in "
            f"{made.evidence.stop(controller, rail).metrics.stopping_time:.2f} s"
            for rail in RAILS
        )
        + ".",
        anchor=f"paper-figure-{number}",
    )


def _torques(made: Reproduction, rails: tuple[str, str], number: int) -> Figure:
    draw = partial(paper.torques, trials=made.trials, controllers=RULE_TABLES, rails=rails)
    return Figure(
        svg=picture(draw, height=4.6),
        caption=f"Figure {number} of the paper: braking torque of its wheelset 1, {_word(rails)} rails, with the "
        "rule tables.",
        alt="Braking torque over time: "
        + "; ".join(
            f"{name} on {rail} {made.evidence.stop(name, rail).history.torque_frequency:.2f} cycles per second"
            for name in RULE_TABLES
            for rail in rails
        )
        + ".",
        anchor=f"paper-figure-{number}",
    )


def _inputs(made: Reproduction, rails: tuple[str, str], number: int) -> Figure:
    draw = partial(paper.input_and_torque, trials=made.trials, controller="afsmc", rails=rails)
    shares = [100.0 * made.evidence.stop("afsmc", rail).metrics.saturated_share for rail in rails]
    said = numbers.listing([f"{share:.1f} % on {rail}" for share, rail in zip(shares, rails, strict=True)])
    return Figure(
        svg=picture(draw, height=3.6),
        caption=f"Figure {number} of the paper: input and braking torque of its wheelset 1, {_word(rails)} rails, "
        f"with the adaptive fuzzy law. The input is 0 or 1 in {said} of the samples.",
        alt=f"Input and braking torque over time; the input is 0 or 1 in {said} of the samples.",
        anchor=f"paper-figure-{number}",
    )


def _forces(made: Reproduction) -> Figure:
    draw = partial(paper.vertical_forces, trials=made.trials, controller="afsmc", rails=WET)
    low, high = made.evidence.load_range
    return Figure(
        svg=picture(draw, height=2.6),
        caption="Figure 21 of the paper: vertical forces on two wheelsets, wet rails, with the adaptive fuzzy law.",
        alt=f"Vertical force over time: on average {low / KILO:.0f} kN on the lightest and {high / KILO:.0f} kN on "
        f"the heaviest wheelset on {CONSTANT_RAILS[1]}.",
        anchor="paper-figure-21",
    )


def _sensitivity(stops: list[StopFigures]) -> str:
    rails = [each.rail for each in stops if each.check.sensitive]
    if not rails:
        return ""
    return f" On {numbers.listing(rails)} the closed loop is sensitive: this is one of many courses."


def _word(rails: tuple[str, str]) -> str:
    return "dry" if rails == DRY else "wet"
