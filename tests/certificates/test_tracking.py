"""The sampled loop with valves against the bound that the boundary layer promises."""

from dataclasses import replace

import pytest

from tests.certificates.round_trip import keep, no_word_can_be_changed, not_for, refused
from wspd_design.certificates.checks.stop import tracking
from wspd_design.certificates.records import Status
from wspd_design.controllers.protocol import Command
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.parameters.bounds import EXACT


class NeverVents(SlidingMode):
    """A fault: whatever the slip, the brake fills."""

    __slots__ = ()

    def step(self, state, measurement):
        following, _ = SlidingMode.step(self, state, measurement)
        return following, Command(fill=1.0, vent=0.0)


class NeverFills(SlidingMode):
    """A fault: the brake stays empty."""

    __slots__ = ()

    def step(self, state, measurement):
        following, _ = SlidingMode.step(self, state, measurement)
        return following, Command(fill=0.0, vent=1.0)


def _fields(law):
    return {name: getattr(law, name) for name in ("name", "sample_time", "vehicle", "rail", "gains")}


@pytest.fixture
def tracking_law(make_controller, fast_vehicle):
    law = make_controller("smc", "polach-wet", sample_time=0.01)
    return replace(law, vehicle=fast_vehicle)


def test_fast_valve_and_sampling_track_the_reference(make_problem, tracking_law, fast_vehicle):
    kept = keep(tracking.CHECK, make_problem(tracking_law, rail="polach-wet", vehicle=fast_vehicle))
    verdict = kept.certificate
    no_word_can_be_changed(kept)
    assert verdict.status is Status.EVIDENCE
    assert 0.0 < verdict.margin.high < 0.05


def test_controller_that_never_vents_is_refuted(make_problem, tracking_law, fast_vehicle):
    faulty = NeverVents(**_fields(tracking_law))
    kept = keep(tracking.CHECK, make_problem(faulty, rail="polach-wet", vehicle=fast_vehicle))
    verdict = kept.certificate
    assert verdict.status is Status.REFUTED
    no_word_can_be_changed(kept)
    # The stop is run again with the law of the design: the right law does not stray.
    assert not_for(kept, make_problem(tracking_law, rail="polach-wet", vehicle=fast_vehicle))
    at = {point.name: point.value for point in verdict.witness}
    assert at["slip"] == pytest.approx(1.0)
    assert 10.0 <= at["speed"] <= 60.0


def test_controller_that_never_fills_is_refuted(make_problem, tracking_law, er24pc):
    slippery = replace(er24pc, resistance_constant=60e3)  # so that the train stops soon
    faulty = NeverFills(**_fields(tracking_law))
    assert tracking.CHECK.run(make_problem(faulty, vehicle=slippery)).status is Status.REFUTED


@pytest.mark.parametrize("rail", ["polach-dry", "polach-wet"])
def test_printed_law_leaves_its_layer(make_problem, make_controller, rail):
    verdict = tracking.CHECK.run(make_problem(make_controller("afsmc"), rail=rail))
    assert verdict.status is Status.REFUTED
    at = {point.name: point.value for point in verdict.witness}
    assert abs(at["slip"] - 0.14) > 2.0 / 1800.0
    assert 0.03 < at["slip rms about the reference"] < 0.25


def test_laws_without_reference_claim_nothing(make_problem, make_controller):
    assert tracking.CHECK.run(make_problem(make_controller("trenitalia"))).status is Status.NOT_APPLICABLE


def test_brake_that_never_reaches_the_reference_says_so(make_problem, make_controller, er24pc):
    """A coach that uses half of the adhesion: the slip stays near zero, far below the reference."""
    coach = replace(er24pc, brake=replace(er24pc.brake, max_torque=6.6e3, bounds=EXACT))
    law = replace(make_controller("afsmc", "polach-wet"), max_torque=6.6e3)
    kept = keep(tracking.CHECK, make_problem(law, rail="polach-wet", vehicle=coach))
    assert kept.certificate.status is Status.VACUOUS
    assert kept.certificate.explanation.startswith("The brake never reaches the reference")
    assert refused(kept, status="REFUTED")
    findings = {key: each for key, each in kept.content["findings"].items() if "reach" not in key}
    assert refused(kept, findings=findings)


def test_another_reference_is_judged_by_that_of_the_law(make_problem, tracking_law, fast_vehicle):
    """Audit I5: a law with another reference is not measured against 0.14."""
    other = replace(tracking_law, gains=replace(tracking_law.gains, slip_reference=0.1))
    problem = make_problem(other, rail="polach-wet", vehicle=fast_vehicle)
    found = tracking.CHECK.run(problem)
    assert "around the reference 0.1 " in found.claim
    assert found.status is Status.EVIDENCE
