"""A document with every kind of block; what it says is invented."""

from datetime import UTC, datetime

import numpy as np

from wspd_design.reporting.blocks import (
    Attachment,
    Bullets,
    Cell,
    Code,
    Column,
    Definition,
    Definitions,
    Document,
    Equation,
    Figure,
    Heading,
    KeyNumber,
    KeyNumbers,
    Paragraph,
    Status,
    Table,
    Verdict,
)
from wspd_design.reporting.figure_style import figure_style, figure_svg, new_figure
from wspd_design.reporting.template import Logo, Template
from wspd_design.reporting.text import rich

HOSTILE = (
    "#import \"x\" <script>alert('1')</script> $ \\ @a *b* _c_ `d` [e](#f) & © "
    "\N{PILE OF POO} \x00 ]] }} {{ </style>"
)

LOGO = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 90 30"><rect width="90" height="30"/></svg>'


def slip_figure() -> str:
    """Two panels with all series, a legend, a marker, an area that needs clipping and mathematical text."""
    time = np.linspace(0.0, 10.0, 200)
    with figure_style():
        figure = new_figure(height=3.4)
        upper, lower = figure.subplots(2, 1, sharex=True)
        for index in range(7):
            upper.plot(time, np.exp(-time / (1.0 + index)), label=f"axle {index + 1}")
        upper.set(ylabel=r"slip $\lambda$ [-]", title="Slip")
        upper.legend(ncols=4)
        lower.fill_between(time, 0.0, 60.0 - 4.0 * time, alpha=0.3)
        lower.plot(time[::20], 60.0 - 4.0 * time[::20], "o", label="torque")
        lower.set(xlabel="time [s]", ylabel=r"$T_\mathrm{brake}$ [kN m]", ylim=(10.0, 50.0))
    return figure_svg(figure)


