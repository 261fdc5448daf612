"""Curves that come with a certificate."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from wspd_design.certificates.records import Certificate, Series
from wspd_design.reporting.figures.drawing import curve
from wspd_design.reporting.numbers import significant

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LOGARITHMIC_SPAN = {"V": 1e3, "k": 10.0}
"""A positive Lyapunov function or gain of the layer that spans more is drawn on a logarithmic scale."""


def panels(series: Sequence[Series]) -> dict[tuple[str, str], list[Series]]:
    """Group curves by their axes; each group becomes one panel."""
    groups: dict[tuple[str, str], list[Series]] = {}
    for each in series:
        groups.setdefault((each.x_label, each.y_label), []).append(each)
    return groups


def certificate_curves(figure: "Figure", certificate: Certificate) -> "Figure":
    """Draw the curves of a certificate, one panel for each pair of axes.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    certificate : Certificate
        With at least one series.
    """
    groups = panels(certificate.series)
    rows = figure.subplots(len(groups), 1, squeeze=False)[:, 0]
    for axes, ((x_label, y_label), group) in zip(rows, groups.items(), strict=True):
        _panel(axes, group)
        axes.set(xlabel=x_label, ylabel=y_label)
    return figure


def lyapunov_functions(figure: "Figure", certificates: Sequence[Certificate]) -> "Figure":
    """Draw the Lyapunov functions of certificates side by side over time, each with its claim's verdict.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    certificates : sequence of Certificate
        Each with a first series that is its Lyapunov function.
    """
    columns = figure.subplots(1, len(certificates), squeeze=False)[0]
    for axes, certificate in zip(columns, certificates, strict=True):
        (x_label, y_label), group = next(iter(panels(certificate.series).items()))
        _panel(axes, group)
        axes.set(
            xlabel=x_label, ylabel=y_label, title=f"{certificate.title}: {certificate.status.name.lower()}"
        )
    return figure


def series_alt(series: Sequence[Series]) -> str:
    """Say in words what the curves show: where each begins, ends, and its extremes."""
    said = (
        f"{each.name}: {each.y_label} from {significant(each.y[0], 3)} to {significant(each.y[-1], 3)} over "
        f"{each.x_label} from {significant(each.x[0], 3)} to {significant(each.x[-1], 3)}, lowest "
        f"{significant(min(each.y), 3)}, highest {significant(max(each.y), 3)}"
        for each in series
    )
    return "; ".join(said) + "."


def _panel(axes: "Axes", group: Sequence[Series]) -> None:
    import numpy as np

    for index, each in enumerate(group):
        curve(axes, np.array(each.x), np.array(each.y), index, label=each.name)
    values = np.concatenate([each.y for each in group])
    span = LOGARITHMIC_SPAN.get(group[0].y_label[0], np.inf)
    if values.min() > 0.0 and values.max() > span * values.min():
        axes.set_yscale("log")
    axes.legend(loc="best")
