"""What the sensors of a vehicle of four axles show."""

import pytest

from wspd_design.controllers.protocol import VehicleMeasurement

RADIUS = 0.55


@pytest.fixture
def seen():
    """Make a measurement from rim speeds."""

    def make(rims, *, speed=0.0, healthy=None, demand=0.0, acceleration=0.0):
        count = len(rims)
        return VehicleMeasurement(
            speed=speed,
            wheel_speeds=tuple(rim / RADIUS for rim in rims),
            torques=(0.0,) * count,
            healthy=healthy or (1.0,) * count,
            pressures=(0.0,) * count,
            acceleration=acceleration,
            demand=demand,
            reservoir=6e5,
        )

    return make


@pytest.fixture
def follow():
    """Lead a source through measurements; return its estimates, the one of the start included."""

    def lead(source, measurements):
        state = source.start(measurements[0])
        none = (0.0,) * source.wheelsets
        estimates = []
        for each in measurements:
            state, estimate = source.step(state, each, none, none)
            estimates.append(estimate)
        return estimates

    return lead
