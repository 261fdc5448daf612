"""Table 10 of the paper beside the quarter locomotive on the calibrated rails.

The quarter locomotive has no weight transfer, so this is a band of 4 % and no fit.
"""

import pytest

# Distance [m], stopping time [s] and sum of the torque integrals [kN m s], as printed.
TABLE_10 = {
    ("trenitalia", "dry"): (184.63, 9.9, 1572.48),
    ("trenitalia", "wet"): (221.15, 12.3, 1564.66),
    ("knorr-bremse", "dry"): (207.37, 10.5, 1570.26),
    ("knorr-bremse", "wet"): (246.68, 13.1, 1576.44),
    ("mitsubishi", "dry"): (201.40, 10.5, 1556.8),
    ("mitsubishi", "wet"): (235.33, 12.8, 1570.31),
    ("afsmc", "dry"): (184.03, 9.8, 1578.03),
    ("afsmc", "wet"): (220.60, 12.2, 1565.84),
}


@pytest.mark.parametrize(("controller", "condition"), TABLE_10)
def test_row(judged, controller, condition):
    found = judged(controller, f"table10-{condition}")
    ours = (found.distance, found.stopping_time, found.torque_integral / 1e3)
    assert ours == pytest.approx(TABLE_10[controller, condition], rel=0.04)


@pytest.mark.parametrize("condition", ["dry", "wet"])
def test_order_of_the_distances(stop, condition):
    # The paper's ranking; the two shortest are 0.3 % apart in the table and may change places.
    distance = {
        name: stop(name, f"table10-{condition}").totals.distance
        for name in ("afsmc", "trenitalia", "mitsubishi", "knorr-bremse")
    }
    assert max(distance["afsmc"], distance["trenitalia"]) < distance["mitsubishi"] < distance["knorr-bremse"]


@pytest.mark.parametrize("condition", ["dry", "wet"])
def test_locked_wheels_stop_as_short_as_the_papers_law(stop, condition):
    # Findings section 3: with an adhesion that does not fall, a locked wheel loses nothing.
    locked = stop("none", f"table10-{condition}").totals.distance
    assert locked <= stop("afsmc", f"table10-{condition}").totals.distance


@pytest.mark.parametrize(
    ("controller", "rail", "distance", "tolerance"),
    [
        ("none", "polach-dry", 249.3, 0.015),
        ("none", "polach-wet", 424.4, 0.015),
        ("afsmc", "polach-dry", 223.4, 0.03),
        ("afsmc", "polach-wet", 315.7, 0.03),
        ("trenitalia", "polach-dry", 212.9, 0.03),
        ("trenitalia", "polach-wet", 307.3, 0.03),
    ],
)
def test_distances_of_the_findings_on_falling_friction(stop, controller, rail, distance, tolerance):
    # Findings section 3, four axles: without weight transfer within the tolerances that the engine has to meet.
    assert stop(controller, rail).totals.distance == pytest.approx(distance, rel=tolerance)


def test_table_10_cannot_come_from_the_published_wet_rail(stop):
    # Findings: on the published wet set nobody stops in the printed 12.2 s.
    assert min(stop(name, "polach-wet").time[-1] for name in ("afsmc", "trenitalia", "knorr-bremse")) > 14.4
