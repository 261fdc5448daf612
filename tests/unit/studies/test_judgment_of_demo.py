"""The paper's law of the demo is rejected for its loop first, and what is said to do better does."""

from dataclasses import replace
from pathlib import Path

import pytest

from tests.unit.reporting.sample_dossier import SOUND
from wspd_design.certificates.suite import verify
from wspd_design.controllers.family import FAMILIES
from wspd_design.design.catalog import controller, controller_of
from wspd_design.design.file import read_design
from wspd_design.design.problem import stability_problem
from wspd_design.design.stop_requirements import LOOPS, MODEL, paper_requirements
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.comparison import trial
from wspd_design.simulation.records import Scenario
from wspd_design.studies import next_step as studied
from wspd_design.studies.judgment import judged_stop
from wspd_design.studies.loop_growth import growth_of
from wspd_design.studies.next_step import next_step

REPORTS = Path(__file__).parents[3] / "reports"
RAIL = load_rail("polach-wet")
STOP = Scenario.stop(from_kmh=120.0, rail=RAIL)


def _judged(er24pc, design):
    """Judge a design by what the paper asks, taking the equations as sound."""
    law = controller_of(design, er24pc, RAIL)
    problem = stability_problem(er24pc, RAIL, law, design.specification)
    checked = (*SOUND, *verify(problem, only=LOOPS, figures=False))
    own = trial(er24pc, law, STOP, slip_reference=design.specification.slip)
    return judged_stop(
        paper_requirements(design.specification),
        own,
        {each.name: each for each in checked},
        growth=growth_of(problem, checked),
        full_adhesion=173.0,
    )


@pytest.fixture(scope="module")
def paper(er24pc):
    design = read_design(str(REPORTS / "er24pc-polach-wet" / "design.toml"))
    return design, _judged(er24pc, design)


def test_the_papers_law_is_rejected_for_its_loop_first(paper):
    _, judged = paper
    assert judged.verdict == "rejected"
    first = judged.missed[0]
    assert (first.name, first.checks) == ("loop", ("margins",))
    assert first.reached > first.limit == 1.0
    assert [each.name for each in judged.missed] == ["loop", "slip_rms", "slip_overshoot"]
    assert judged.rows[0].checks == MODEL


def of(design, vehicle):
    return {
        "law": design.law,
        "vehicle": vehicle,
        "vehicle_name": "er24pc",
        "rail": RAIL,
        "asked": design.specification,
        "scenario": STOP,
        "plant": "planar",
        "certificates": SOUND,
        "full_adhesion": 173.0,
    }


def test_what_is_said_to_clear_it_does(paper, er24pc, monkeypatch):
    design, judged = paper
    monkeypatch.setattr(studied, "RULES", dict.fromkeys(("super-twisting", "integral-smc")))
    found = next_step(judged, **of(design, er24pc))
    assert len(found.tried) == 2
    for each in found.tried:
        specification = replace(design.specification, sample_time=each.sample_time)
        made = studied.design_controller(er24pc, RAIL, specification, law=each.law)
        again = _judged(er24pc, made)
        assert tuple(row.name for row in (*again.missed, *again.open)) == each.missed
    best = found.clears[0]
    assert (best.law, best.silent) == ("super-twisting", ("loop",))
    assert FAMILIES[best.law].reference is not None  # a law of the vehicle, of which no check judges the loop


def test_a_stop_that_a_comparison_has_is_not_simulated_again(paper, er24pc, monkeypatch):
    design, judged = paper
    monkeypatch.setattr(studied, "RULES", dict.fromkeys(("integral-smc",)))
    law = controller("integral-smc", er24pc, RAIL, design.specification)
    other = replace(law, sample_time=0.05)
    stop = trial(er24pc, law, STOP, slip_reference=design.specification.slip)
    simulated = []

    def counted(*arguments, **options):
        simulated.append(arguments[1])
        return trial(*arguments, **options)

    monkeypatch.setattr(studied, "trial", counted)
    monkeypatch.setattr(studied, "verify", lambda *_arguments, **_options: ())
    alone = next_step(judged, **of(design, er24pc))
    assert len(simulated) == len(alone.tried) == 1
    compared = [(other, "another stop"), (law, stop)]
    assert next_step(judged, **of(design, er24pc), compared=compared) == alone
    assert len(simulated) == 1
