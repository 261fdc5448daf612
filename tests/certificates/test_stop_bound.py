"""The bound for every controller against dense sampling, ideal stops and all controllers at hand."""

import json
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from wspd_design.certificates.checks.stop import stop_bound
from wspd_design.certificates.records import Status
from wspd_design.certificates.search import adhesion_peaks as peak_search
from wspd_design.certificates.setting.fingerprint import model_hash
from wspd_design.certificates.theorems.shortest_stop import adhesion_limit, adhesion_peaks
from wspd_design.model import adhesion
from wspd_design.model.slip import resistance
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.records import Scenario

START = 120.0 / 3.6


@pytest.fixture(scope="module")
def proved(make_problem, make_controller):
    """Problem, certificate and what the checker computes from it, for each rail."""
    kept = {}

    def of(rail):
        if rail not in kept:
            problem = make_problem(make_controller("none"), rail=rail)
            text = peak_search.search(problem)
            kept[rail] = problem, text, adhesion_peaks.check(problem, text).limit
        return kept[rail]

    return of


@pytest.fixture(scope="module", params=["polach-dry", "polach-wet", "table10-wet"])
def limit(request, proved):
    problem, _, found = proved(request.param)
    return problem.rail, found


@pytest.mark.parametrize("rail", ["polach-dry", "polach-wet", "table10-dry"])
@pytest.mark.parametrize("interval", [0, 20, 190])
def test_peak_encloses_dense_samples(er24pc, proved, rail, interval):
    problem, _, found = proved(rail)
    load = 76841.0 * 9.81 / 8.0
    stiffness = adhesion.contact_stiffness(er24pc.contact, load)
    slips = np.geomspace(1e-5, 1.0, 200_001)
    referred = max(float(found.speeds[interval]), 0.1)
    densest = float(adhesion.creep_force(slips, slips * referred, load, problem.rail, stiffness).max()) / load
    assert densest <= found.peaks[interval] <= densest + 2.0 * peak_search.MARGIN


@pytest.mark.parametrize(
    ("rail", "distance", "time"), [("polach-dry", 179.91, 9.27), ("polach-wet", 272.2, 15.03)]
)
def test_bound_is_as_good_as_one_that_branch_and_bound_finds(proved, rail, distance, time):
    """Numbers of an enclosure of the peaks within 2e-4."""
    _, _, found = proved(rail)
    assert distance <= found.distance < 1.002 * distance
    assert time <= found.time < 1.002 * time


def test_bound_lies_closely_below_ideal_stops(er24pc, limit):
    rail, found = limit
    scenario = Scenario(rail=rail, initial_speed=START)
    for slip in (None, 0.02, 0.05, 0.14, 0.3):
        ideal = ideal_stop(er24pc, scenario, slip=slip, plant="quarter")
        assert found.distance <= ideal.distance
        assert found.time <= ideal.stopping_time
    best = ideal_stop(er24pc, scenario, plant="quarter")
    assert found.distance > 0.96 * best.distance
    assert found.time > 0.96 * best.stopping_time


def test_adhesion_part_against_an_integration(er24pc, limit):
    """SciPy on the enclosed peaks as a step function, without the sums of the bound."""
    _, found = limit
    speeds, peaks = (np.array([float(each) for each in exact]) for exact in (found.speeds, found.peaks))

    def rates(v, _):
        peak = peaks[np.clip(np.searchsorted(speeds, v, side="right") - 1, 0, len(peaks) - 1)]
        strongest = 9.81 * peak + resistance(er24pc, v) / er24pc.mass
        return [1.0 / strongest, v / strongest]

    run = solve_ivp(rates, (0.0, START), [0.0, 0.0], max_step=0.02, rtol=1e-8)
    time, distance = run.y[:, -1]
    assert found.adhesion_time <= time <= 1.002 * found.adhesion_time
    assert found.adhesion_distance <= distance <= 1.002 * found.adhesion_distance


def test_momentum_bounds_the_simulated_speed_from_below(er24pc, stop):
    for name in ("none", "afsmc", "trenitalia"):
        run = stop(name, "polach-dry")
        for k in range(50, 1000, 90):
            slowest = adhesion_limit.slowest(er24pc, Fraction(START), float(run.time[k]))
            assert run.speed[k] >= float(slowest)
    # It says something: the brake alone decides in the first half second.
    assert (
        run.speed[200] - float(adhesion_limit.slowest(er24pc, Fraction(START), float(run.time[200]))) < 0.05
    )


