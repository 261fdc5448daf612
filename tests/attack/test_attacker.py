"""No counterexample to what is PROVED of four designs is found, and claims that are false on purpose are broken."""

from dataclasses import replace

import numpy as np
import pytest

from tests.attack import linear
from tests.attack.__main__ import assault, chosen, main
from tests.attack.case import Inequality, Stated, read_case, read_stated
from tests.attack.claims import attacks, untouched
from tests.attack.counterexamples import coach, smc, torque_feedback
from tests.attack.sampled_claims import Pieces
from tests.attack.search import Attack, assail
from tests.attack.statements import needed_gain

EVALUATIONS = 6000
BOX = ("mass", "wheelset_inertia", "mu0")
CHECKS = {
    "smc": ("gain_positive", "reaching", "no_go"),
    "feedback-wet": ("gain_positive", "lpv_lyapunov"),
    "adaptive": ("no_go", "surface_hurwitz"),
}


def of(check, claim="", **entries):
    """A file that says that a check is PROVED."""
    return Stated(check=check, status="PROVED", claim=claim, **entries)


def broken(case, stated, names=BOX, evaluations=EVALUATIONS):
    """Statements of a file that the attacker breaks."""
    found = [
        assail(each, evaluations=evaluations, seed=3, stop=True) for each in attacks(case, stated, names)
    ]
    assert found
    return [each.attack.statement for each in found if each.broken]


# --- what the program proves


@pytest.mark.slow
@pytest.mark.parametrize("name", list(CHECKS))
def test_no_counterexample_to_what_is_stated(name, design, certified):
    case = read_case(design(name))
    folder = certified(name, CHECKS[name])
    files = [each for each in map(read_stated, sorted(folder.glob("*.json"))) if each.check in CHECKS[name]]
    assert {each.check for each in files} == set(CHECKS[name])
    assert not [each.check for each in files if untouched(each)]
    found = assault(case, files, wish="stated", evaluations=EVALUATIONS, seed=5)
    assert {each.attack.check for each in found} == set(CHECKS[name])
    assert not [(each.attack.check, each.attack.statement, each.point) for each in found if each.broken]


def test_the_command_prints_what_it_tried_and_counts_it(design, certified, capsys):
    folder = certified("smc", CHECKS["smc"])
    words = [str(design("smc")), str(folder), "--only", "gain_positive", "--evaluations", "500", "--varied"]
    capsys.readouterr()
    assert main([*words, "stated"]) == 0
    first = capsys.readouterr().out
    assert "held     gain_positive: G > 0" in first
    assert "in 500 points" in first
    assert main([*words, "stated"]) == 0
    assert capsys.readouterr().out.splitlines()[0] == first.splitlines()[0]


# --- planted falsehoods

REACHING = "W0 outweighs the model error, eta = 0.204 m/s2."


def test_a_gain_ten_percent_too_small_is_broken():
    assert broken(smc(), of("reaching", REACHING)) == []
    case = smc()
    weak = replace(case, gains={**case.gains, "switching_gain": 0.9 * case.gains["switching_gain"]})
    assert len(broken(weak, of("reaching", REACHING))) == 1


@pytest.mark.parametrize(("bound", "count"), [(9.4589, 0), (0.9 * 9.4589, 1), (9.45, 1)])
def test_a_stated_bound_that_is_too_low_is_broken(bound, count):
    """The supremum is 9.4578 to 9.4589."""
    case = smc()
    bounds = {name: case.data.bounds[name] for name in BOX}
    case = replace(case, data=replace(case.data, bounds=bounds))
    stated = Inequality(
        quantity="(abs(r) + eta)/rho",
        relation="<=",
        bound=bound,
        ranges={"slip": case.slips, "speed": case.speeds, **bounds},
    )
    found = broken(case, of("no builder", inequalities=(stated,)), evaluations=20_000)
    assert len(found) == count


def function(case, speed):
    """Proof of x'Px that falls by at least 0.9^2 per sample at one speed, x = (y, R T/I)."""
    from scipy.linalg import solve_discrete_lyapunov

    plant, at = case.data.plant, np.array([speed])
    slip, duty = linear.equilibrium(case, plant, at)
    scale = plant.wheel_radius * case.model.max_torque / plant.wheelset_inertia
    units = np.array([[1.0, 1.0 / scale], [scale, 1.0]])
    matrix = linear.sampled_map(case, plant, slip, at, duty)[..., 0] * units
    found = solve_discrete_lyapunov(matrix.T / 0.9, np.eye(2))
    p = [repr(float(each)) for each in (found[0, 0], found[0, 1], found[1, 1])]
    return {"steps": ".", "pieces": [["1", "0", "1", "-100", *p, "0.97"]]}


