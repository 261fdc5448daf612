"""What many tests share: the paper's vehicle, its controllers, and stops that are simulated once."""

import os
from dataclasses import fields
from functools import cache

import pytest
from hypothesis import settings

from wspd_design.certificates.memory import remembering
from wspd_design.codegen import compiler
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy, AdaptiveFuzzyGains
from wspd_design.controllers.baselines.knorr_bremse import KnorrBremse
from wspd_design.controllers.baselines.mitsubishi import Mitsubishi
from wspd_design.controllers.baselines.trenitalia import Trenitalia
from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.controllers.sliding_mode import SlidingMode, SlidingModeGains
from wspd_design.design.catalog import controller as designed
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import (
    load_knorr_bremse,
    load_mitsubishi,
    load_paper_gains,
    load_rail,
    load_trenitalia,
    load_vehicle,
)
from wspd_design.parameters.records import PaperGains
from wspd_design.simulation.metrics import metrics
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate

# As the command does; the workers and the commands that tests start inherit it.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# The same examples each time: a failure is of the commit, not of the day.
settings.register_profile("same", derandomize=True)
settings.load_profile("same")

SLIP_REFERENCE = 0.14
INITIAL_SPEED = 120.0 / 3.6


@pytest.fixture(scope="session")
def er24pc():
    return load_vehicle("er24pc")


def _printed_gains(**changes):
    printed = load_paper_gains()
    gains = {field.name: getattr(printed, field.name) for field in fields(PaperGains)}
    return AdaptiveFuzzyGains(
        **{
            **gains,
            "slip_reference": SLIP_REFERENCE,
            "dead_zone": False,
            "hold_when_saturated": False,
            "scheduled_rates": False,
            **changes,
        }
    )


@pytest.fixture(scope="session")
def printed_gains():
    """Make the printed gains of the adaptive fuzzy law, with changes by keyword."""
    return _printed_gains


def _controller(name, rail="polach-dry", sample_time=0.1, preset="calibrated"):
    vehicle = load_vehicle("er24pc")
    radius, torque = vehicle.wheel_radius, vehicle.brake.max_torque
    common = {"name": name, "sample_time": sample_time}
    match name:
        case "afsmc":
            return AdaptiveFuzzy(**common, wheel_radius=radius, max_torque=torque, gains=_printed_gains())
        case "afsmc-repaired":
            gains = _printed_gains(dead_zone=True, hold_when_saturated=True)
            return AdaptiveFuzzy(**common, wheel_radius=radius, max_torque=torque, gains=gains)
        case "smc":
            gains = SlidingModeGains(
                slip_reference=SLIP_REFERENCE, surface_rate=0.4, switching_gain=15.0, boundary_layer=0.025
            )
            return SlidingMode(**common, vehicle=vehicle, rail=load_rail(rail), gains=gains)
        case "torque-feedback":
            return designed(name, vehicle, load_rail(rail), Specification(sample_time=sample_time))
        case "trenitalia":
            return Trenitalia(**common, wheel_radius=radius, table=load_trenitalia(preset))
        case "knorr-bremse":
            return KnorrBremse(**common, wheel_radius=radius, table=load_knorr_bremse(preset))
        case "mitsubishi":
            return Mitsubishi(**common, wheel_radius=radius, table=load_mitsubishi(preset))
        case "none":
            return Unprotected(**common)
    raise KeyError(name)


@pytest.fixture(scope="session")
def make_controller():
    """Make a controller of the paper's vehicle by name."""
    return _controller


@pytest.fixture(scope="session")
def stop(er24pc):
    """Simulate a stop of the quarter locomotive from 120 km/h by the names of controller and rail, once each."""

    @cache
    def simulated(controller, rail):
        scenario = Scenario(rail=load_rail(rail), initial_speed=INITIAL_SPEED)
        return simulate(er24pc, _controller(controller, rail), scenario, plant="quarter")

    return simulated


@pytest.fixture(scope="module")
def remembered():
    """Search and decide nothing twice in a file; not for one that changes how this is done."""
    with remembering():
        yield


@pytest.fixture(scope="module")
def compiled_quickly():
    """Compile in half the time; that this does not change a bit is seen in the tests of stops side by side."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(compiler, "FLAGS", tuple("-O1" if flag == "-O3" else flag for flag in compiler.FLAGS))
        yield


@pytest.fixture(scope="session")
def judged(er24pc, stop):
    """Judge such a stop."""

    @cache
    def judge(controller, rail):
        scenario = Scenario(rail=load_rail(rail), initial_speed=INITIAL_SPEED)
        return metrics(stop(controller, rail), er24pc, scenario, slip_reference=SLIP_REFERENCE)

    return judge
