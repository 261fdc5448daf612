"""Section 7 on the multibody model: on smooth and on irregular track, and what its inferred numbers do."""

from dataclasses import dataclass

from wspd_design.plants.multibody.records import Multibody
from wspd_design.studies.paper.evidence import CONSTANT_RAILS
from wspd_design.studies.paper.section7 import Section7
from wspd_design.studies.rung import AxleFigures, axle_figures
from wspd_design.studies.tornado import Tornado

LAW = "afsmc"
"""The law of the figures of loads and of the tornado."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OnLocomotive:
    """What Section 7 comes to on the multibody model; all of it rests on numbers that are inferred."""

    model: Multibody
    smooth: Section7
    irregular: Section7  # the parts of the law are those on smooth track
    seed: int  # of the irregular track
    tornado: Tornado

    def axles(self, stops: Section7) -> tuple[AxleFigures, ...]:
        """Take the stop of Figure 21 apart by wheelset."""
        done = stops.trials[LAW, CONSTANT_RAILS[1]]
        return axle_figures(
            done.run,
            wheelsets=stops.vehicle.wheelsets,
            wheel_radius=stops.vehicle.wheel_radius,
            build_up=done.metrics.build_up,
        )