def test_another_vent_time_than_the_one_that_was_proved_is_broken():
    """P of a proof for T_F = T_V = 0.3 s: it falls there, and does not where the valve vents within 0.09 s."""
    proof = function(coach(0.3), 11.0)
    sampled = "the 1 functions fall, per sample with true pulses"
    for vent_time, wrong in ((0.3, False), (0.09, True)):
        case = replace(coach(vent_time), speeds=(10.9, 11.1), tolerance=1e-3)
        assert (sampled in broken(case, of("lpv_lyapunov", quadratics=(proof,)), ())) is wrong
    assert "the loop with true pulses settles at frozen speed" in broken(coach(0.09), of("lpv_lyapunov"), ())
    assert broken(coach(0.3), of("lpv_lyapunov"), ()) == []


def test_functions_are_taken_on_their_own_pieces():
    """A proof of two pieces of the fill time with P of the one and of the other exchanged is broken."""
    case = torque_feedback()
    pieces = Pieces(case, {"steps": "f.v..", "pieces": [["0"] * 8] * 3})
    assert pieces.low["fill_time"].tolist() == pytest.approx([0.3, 0.6, 0.6])
    assert pieces.high["vent_time"].tolist() == pytest.approx([0.9, 0.6, 0.9])


def test_an_equilibrium_that_leaves_the_tolerance_is_broken():
    moving = broken(torque_feedback(), of("lpv_lyapunov"))
    assert "the loop has an equilibrium within 0.05 of slip 0.14" in moving


def test_what_is_refuted_is_broken_when_it_is_said_to_be_proved():
    assert broken(smc(), of("sliding_exists", REACHING)) == ["u* >= eta/g"]
    case = torque_feedback("polach-dry")
    lag = Inequality(quantity="slip pole", relation="<=", bound=1.0 / 0.6, ranges={"speed": case.speeds})
    assert len(broken(case, of("open_loop_pole", inequalities=(lag,)))) == 1


@pytest.mark.slow
def test_a_stop_bound_one_percent_too_long_is_broken():
    right = of("stop_bound", "No controller stops within less than 272.29 m or 15.04 s.")
    assert broken(smc(), right, ()) == []
    false = of("stop_bound", "No controller stops within less than 275.1 m or 15.04 s.")
    assert len(broken(smc(), false, ())) == 1
    assert len(broken(smc(), right, BOX)) == 1  # it speaks about the nominal vehicle alone


def test_a_train_of_light_wheelsets_alone_is_no_vehicle():
    """The loads of the wheelsets add up to the weight: one that carries less is not all of them."""
    stated = of("stop_bound", "No controller stops within less than 272.29 m or 15.04 s.")
    (attack,) = attacks(smc(), stated, ("mass", "load_share"))
    assert set(attack.box) == {"mass", "whole"}


def test_limits_of_recovery_that_are_too_narrow_are_broken():
    case = smc()
    assert broken(case, of("hard_limits")) == []
    assert len(broken(replace(case, slips=(0.02, 0.195)), of("hard_limits"))) == 1


@pytest.mark.slow
def test_a_band_that_is_too_narrow_is_broken():
    """With half the layer that the law has, and with a weak push, errors leave the band."""
    case = smc()
    assert broken(case, of("boundary_layer"), evaluations=60_000) == []
    weak = replace(case, gains={**case.gains, "switching_gain": 0.2 * case.gains["switching_gain"]})
    assert len(broken(weak, of("boundary_layer"), evaluations=60_000)) == 1


ENERGY = ("bound on the integral of abs(s_D) d sigma", "Lipschitz constant of s_D in sigma")


def test_a_bound_under_another_name_is_not_passed_over(adaptive_case):
    with pytest.raises(ValueError, match="values to unpack"):
        broken(adaptive_case, of("barbalat", "eta = 0.209 m/s2", points={"bound of the integral": 2.0}))