def sample(note: str = "nothing hostile") -> Document:
    """Return a report with every kind of block and every status."""
    svg = slip_figure()
    checks = Table(
        columns=(
            Column(title="id"),
            Column(title="Claim"),
            Column(title="Value", unit="1/s", align="right"),
            Column(title="Limit", unit="1/s", align="right"),
            Column(title="Result"),
        ),
        rows=tuple(
            (
                rich("[C1](#reaching)") if number == 1 else f"C{number}",
                rich("the slip pole $p$ stays below $1 / tau$ for all speeds"),
                f"{number * 1.37:.2f}",
                "1.67",
                Cell(status=status),
            )
            for number, status in enumerate(Status, start=1)
        ),
        caption="Checks of this design.",
        anchor="checks",
    )
    stops = Table(
        columns=(
            Column(title="Controller"),
            Column(title="Distance", unit="m", align="right"),
            Column(title="Time", unit="s", align="right"),
            Column(title="Slip rms", unit="-", align="right"),
            Column(title="Ending", align="center"),
        ),
        rows=tuple(
            (
                f"variant {row}",
                f"{180 + 7.31 * row:.1f}",
                f"{11 + row / 3:.2f}",
                f"{0.01 * row:.3f}",
                "standstill",
            )
            for row in range(60)
        ),
        caption=rich("Stops from 120 km/h; a *long* table that goes over two pages."),
        anchor="stops",
    )
    return Document(
        title="Wheel slide protection of the ER24PC",
        subtitle="Adaptive fuzzy sliding mode on wet rail, from 120 km/h",
        status_line="wspd 0.1.0 · er24pc-wet.toml · 22 November 2026 · seed 1",
        verdict=Verdict(
            status=Status.UNDECIDED,
            sentence=rich(
                "The reaching condition is proved for $v >= 2$ m/s, but with a valve lag of 0.6 s the closed "
                "loop has no stable equilibrium at slip 0.14: see [](#reaching)."
            ),
        ),
        summary=(
            KeyNumbers(
                numbers=(
                    KeyNumber(label="Stopping distance", value="219.8", unit="m", note="bound 211.7 m"),
                    KeyNumber(label="Stopping time", value="12.94", unit="s", note="lag 0.9 s"),
                    KeyNumber(
                        label="Slip about its reference",
                        value="0.087",
                        unit="rms",
                        note=rich("$lambda_d = 0.14$"),
                    ),
                    KeyNumber(label="Reaching margin", value="−3.2", unit="kN m", note="enclosed to 1e-3"),
                )
            ),
            checks,
        ),
        blocks=(
            Heading(text="The slip equation", anchor="slip-equation"),
            Paragraph(
                text=rich(
                    "Slip follows [](#eq19), with the drift $F$ and the gain $G = frac(R, 2 I v)$, both "
                    'bounded away from standstill. The torque $T_"brake"$ is that of *one wheelset*; the '
                    "command `wspd linearize er24pc` prints the poles, and [the picture](#slip-figure) shows "
                    "the stop. Longer lines show whether an inline formula such as "
                    "$dot(lambda)_d + (K_I\\/K_P) e$ sits on the baseline and leaves the line spacing alone."
                )
            ),
            Equation(
                source="dot(lambda) = underbrace(-1/v [(R^2 f)/I + (1 - lambda) (f_d + 8 f)/m] "
                '+ (B_W (1 - lambda))/I, F(lambda, v, t)) + underbrace(R/(2 I v), G(v)) T_"brake"',
                description="The rate of slip equals the drift F of slip, speed and time plus the gain G of "
                "speed times the braking torque.",
                number="19",
                anchor="eq19",
            ),
            Equation(source="V = 1/2 s^2", description="V equals one half of s squared."),
            Heading(text="Reaching condition", anchor="reaching", level=2),
            Verdict(
                status=Status.PROVED, sentence="The reaching condition holds on the whole parameter box."
            ),
            Paragraph(text="The proof assumes:"),
            Bullets(items=(rich("$T = u$: no actuator lag,"), "the train decelerates,", note)),
            Definitions(
                rows=(
                    Definition(term=rich("$W_0$"), text="24.8 kN, the smallest bound of the disturbance"),
                    Definition(term=rich("$Phi$"), text="0.02, boundary layer in slip"),
                    Definition(term="method", text=note),
                )
            ),
            Heading(text="In the worst corner", anchor="corner", level=3),
            Code(text="$ wspd verify er24pc-wet.toml\nC1  proved   [24.793, 24.794] <= 25.3\n" + note),
            Heading(text="Stops", anchor="stops-section"),
            Figure(
                svg=svg,
                caption=rich("Slip and torque of the four axles; the slip $lambda$ settles at 0.14."),
                alt="Two curves over time: slip decays from 1 to 0, torque falls from 60 to 20 kN m.",
                anchor="slip-figure",
            ),
            Figure(svg=svg, caption="The same picture again: its ids must not collide.", alt="As before."),
            stops,
        ),
        provenance=(
            Definition(term="Command", text=rich("`wspd report er24pc-wet.toml`")),
            Definition(term="Version", text="wspd-design 0.1.0, Python 3.11"),
            Definition(term="Input hash", text="sha256 " + "0123456789abcdef" * 4),
            Definition(term="Seed", text="1"),
        ),
        attachments=(
            Attachment(
                name="er24pc-wet.toml",
                media_type="application/toml",
                content=f'[design]\nname = "ä {note.encode("unicode_escape").decode()}"\n',
                description="the design file",
            ),
            Attachment(
                name="report.json",
                media_type="application/json",
                content='{"schema": 1}\n',
                description="all numbers",
            ),
        ),
        timestamp=datetime(2026, 11, 22, 12, 0, tzinfo=UTC),
        author="A. Author",
        keywords=("wheel slide protection", "ER24PC"),
        template=Template(
            organization="Example Rail",
            document_number="WSP-0042",
            issue="3",
            author="A. Author",
            logo=Logo(format="svg", content=LOGO),
        ),
    )
