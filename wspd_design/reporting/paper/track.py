"""Table 9, a synthesized track with its spectrum checked, and what the disturbances change."""

import math
from collections.abc import Callable
from functools import partial

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Equation, Figure, Heading, Paragraph, Table
from wspd_design.reporting.figures.drawing import KILO, picture
from wspd_design.reporting.figures.track import milli_unit, profiles, spectra
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import Link, rich
from wspd_design.studies.paper.disturbances import LOAD_SPREAD, TrackChannel, largest_change
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
    calm, sensitive = (
        numbers.decimals(largest_change(changes, sensitive=which), 1) for which in (False, True)
    )
    ideal = numbers.decimals(max(map(abs, made.ideal_changes)), 2)
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
                "coefficients $gamma_4$ and $gamma_6$ of 1 are missing in print. [](#table9) has them all; "
                "[](#track-spectra) and [](#track-profiles) show the track that is made from them."
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
                f"{each.channel} within ±{abs(each.profile).max() * KILO:.1f} {milli_unit(each)}"
                for each in made.track
            )
            + ".",
            anchor="track-profiles",
        ),
        Heading(text="What the disturbances change", anchor="disturbances", level=2),
        Paragraph(
            text=(
                "The paper adds a vibration of the pads and an irregular track to its stops. How a wheel load "
                "follows the track depends on a suspension that the paper does not print. Here the load of each "
                "wheelset has the shape of the vertical profile, as each axle meets it, with an assumed standard "
                "deviation of "
                f"{100.0 * LOAD_SPREAD:.0f} %, inside the 3 to 5 % of multibody simulations. The ideal "
                f"stop changes by {ideal} m at most: what the track costs a brake that holds the best slip. "
                "A real law switches at other "
                f"moments than before, and its distance changes by up to {calm} m"
                + (
                    f", that of a sensitive loop by up to {sensitive} m."
                    if any(d.spread for d in changes)
                    else "."
                ),
                " ",
                Link(anchor="disturbances-table"),
                " lists the changes.",
            )
        ),
        _disturbances(made),
    )


def _coefficients(made: Reproduction) -> Table:
    def coefficient(title: str, field: str) -> ColumnOf[TrackChannel]:
        return ColumnOf(
            title=title, significant=7, read=lambda each: getattr(made.spectra.rows[each.channel], field)
        )

    def deviation(title: str, read: Callable[[TrackChannel], float]) -> ColumnOf[TrackChannel]:
        return ColumnOf(
            title=title,
            flush_right=True,
            read=lambda each: f"{numbers.decimals(read(each) * KILO, 2)} {milli_unit(each)}",
        )

    return build(
        made.track,
        (
            ColumnOf(title="In Table 9", read=lambda each: PRINTED[each.channel]),
            ColumnOf(title="What it is", read=lambda each: each.channel),
            coefficient("β0", "beta0"),
            coefficient("β2", "beta2"),
            coefficient("γ0", "gamma0"),
            coefficient("γ2", "gamma2"),
            coefficient("γ4", "gamma4"),
            coefficient("γ6", "gamma6"),
            deviation("σ of (49)", lambda each: each.sigma),
            deviation("σ found", lambda each: each.found_sigma),
        ),
        caption="Coefficients of eq. (49) as used, and the standard deviation for wavelengths of 3 to 25 m: from the "
        "spectrum, and of the synthesized profile.",
        anchor="table9",
    )


def _disturbances(made: Reproduction) -> Table:
    return build(
        made.disturbances,
        (
            ColumnOf(title="Controller", read=lambda each: each.controller),
            ColumnOf(title="Rail", read=lambda each: each.rail),
            ColumnOf(title="Vibrating pads", unit="m", significant=2, read=lambda each: each.by_pads),
            ColumnOf(title="Irregular track", unit="m", decimals=2, read=lambda each: each.by_track),
            ColumnOf(
                title="Spread",
                unit="m",
                decimals=1,
                read=lambda each: each.spread or math.nan,
            ),
        ),
        caption="Change of the distance with each disturbance alone.",
        anchor="disturbances-table",
    )
