"""One of each record that shows itself, made once."""

from types import SimpleNamespace

import pytest

import wspd_design as wd


@pytest.fixture(scope="session")
def shown():
    vehicle, rail = wd.load_vehicle("er24pc"), wd.load_rail("polach-wet")
    specification = wd.Specification(sample_time=0.1)
    design = wd.design_controller(vehicle, rail, specification, law="smc")
    laws = [design.build(vehicle, rail), wd.controller("none", vehicle, rail, specification)]
    stop = wd.Scenario.stop(from_kmh=60, rail=rail, seed=1)
    trials = wd.compare(vehicle, laws, stop, slip_reference=0.14)
    proofs = wd.certify(design, only=["gain_positive", "sampling"])
    draws = wd.within_bounds(wd.load_entries("rail", "polach-wet"))
    campaign = wd.simulate_many(vehicle, laws[0], stop, count=20, draws=draws, check_every=0)
    return SimpleNamespace(
        vehicle=vehicle,
        rail=rail,
        design=design,
        linearization=wd.linearize(vehicle, rail, slip=0.14, speed_kmh=80),
        trials=trials,
        trial=trials[0],
        run=trials[0].run,
        metrics=trials[0].metrics,
        proofs=proofs,
        certificate=proofs[0],
        campaign=campaign,
        traces=trials[0].run.resampled(every=0.05),
    )