@pytest.mark.slow
@pytest.mark.parametrize(("integral", "rate", "count"), [(0.275, 59.7, 0), (1e-4, 59.7, 1), (0.275, 5.0, 1)])
def test_bounds_of_the_adaptive_law_that_are_too_small_are_broken(integral, rate, count, adaptive_case):
    stated = of("barbalat", "eta = 0.209 m/s2", points=dict(zip(ENERGY, (integral, rate), strict=True)))
    assert len(broken(adaptive_case, stated)) == count


@pytest.mark.slow
def test_an_energy_that_rises_is_seen(adaptive_case):
    """Where the brake is too weak to hold the surface, V grows although the adaptation is held."""
    data = adaptive_case.data
    weak = replace(data, plant=data.plant.with_numbers({"max_torque": 20e3}))
    case = replace(adaptive_case, data=weak, slips=(0.0, 0.4), speeds=(25.0, 33.0))
    stated = of("afsmc_energy", "eta = 0.209 m/s2")
    assert len(broken(case, stated)) == 1
    assert broken(replace(case, data=data), stated) == []


def test_poles_of_a_law_without_torque_feedback_are_broken():
    case = torque_feedback("polach-dry")
    assert "all poles behind the averaged valve lie in the left half-plane" not in broken(
        case, of("routh_lag")
    )
    slip_only = replace(case, gains={**case.gains, "torque_gain": 0.0})
    assert "all poles behind the averaged valve lie in the left half-plane" in broken(
        slip_only, of("routh_lag")
    )


# --- the search itself


def test_the_search_is_counted_and_repeats_itself():
    def margin(x):
        return (x["a"] - 0.3) ** 2 + (x["b"] + 0.2) ** 2 - 1e-4

    attack = Attack(check="-", statement="-", box={"a": (-1.0, 1.0), "b": (-1.0, 1.0)}, margin=margin)
    first, second = (assail(attack, evaluations=2000, seed=1) for _ in range(2))
    assert first.evaluations == 2000
    assert (first.margin, first.point) == (second.margin, second.point)
    assert first.broken
    assert first.point["a"] == pytest.approx(0.3, abs=0.01)
    stopped = assail(attack, evaluations=2000, seed=1, stop=True)
    assert stopped.broken
    assert stopped.evaluations < 2000


def test_corners_are_tried_first():
    attack = Attack(
        check="-",
        statement="-",
        box=dict.fromkeys("abcd", (0.0, 1.0)),
        margin=lambda x: 3.5 - x["a"] - x["b"] - x["c"] - x["d"],
    )
    found = assail(attack, evaluations=64, stop=True)
    assert found.point == dict.fromkeys("abcd", 1.0)


def test_numbers_to_vary_are_all_stated_or_named():
    case, stated = smc(), of("x", varied=BOX)
    assert set(chosen(case, stated, "all")) == set(case.varied) >= {"vent_time", "slip_reduction", *BOX}
    assert set(chosen(case, stated, "stated")) == set(BOX)
    assert chosen(case, stated, "none") == ()
    assert chosen(case, stated, "mass,mu0") == ("mass", "mu0")


def test_what_is_not_a_number_is_no_counterexample():
    attack = Attack(
        check="-", statement="-", box={"a": (0.0, 1.0)}, margin=lambda x: np.full_like(x["a"], np.nan)
    )
    assert not assail(attack, evaluations=100).broken


def test_needed_gain_is_the_least_that_attracts():
    """With exactly this gain the surface attracts with eta, with a little less it does not."""
    case = smc()
    plant = case.data.plant.with_numbers({"mass": 92209.0, "wheelset_inertia": 860.0, "mu0": 0.36})
    needed = float(needed_gain(case, plant, 0.222, 2.8, 0.204))
    for factor, count in ((1.0001, 0), (0.9999, 1)):
        tuned = replace(case, gains={**case.gains, "switching_gain": factor * needed})
        at = {"slip": (0.222, 0.222), "speed": (2.8, 2.8)}
        (attack,) = attacks(tuned, of("reaching", REACHING), ())
        fixed = replace(
            attack,
            box=at,
            margin=lambda x, inner=attack.margin: inner(
                {**x, "mass": 92209.0, "wheelset_inertia": 860.0, "mu0": 0.36}
            ),
        )
        assert assail(fixed, evaluations=200).broken is bool(count)
