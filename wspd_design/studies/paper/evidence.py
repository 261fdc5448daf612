"""What the conclusions of the paper are judged by: figures of stops, without their traces."""

from dataclasses import dataclass

from wspd_design.simulation.metrics import Metrics
from wspd_design.simulation.self_check import StepCheck
from wspd_design.studies.paper.published import PublishedStops
from wspd_design.studies.paper.slip_history import SlipHistory

CONTROLLERS = ("trenitalia", "knorr-bremse", "mitsubishi", "afsmc")
"""Those of Table 10, in its order."""

UNPROTECTED = "none"

CONSTANT_RAILS = ("table10-dry", "table10-wet")
"""Friction that does not fall with the sliding speed, calibrated on Table 10."""

FALLING_RAILS = ("polach-dry", "polach-wet")
"""The published friction of Polach (2005), which the paper cites."""

RAILS = (*CONSTANT_RAILS, *FALLING_RAILS)


@dataclass(frozen=True, slots=True, kw_only=True)
class StopFigures:
    """One stop in numbers."""

    controller: str
    rail: str
    metrics: Metrics
    check: StepCheck
    history: SlipHistory


@dataclass(frozen=True, slots=True, kw_only=True)
class Ablation:
    """The paper's law with parts taken out, on one rail; distances in m."""

    rail: str
    printed: float  # as printed, u in kN m
    as_share: float  # as printed, with u as a share of the maximum torque
    unadapted: float  # the same with both adaptation rates at zero
    relay: float  # full brake where s > 0, full release elsewhere: neither rules nor adaptation
    unadapted_printed: float  # u in kN m and both adaptation rates at zero
    largest_weight: float  # of |b_hat| as printed, in maximum torques of the brake
    bound_growth: float  # psi_hat at the end over psi_hat at the start
    ripple: float  # -, of the slip in the second half of the stop
    ideal_ripple: float  # -, the same with the near-ideal actuator


@dataclass(frozen=True, slots=True, kw_only=True)
class Yardstick:
    """Idealized stops on one rail, with the same build-up of the brake unless said otherwise; distances in m."""

    rail: str
    ideal_stop: float  # at the adhesion peak
    ideal_time: float  # s
    ideal_at_once: float  # at the adhesion peak with full torque from the start
    constant_slip: float  # with the slip held at the reference


@dataclass(frozen=True, slots=True, kw_only=True)
class Evidence:
    """Everything that decides which of the paper's conclusions hold."""

    initial_speed: float  # m/s
    slip_reference: float  # -
    slip_tolerance: float  # -
    published: PublishedStops
    stops: tuple[StopFigures, ...]
    ablations: tuple[Ablation, ...]  # one for each rail
    yardsticks: tuple[Yardstick, ...]  # one for each rail
    ideal_fill_time: float  # s, of the near-ideal actuator
    ideal_sample_time: float  # s
    fill_time: float  # s, of the real one
    mean_loads: tuple[float, ...]  # N, vertical forces of Figure 21: mean of each wheelset, front first

    def stop(self, controller: str, rail: str) -> StopFigures:
        """Return one stop."""
        return next(each for each in self.stops if (each.controller, each.rail) == (controller, rail))

    def yardstick(self, rail: str) -> Yardstick:
        """Return the idealized stops on a rail."""
        return next(each for each in self.yardsticks if each.rail == rail)

    def ranking(self, rail: str) -> tuple[StopFigures, ...]:
        """Return the stops of the controllers of Table 10 on a rail, the shortest first."""
        stops = (self.stop(controller, rail) for controller in CONTROLLERS)
        return tuple(sorted(stops, key=lambda each: each.metrics.distance))
