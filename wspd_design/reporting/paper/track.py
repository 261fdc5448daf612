"""Table 9, a synthesized track with its spectrum checked, and what the disturbances change."""

from functools import partial

from wspd_design.parameters.records import SpectrumCoefficients
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Column, Equation, Figure, Heading, Paragraph, Table
from wspd_design.reporting.figures.drawing import KILO, picture
from wspd_design.reporting.figures.track import is_angle, profiles, spectra
from wspd_design.reporting.text import rich
from wspd_design.studies.paper.disturbances import LOAD_SPREAD, largest_change
from wspd_design.studies.paper.reproduction import Reproduction

PRINTED = {
    "lateral-high": "Horizontal",
    "vertical-high": "Vertical",
    "cross-level-high": "Lateral",
}
"""What Table 9 calls the rows."""


def track(made: Reproduction) -> tuple[Block, ...]:
    """Return the section about the track and the other disturbances."""
    ratios = [each.ratio for each in made.track]
    changes = made.disturbances
    calm, chaotic = (numbers.decimals(largest_change(changes, chaotic=which), 1) for which in (False, True))
    bound = numbers.decimals(max(map(abs, made.bound_changes)), 2)
    return (
        Heading(text="Table 9 and the track", anchor="track"),
        Equation(
            source="S(Omega) = (beta_0 + beta_2 Omega^2) / (gamma_0 + gamma_2 Omega^2 + gamma_4 Omega^4 + gamma_6 "
            "Omega^6)",
            description="The power spectral density of the track irregularity is a ratio of polynomials in the square "
            "of the wavenumber.",
            number="49",
            anchor="eq49",
        ),
        Paragraph(
            text=rich(
                "The rows of Table 9 are the high level of ERRI B176, one-sided in rad/m. The row that the paper "
                "calls lateral is the cross level, an angle, and its $beta_2$ has lost its leading 1; the leading "
                "coefficients $gamma_4$ and $gamma_6$ of 1 are missing in print."
            )
        ),
        _coefficients(made),
        Figure(
            svg=picture(partial(spectra, channels=made.track), height=2.5),
            caption="Spectra of synthesized profiles of 6.8 km, estimated by Welch's method, and eq. (49). The mean "
            f"ratio is {numbers.listing([numbers.decimals(ratio, 3) for ratio in ratios])}.",
            alt="Power spectral density over wavenumber from 0.25 to 2.1 rad/m: "
            + "; ".join(
                f"{each.channel} from {each.density[0]:.2g} down to {each.density[-1]:.2g}, estimated over stated "
                f"{each.ratio:.3f} on average"
                for each in made.track
            )
            + ".",
            anchor="track-spectra",
        ),
        Figure(
            svg=picture(partial(profiles, channels=made.track), height=3.4),
            caption=f"The first {made.track[0].distance[-1]:.0f} m of a synthesized track with wavelengths of 3 to "
            f"25 m, seed {made.provenance.seed}.",
            alt="Irregularity over distance: "
            + "; ".join(
                f"{each.channel} within ±{abs(each.profile).max() * KILO:.1f} "
                f"{'mrad' if is_angle(each.channel) else 'mm'}"
                for each in made.track
            )
            + ".",
            anchor="track-profiles",
        ),
        Heading(text="What the disturbances change", anchor="disturbances", level=2),
        Paragraph(
            text="The paper adds a vibration of the pads and an irregular track to its stops. How a wheel load "
            "follows the track depends on a suspension that the paper does not print. Here the load of each wheelset "
            "has the shape of the vertical profile, as each axle meets it, with an assumed standard deviation of "
            f"{100.0 * LOAD_SPREAD:.0f} %, inside the 3 to 5 % of multibody simulations. The bound "
            f"changes by {bound} m at most: what the track costs a perfect brake. A real law switches at other "
            f"moments than before, and its distance changes by up to {calm} m"
            + (f", that of a chaotic loop by up to {chaotic} m." if any(d.spread for d in changes) else ".")
        ),
        _disturbances(made),
    )


def _coefficients(made: Reproduction) -> Table:
    def row(channel: str, used: SpectrumCoefficients, sigma: float, found: float) -> tuple[str, ...]:
        unit = "mrad" if is_angle(channel) else "mm"
        coefficients = (used.beta0, used.beta2, used.gamma0, used.gamma2, used.gamma4, used.gamma6)
        return (
            PRINTED[channel],
            channel,
            *(numbers.significant(value, 7) for value in coefficients),
            f"{numbers.decimals(sigma * KILO, 2)} {unit}",
            f"{numbers.decimals(found * KILO, 2)} {unit}",
        )

    names = ("β0", "β2", "γ0", "γ2", "γ4", "γ6")
    return Table(
        columns=(
            Column(title="In Table 9"),
            Column(title="What it is"),
            *(Column(title=name, align="right") for name in names),
            Column(title="σ of (49)", align="right"),
            Column(title="σ found", align="right"),
        ),
        rows=tuple(
            row(each.channel, made.spectra.rows[each.channel], each.sigma, each.found_sigma)
            for each in made.track
        ),
        caption="Coefficients of eq. (49) as used, and the standard deviation for wavelengths of 3 to 25 m: from the "
        "spectrum, and of the synthesized profile.",
        anchor="table9",
    )


def _disturbances(made: Reproduction) -> Table:
    return Table(
        columns=(
            Column(title="Controller"),
            Column(title="Rail"),
            Column(title="Vibrating pads", unit="m", align="right"),
            Column(title="Irregular track", unit="m", align="right"),
            Column(title="Chaotic spread", unit="m", align="right"),
        ),
        rows=tuple(
            (
                each.controller,
                each.rail,
                numbers.significant(each.by_pads, 2),
                numbers.decimals(each.by_track, 2),
                numbers.decimals(each.spread, 1) if each.spread else numbers.NONE,
            )
            for each in made.disturbances
        ),
        caption="Change of the distance with each disturbance alone.",
        anchor="disturbances-table",
    )
