"""Maps of margins: sampled in floating point, they agree with what the prover encloses and the checker accepts."""

from dataclasses import replace

import numpy as np
import pytest

from wspd_design.certificates.checks.foundations import well_posed
from wspd_design.certificates.checks.margin_map import margin_map
from wspd_design.certificates.checks.sliding import reaching, sliding_exists
from wspd_design.certificates.checks.valve import open_loop_pole
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting import domain

ROUNDING = 1e-6


def _smc(make_controller, make_problem, rail):
    return make_problem(make_controller("smc", rail), rail=rail)


RAILS = ("polach-dry", "polach-wet")


@pytest.mark.parametrize(
    ("check", "sign", "scale", "rail"),
    [
        pytest.param(reaching.CHECK.run, 1.0, 1.0, "polach-dry", marks=pytest.mark.reference),
        (reaching.CHECK.run, 1.0, 1.0, "polach-wet"),
        # p tau <= 1 with the slowest valve, 0.9 s; the map shows p
        *((open_loop_pole.CHECK.run, 1.0, 0.9, rail) for rail in RAILS),
        *((well_posed.CHECK.run, -1.0, 1.0, rail) for rail in RAILS),
        (sliding_exists.CHECK.run, -1.0, 1e3, "polach-dry"),
        pytest.param(sliding_exists.CHECK.run, -1.0, 1e3, "polach-wet", marks=pytest.mark.reference),
    ],
)
def test_the_worst_of_the_map_is_what_is_proved(make_controller, make_problem, check, sign, scale, rail):
    certificate = check(_smc(make_controller, make_problem, rail))
    (shown,) = certificate.maps
    values = np.array(shown.values)
    margins = sign * (shown.limit - values) * scale
    margin = certificate.margin
    low = margin.low
    if low is None:  # the search ended at a witness
        assert certificate.status is Status.REFUTED
        low = -np.inf
    assert low - ROUNDING <= margins.min() <= margin.high + ROUNDING
    row, column = shown.y.index(shown.worst[1]), shown.x.index(shown.worst[0])
    assert margins[row, column] == margins.min()
    speed = next(each.value for each in certificate.worst_point if each.name == "speed")
    assert shown.worst[0] == pytest.approx(speed)


def _map(problem, quantity, largest=True, **changes):
    low, high = domain.box(problem)
    worst = dict(zip(domain.BASIC, high.tolist(), strict=True)) | changes
    return margin_map(
        "name", "value [-]", quantity, (low, high), over=domain.SLIP, limit=0.0, worst=worst, largest=largest
    )


def test_each_point_holds_the_worst_of_the_other_coordinates(make_controller, make_problem):
    problem = _smc(make_controller, make_problem, "polach-dry")

    def quantity(points):
        return points[:, domain.SLIP] + 10.0 * points[:, domain.MU0] - points[:, domain.MASS] / 1e5

    (most,), (least,) = _map(problem, quantity), _map(problem, quantity, largest=False)
    shift = 10.0 * problem.span("mu0")[1] - problem.span("mass")[0] / 1e5
    assert np.array(most.values) == pytest.approx(
        np.array(most.y)[:, np.newaxis] + shift + 0 * np.array(most.x)
    )
    shift = 10.0 * problem.span("mu0")[0] - problem.span("mass")[1] / 1e5
    assert np.array(least.values)[:, 0] == pytest.approx(np.array(least.y) + shift)
    assert (most.y[0], most.y[-1]) == problem.slips
    assert (most.x[0], most.x[-1]) == pytest.approx([speed * 3.6 for speed in problem.speeds])


def test_a_tightest_point_inside_the_ranges_is_on_the_map(make_controller, make_problem):
    problem = _smc(make_controller, make_problem, "polach-dry")
    mu0 = problem.rail.mu0

    def peak(points):
        return -np.abs(points[:, domain.MU0] - mu0) - np.abs(points[:, domain.SPEED] - 12.3)

    (shown,) = _map(problem, peak, speed=12.3, slip=0.123, mu0=mu0)
    assert shown.worst == (pytest.approx(44.28), 0.123)
    assert np.max(shown.values) == 0.0


def test_one_speed_has_no_map(make_controller, make_problem):
    problem = _smc(make_controller, make_problem, "polach-dry")
    assert _map(replace(problem, speeds=(20.0, 20.0)), lambda points: points[:, 0]) == ()
    assert well_posed.CHECK.run(replace(problem, slips=(0.14, 0.14))).maps == ()