@pytest.mark.parametrize("name", ["afsmc", "smc", "none", "torque-feedback"])
def test_proved_and_kept(make_problem, make_controller, name):
    verdict = stop_bound.check(make_problem(make_controller(name, "polach-wet"), rail="polach-wet"))
    assert verdict.status is Status.PROVED
    at = {point.name: point.value for point in verdict.worst_point}
    assert at["bound on the time"] > 14.4  # the printed 12.2 s cannot come from this rail
    assert (
        at["bound on the distance"] < at["distance of the ideal stop"] <= at["distance of the simulated stop"]
    )


@pytest.mark.parametrize("factor", [1.1, 2.0])
def test_planted_bound_is_refuted_by_a_stop(make_problem, make_controller, monkeypatch, factor):
    right = adhesion_peaks.check

    def wrong(*given):
        found = right(*given)
        return replace(found, limit=replace(found.limit, distance=factor * found.limit.distance))

    monkeypatch.setattr(adhesion_peaks, "check", wrong)
    verdict = stop_bound.check(
        make_problem(make_controller("torque-feedback", "polach-wet"), rail="polach-wet")
    )
    assert verdict.status is Status.REFUTED
    assert verdict.witness


def _words(key, change):
    """Change the list of numbers under a key."""

    def changed(content):
        words = content[key].split()
        change(words)
        content[key] = " ".join(words)

    return changed


def _cuts(change, interval=100):
    def changed(content):
        words = content["cuts"][interval].split()
        change(words)
        content["cuts"][interval] = " ".join(words)

    return changed


def _lowered(words):
    """Lower all peaks a little below the true ones."""
    words[:] = [f"{float(word) - 1.5 * peak_search.MARGIN:.6f}" for word in words]


def _one_lowered(words):
    words[100] = f"{float(words[100]) - 1.5 * peak_search.MARGIN:.6f}"


def _swapped(words):
    words[5], words[6] = words[6], words[5]


def _twice(words):
    words[6] = words[5]


def _placed(index, word):
    def change(words):
        words[index] = word

    return change


