"""References: their slopes by differences, and what the wheel then has to do."""

import pytest

from wspd_design.controllers.references import ConstantSlip, FallingSlip, SlipTable
from wspd_design.model.generated import slip_tracking
from wspd_design.model.generated.slip import wheel_speed_at_slip

REFERENCES = (
    ConstantSlip(slip=0.14),
    FallingSlip(slip=0.16, largest=0.35),
    SlipTable(speeds=(2.0, 10.0, 30.0), slips=(0.2, 0.06, 0.02)),
)


@pytest.mark.parametrize("reference", REFERENCES, ids=lambda each: type(each).__name__)
@pytest.mark.parametrize("speed", [0.5, 1.5, 5.0, 20.0, 40.0])
@pytest.mark.parametrize("scale", [1.0, 1.3])
def test_the_reference_accelerates_as_told(reference, speed, scale):
    radius, acceleration, step = 0.55, -1.3, 1e-6

    def wheel(time):
        v = speed + acceleration * time
        return wheel_speed_at_slip(reference.at(v, scale).slip, v, radius)

    desired = reference.at(speed, scale)
    told = slip_tracking.reference_acceleration(speed, acceleration, desired.slip, desired.slope, radius)
    assert told == pytest.approx((wheel(step) - wheel(-step)) / (2.0 * step), rel=1e-5)


def test_values():
    assert FallingSlip(slip=0.16, largest=0.35).at(16.0, 1.0).slip == pytest.approx(0.04)
    assert FallingSlip(slip=0.16, largest=0.35).at(0.01, 1.0).slip == 0.35
    table = REFERENCES[2]
    assert [table.at(v, 1.0).slip for v in (1.0, 6.0, 20.0, 50.0)] == pytest.approx([0.2, 0.13, 0.04, 0.02])
    assert [each.at(16.0, 1.5).slip / each.at(16.0, 1.0).slip for each in REFERENCES] == pytest.approx(
        [1.5] * 3
    )
