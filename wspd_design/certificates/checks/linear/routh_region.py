"""Region of (c, k) in which the loop inside the layer is stable with the valve lag, for the plot beside the verdict.

k = W K_P/Phi for the sliding mode, whose equivalent torque cancels the slip pole of its model; k = G K_P du/ds for
the adaptive law, which leaves the pole as it is and of which the weights are held here.
"""

from dataclasses import asdict
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.frame import level, series
from wspd_design.certificates.records import Role, Series
from wspd_design.certificates.setting.linear_loop import nominal
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy, AdaptiveFuzzyGains
from wspd_design.controllers.offers import LinearSurface, SlipModel
from wspd_design.parameters.loading import load_paper_gains
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

PLOT_RATES = 401
LEAST_POINTS = 3  # of a border that can be drawn
HIGHEST_RATE = 2.0  # of the plot, in multiples of the law's c or of 1/tau
MARGIN = 5.0  # of the plot above and below the gains


def region(law: LinearSurface, lag: float, speeds: "Array", plant: SlipModel) -> list[Series]:
    """Draw the border where the slip pole is largest and smallest, the law over speed, and the paper's gains.

    Parameters
    ----------
    law : LinearSurface
        Law with a surface.
    lag : float
        Time constant of the valve [s].
    speeds : ndarray
        Of the train [m/s].
    plant : SlipModel
        Nominal pole [1/s] and gain at these speeds.
    """
    import numpy as np

    printed = _printed(law)
    rate, paper_rate = law.surface_rate, printed.surface_rate
    own = _loop_rate(law, speeds, plant)
    paper = plant.gain * printed.linear_form(speeds).proportional
    rates = np.linspace(0.0, HIGHEST_RATE * max(rate, 1.0 / lag), PLOT_RATES)[1:]
    borders = [(index, *_border(law, float(plant.pole[index]), lag, rates)) for index in _extremes(plant)]
    # The border is in the picture where the law has its c, however far its gains lie from it.
    beside = [np.interp(rate, rates, border) for _, _, border in borders]
    shown = np.concatenate([own, paper, [k for k in beside if 0.0 < k < np.inf]])
    bottom, top = float(shown.min()) / MARGIN, float(shown.max()) * MARGIN
    axes = ("c = K_I/K_P [1/s]", "k [1/s]")
    slow, fast = speeds[0] * KMH, speeds[-1] * KMH
    ends = f"k = {own[0]:.3g} at {slow:.3g} km/h to {own[-1]:.3g} at {fast:.3g} km/h"
    curves = [series(f"the law, {ends}", *axes, np.full(len(speeds), rate), own, Role.LOOP_GAIN)]
    if (rate, *own[:1]) != (paper_rate, *paper[:1]):
        curves.append(
            series(
                "the paper's gains over speed", *axes, np.full(len(speeds), paper_rate), paper, Role.LOOP_GAIN
            )
        )
    for index, side, border in borders:
        pole, at = float(plant.pole[index]), f"{speeds[index] * KMH:.3g} km/h"
        drawn = (border > 0.0) & np.isfinite(border)
        if drawn.sum() < LEAST_POINTS:
            curves.append(level(f"{side} at {at}, p tau = {pole * lag:.3g}", *axes, rates, bottom))
        else:
            line = np.clip(border[drawn], bottom, top)
            held = ", weights held," if law.linear_form(float(speeds[index])).twice else ""
            curves.append(
                series(f"stable {side} this{held} at {at}", *axes, rates[drawn], line, Role.LOOP_GAIN)
            )
    return curves


def _extremes(plant: SlipModel) -> tuple[int, int]:
    """Return where the slip pole is largest and where it is smallest."""
    return int(plant.pole.argmax()), int(plant.pole.argmin())


def _loop_rate(law: LinearSurface, speeds: "Array", plant: SlipModel) -> "Array":
    """Return k over speed [1/s]: what a law with a design model has beside the slip pole and c that it cancels."""
    gains = law.linear_form(speeds)
    if law.linear_model is None:
        found: Array = plant.gain * gains.proportional
        return found
    model = nominal(*law.linear_model, law.slip_reference, speeds)
    kept: Array = model.gain * gains.proportional - model.pole - law.surface_rate
    return kept


def _border(law: LinearSurface, pole: float, lag: float, rates: "Array") -> tuple[str, "Array"]:
    """Return where in k the determinant vanishes over c, and on which side of it the loop is stable."""
    import numpy as np

    room = 1.0 - pole * lag
    if room <= 0.0:
        return "nothing is stable", np.zeros(len(rates))
    with np.errstate(divide="ignore"):
        if law.linear_model is not None:  # room (c + k) > tau k c
            excess = lag * rates - room
            return "below", np.where(excess > 0.0, room * rates / excess, np.inf)
        excess = room - lag * rates  # room (k - p) > tau k c
        border = room * pole / excess
    return ("above", border) if pole > 0.0 else ("below", np.where(excess < 0.0, border, np.inf))


def _printed(law: LinearSurface) -> AdaptiveFuzzy:
    """Return the adaptive law with the gains that the paper prints, on the brake of a law."""
    gains = AdaptiveFuzzyGains(
        slip_reference=law.slip_reference,
        dead_zone=False,
        hold_when_saturated=False,
        scheduled_rates=False,
        **asdict(load_paper_gains()),
    )
    return AdaptiveFuzzy(
        name="printed",
        sample_time=law.sample_time,
        wheel_radius=law.wheel_radius,
        max_torque=law.max_torque,
        gains=gains,
    )