def _left_out(words):
    """Leave out what covers the slips about the peak."""
    del words[len(words) // 4 : 3 * len(words) // 4]


FAULTS = {
    "all peaks lowered": (_words("peaks", _lowered), "is not shown for slips"),
    "one peak lowered": (_words("peaks", _one_lowered), "is not shown for slips"),
    "peak of zero": (_words("peaks", _placed(3, "0")), "is not shown for slips"),
    "missing peak": (_words("peaks", lambda words: words.pop(7)), "one peak and one list of cuts"),
    "missing speed": (_words("speeds", lambda words: words.pop(7)), "one peak and one list of cuts"),
    "missing cuts": (lambda content: content["cuts"].pop(), "one peak and one list of cuts"),
    "gap at standstill": (_words("speeds", _placed(0, "0.01")), "do not rise from 0"),
    "speeds that overlap": (_words("speeds", _swapped), "do not rise from 0"),
    "speed twice": (_words("speeds", _twice), "do not rise from 0"),
    "speed above the first": (_words("speeds", _placed(-1, "40")), "do not rise from 0"),
    "slips left out": (_cuts(_left_out), "is not shown for slips"),
    "no cuts": (_cuts(lambda words: words.clear()), "is not shown for slips"),
    "cuts that overlap": (_cuts(_swapped), "do not rise between 0 and 1"),
    "cut beyond 1": (_cuts(_placed(-1, "1.1")), "do not rise between 0 and 1"),
    "negative peak": (_words("peaks", _placed(3, "-0.4")), "states no peaks"),
    "infinite peak": (_words("peaks", _placed(3, "inf")), "states no peaks"),
    "peak that is not a number": (_words("peaks", _placed(3, "nan")), "states no peaks"),
    "number that fills the memory": (_words("peaks", _placed(3, "1e999999999")), "states no peaks"),
    "speed that is not a number": (_words("speeds", _placed(3, "nan")), "states no speeds"),
    "cut that is not a number": (_cuts(_placed(3, "1/0")), "states no cuts"),
    "numbers in place of text": (lambda content: content.update(peaks=[0.4]), "states no peaks"),
    "no peaks": (lambda content: content.pop("peaks"), "states no peaks"),
    "too many speeds": (lambda content: content.update(speeds="0 " * 2000), "states no speeds"),
    "other format": (lambda content: content.update(format="wspd-proof/1"), "does not have the format"),
    "other claim": (lambda content: content.update(claim_sha256="0" * 64), "belongs to another claim"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_planted_faults_are_refused(proved, fault):
    problem, text, _ = proved("polach-dry")
    change, reason = FAULTS[fault]
    content = json.loads(text)
    change(content)
    verdict = adhesion_peaks.check(problem, json.dumps(content))
    assert not verdict.accepted
    assert reason in verdict.reason


@pytest.mark.parametrize("text", ["", "{", "[]", "null", "NaN", "[" * 100_000, " " * 2_000_000, "\x00\ufffd"])
def test_what_is_no_certificate_is_refused(proved, text):
    problem, _, _ = proved("polach-dry")
    assert not adhesion_peaks.check(problem, text).accepted


def _forged(text, problem):
    """Write the fingerprint of another problem over that of a certificate."""
    return json.dumps(json.loads(text) | {"claim_sha256": model_hash(problem)})


def test_another_rail_vehicle_or_speed_is_another_claim(proved):
    problem, text, _ = proved("polach-wet")
    dry, _, _ = proved("polach-dry")
    light = replace(problem, vehicle=replace(problem.vehicle, mass=0.5 * problem.vehicle.mass))
    faster = replace(problem, speeds=(problem.speeds[0], 1.2 * START))
    for other in (dry, light, faster):
        assert "another claim" in adhesion_peaks.check(other, text).reason
    # Whoever forges the fingerprint still has to show the peaks.
    for other in (dry, light):
        assert "is not shown" in adhesion_peaks.check(other, _forged(text, other)).reason
    # The peaks hold at higher speeds as well: what is shown then is true.
    found = adhesion_peaks.check(faster, _forged(text, faster))
    assert "from 144 km/h" in found.statement
    ideal = ideal_stop(
        faster.vehicle, Scenario(rail=faster.rail, initial_speed=faster.speeds[1]), plant="quarter"
    )
    assert found.limit.distance < ideal.distance


def test_fewer_speeds_show_less_but_nothing_false(proved):
    problem, text, whole = proved("polach-dry")
    content = json.loads(text)
    for key in ("speeds", "peaks"):
        content[key] = " ".join(content[key].split()[::4])
    content["cuts"] = content["cuts"][::4]
    found = adhesion_peaks.check(problem, json.dumps(content))
    assert found.accepted
    assert 0.97 * whole.distance < found.limit.distance < whole.distance
    assert found.limit.time < whole.time


@pytest.mark.parametrize(
    "mutation",
    [
        {"MARGIN": -1e-4},
        {"MARGIN": 0.0, "SAMPLES": 40},
        {"LEAST_SLIP": 0.1, "MARGIN": 0.0},
        {"FIRST": 10.0, "LEAST_STEP": 9.0},
    ],
)
def test_mutated_searches_prove_nothing(make_problem, make_controller, monkeypatch, mutation):
    """Peaks too low, from coarse samples, from a part of the slip, and cuts that are too far apart."""
    for name, value in mutation.items():
        monkeypatch.setattr(peak_search, name, value)
    verdict = stop_bound.check(make_problem(make_controller("none")))
    assert verdict.status is Status.UNDECIDED
    assert not verdict.proofs
    assert "the checker refuses" in verdict.claim


def test_what_the_derivation_does_not_cover_is_undecided(make_problem, make_controller, er24pc):
    downhill = replace(er24pc, resistance_constant=-1e3)
    verdict = stop_bound.check(make_problem(make_controller("none"), vehicle=downhill))
    assert verdict.status is Status.UNDECIDED
    dragged = replace(er24pc, resistance_constant=8e6)
    with pytest.raises(adhesion_limit.NoBound, match="outrun"):
        adhesion_limit.require(dragged, load_rail("polach-wet"), START)


@pytest.mark.parametrize(
    "change", [{"friction_decay": -0.1}, {"friction_ratio": 1.2}, {"slip_reduction": 0.0}]
)
def test_friction_that_grows_with_sliding_has_no_bound(er24pc, change):
    with pytest.raises(adhesion_limit.NoBound, match="never grows with sliding"):
        adhesion_limit.require(er24pc, replace(load_rail("polach-wet"), **change), START)
