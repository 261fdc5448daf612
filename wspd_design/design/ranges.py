"""Ranges in which a search looks for the gains of a law, stated beside the rule that chooses them."""

from dataclasses import dataclass

from wspd_design.controllers.gains import SLIP_REFERENCE


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchRange:
    """Where a search looks for one gain.

    A relative range holds factors on the value that it starts from, on all numbers of a list alike.
    """

    low: float
    high: float
    why: str
    relative: bool = False
    log: bool = True  # even on a logarithmic scale

    def __post_init__(self) -> None:
        """Keep the logarithm defined."""
        assert 0.0 < self.low < self.high or (not self.log and self.low < self.high)


USUAL = SearchRange(
    low=0.25, high=4.0, relative=True, why="no range is stated: a factor 4 on both sides of the rule"
)
"""Range of a number without one of its own."""

_SLIP = SearchRange(
    low=0.025,
    high=0.3,
    why="from the creep of a braking wheel that adheres to slips beyond the peak of every rail but the very low ones",
)


def _factor(low: float, high: float, why: str) -> SearchRange:
    return SearchRange(low=low, high=high, why=why, relative=True)


SLIDING_MODE_RANGES = {
    SLIP_REFERENCE: _SLIP,
    "surface_rate": _factor(0.1, 10.0, "a decade on both sides of the rule"),
    "switching_gain": _factor(0.1, 10.0, "a decade on both sides of the reaching condition"),
    "boundary_layer": _factor(0.2, 10.0, "as narrow as sampling can follow up to no layer at all"),
}
TORQUE_FEEDBACK_RANGES = {
    SLIP_REFERENCE: _SLIP,
    "sliding_gain": _factor(0.05, 5.0, "the rule is for the slowest valve, so that lower gains count more"),
    "torque_gain": SearchRange(
        low=0.0,
        high=30.0,
        log=False,
        why="from no feedback of the torque to a pole 31 times that of the valve",
    ),
}
ADAPTIVE_RANGES = {
    SLIP_REFERENCE: _SLIP,
    "integral_gain": _factor(0.03, 10.0, "surface rates from a tenth to some units a second"),
    "boundary_layer": _factor(
        0.1, 300.0, "from the printed layer, which sampling cannot follow, to that of a slip"
    ),
    "weight_rate": _factor(0.01, 100.0, "from hardly any adaptation to that of a sample"),
    "bound_rate": _factor(0.01, 100.0, "as the weights"),
    "initial_weights": _factor(0.1, 60.0, "up to the full torque of the brake"),
    "initial_bound": _factor(0.1, 60.0, "up to the full torque of the brake"),
}
_REFERENCE_RANGES = {
    "falling_slip": SearchRange(low=0.1, high=0.32, why="the peaks of the rails known here"),
}
_TRACKING_RANGES = {
    **_REFERENCE_RANGES,
    "observer_rate": _factor(0.5, 2.0, "a factor 2 on both sides of the rule"),
    "valve_time_share": SearchRange(
        low=0.3, high=1.2, log=False, why="from the fastest valve of wide bounds to a slow one"
    ),
    "approach_rate": _factor(0.4, 2.5, "a factor 2.5 on both sides of the rule"),
    "ahead": SearchRange(
        low=0.0, high=1.2, log=False, why="from the sample to the next one and its dead time"
    ),
    "dead_band": _factor(0.1, 4.0, "from valves that hardly rest to those that rest most of the time"),
    "least_pulse": SearchRange(
        low=0.0, high=0.015, log=False, why="from every pulse to those of three quarters of a sample of 20 ms"
    ),
    "dead_band_share": _factor(0.1, 4.0, "as the dead band"),
}
_LAYER = _factor(0.2, 5.0, "a factor 5 on both sides of the rule")
OBSERVER_SMC_RANGES = {
    **_TRACKING_RANGES,
    "torque_slew": _factor(0.3, 10.0, "from a slow approach to nearly none of the braking curve"),
}
SUPER_TWISTING_RANGES = {
    **_TRACKING_RANGES,
    "integral_rate": _factor(0.1, 2.0, "from hardly any integral to an oscillating one"),
    "layer": _LAYER,
}
INTEGRAL_SMC_RANGES = {
    **_TRACKING_RANGES,
    "switching_gain": _factor(0.2, 5.0, "a factor 5 on both sides of the rule"),
    "layer": _LAYER,
}
FUZZY_SURFACE_RANGES = {
    **_REFERENCE_RANGES,
    "surface_rate": _factor(0.4, 2.5, "a factor 2.5 on both sides of the rule"),
    "rate_filter": _factor(0.2, 5.0, "from the raw difference to a slow one"),
    "layer": _LAYER,
    "weight_rate": _factor(0.05, 20.0, "from hardly any adaptation to that of a second"),
    "bound_rate": _factor(0.05, 20.0, "as the weights"),
    "leakage": _factor(0.05, 5.0, "from weights that stay to weights that fade at once"),
    "least_pulse": _factor(0.2, 4.0, "from pulses that hardly move a valve to long ones"),
}
_PULSES = _factor(0.1, 4.0, "from pulses that hardly move a valve to whole samples")
TABLE_RANGES = {
    "knorr-bremse": {
        "slide_limits": _factor(0.1, 3.0, "from the slide of a wheel that adheres to three times the table"),
        "acceleration_limits": _factor(0.2, 5.0, "a factor 5 on both sides of the table"),
        "pulses": _PULSES,
    },
    "trenitalia": {
        "slip_limits": _factor(0.1, 3.0, "from the slip of a wheel that adheres to three times the table"),
        "acceleration_limits": _factor(0.2, 5.0, "a factor 5 on both sides of the table"),
        "fill_pulse": _PULSES,
        "vent_pulse": _PULSES,
    },
    "mitsubishi": {
        "slide_centres": _factor(0.05, 5.0, "from hardly any slide to five times the table"),
        "rate_centres": _factor(0.2, 5.0, "a factor 5 on both sides of the table"),
        "duty_gain": _factor(0.2, 5.0, "a factor 5 on both sides of the table"),
        "duty_shift": SearchRange(
            low=-0.5, high=0.5, log=False, why="half a sample to both sides of the table"
        ),
    },
}
"""Ranges of the laws that decide by a table, by their families."""
