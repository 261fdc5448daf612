"""Closed loops to make statements about."""

import math
from dataclasses import replace
from fractions import Fraction

import pytest

from wspd_design.certificates.kernel.checker import Refused, Work, decide
from wspd_design.certificates.kernel.obligation import Inequality, proof_of
from wspd_design.certificates.quantities import PLANT, TABLE
from wspd_design.certificates.records import Problem, Status
from wspd_design.certificates.search.settle import settle
from wspd_design.certificates.theorems.sliding import gain_claims
from wspd_design.controllers.sliding_mode import SlidingMode, SlidingModeGains
from wspd_design.design.problem import stated_bounds
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.loading import load_rail, load_vehicle

KEPT = ("mass", "wheelset inertia")
PUBLISHED_RAILS = ("polach-dry", "polach-wet")


def _problem(controller, *, rail="polach-dry", vehicle=None, **changes):
    vehicle, friction = vehicle or load_vehicle("er24pc"), load_rail(rail)
    stated = {
        "vehicle": vehicle,
        "rail": friction,
        "controller": controller,
        "slip": 0.14,
        "speeds": (10.0 / 3.6, 120.0 / 3.6),
        "slips": (0.02, 0.6),
        "sample_time": controller.sample_time,
    }
    bounds = stated_bounds(vehicle, friction) | changes.pop("bounds", {})
    return Problem(**{**stated, **changes}, bounds=bounds)


@pytest.fixture(scope="session")
def make_controller(make_controller):
    """Make a controller by name; the one with torque feedback is sampled every 20 ms unless said otherwise."""

    def make(name, rail="polach-dry", **changes):
        sampling = {"sample_time": 0.02} if name == "torque-feedback" else {}
        return make_controller(name, rail, **sampling | changes)

    return make


def _narrow(vehicle, friction, **bounds):
    """Bounds that hold every number at its nominal value but those that are named; an axle at static load."""
    exact = {name: (problem_value, problem_value) for name, problem_value in _nominal(vehicle, friction)}
    slowest = 0.1
    fastest = bounds.get("mu0", (0.0, friction.mu0))[1] * 9.81 + 0.2
    axle = {"axle load share": (1.0, 1.0), "train deceleration": (slowest, fastest)}
    return exact | axle | bounds


def _nominal(vehicle, friction):
    records = {"vehicle": vehicle, "brake": vehicle.brake, "contact": vehicle.contact, "rail": friction}
    return [(row.name, getattr(records[row.record], row.field)) for row in TABLE if row.record in records]


@pytest.fixture(scope="session")
def narrow():
    """Make bounds that hold every number but those that are named, for an axle at static load."""
    return _narrow


@pytest.fixture(scope="session")
def make_problem():
    """Make a problem about a controller, with changes by keyword."""
    return _problem


@pytest.fixture(scope="session")
def make_reference_problem():
    """Make the problem whose supremum is known to three decimals from an interval proof, for a gain W0."""

    def make(switching_gain=0.0):
        mass = 76841.0
        vehicle = load_vehicle("er24pc")
        # Only the product of the contact's numbers counts: 84 GPa, a b = 36 mm2, c11 4.12.
        contact = replace(
            vehicle.contact,
            shear_modulus=84e9,
            semi_axis_rolling=9e-3,
            semi_axis_lateral=4e-3,
            kalker_c11=4.12,
            reference_load=mass * 9.81 / 8.0,
        )
        vehicle = replace(
            vehicle,
            mass=mass,
            wheel_radius=0.55,
            wheelset_inertia=662.0,
            wheel_damping=1.0,
            resistance_constant=2000.0,
            resistance_linear=30.0,
            resistance_quadratic=6.0,
            contact=contact,
        )
        rail = replace(
            load_rail("polach-dry"),
            mu0=0.4,
            friction_ratio=0.4,
            friction_decay=0.6,
            adhesion_reduction=1.0,
            slip_reduction=0.4,
        )
        gains = SlidingModeGains(
            slip_reference=0.14, surface_rate=0.3, switching_gain=switching_gain, boundary_layer=0.02
        )
        law = SlidingMode(name="reference", sample_time=0.1, vehicle=vehicle, rail=rail, gains=gains)
        return Problem(
            vehicle=vehicle,
            rail=rail,
            controller=law,
            slip=0.14,
            speeds=(2.0, 33.4),
            slips=(0.02, 0.6),
            bounds=Bounds.of({"mass": (0.8 * mass, 1.2 * mass), "mu0": (0.2, 0.6)}),
            sample_time=0.1,
            contact_grows_with_load=False,
        )

    assert math.isclose(math.pi * 84e9 * 36e-6 * 4.12 / 4.0, 9.785e6, rel_tol=1e-4)
    return make


@pytest.fixture(scope="session")
def fast_vehicle(er24pc):
    """Return the locomotive with a valve that is thirty times faster than the paper's."""
    return replace(er24pc, brake=replace(er24pc.brake, fill_time=0.02, vent_time=0.02, supply_rate=5.0))


@pytest.fixture(scope="session")
def make_adaptive_problem(er24pc, make_problem):
    """Make a problem of the designed adaptive law, with other gains, on a domain in which the brake suffices."""
    rail = load_rail("polach-wet")
    designed = design_controller(er24pc, rail, Specification()).build(er24pc, rail)

    def make(**changes):
        law = replace(designed, gains=replace(designed.gains, **{"initial_bound": 12.0, **changes}))
        domain = {
            name: (low, high) for name, (low, high) in stated_bounds(er24pc, rail).items() if name in KEPT
        }
        bounds = _narrow(er24pc, rail, **domain | {"mu0": (0.28, 0.3)})
        return make_problem(law, rail="polach-wet", slips=(0.05, 0.3), bounds=bounds)

    return make


@pytest.fixture(scope="session")
def reference_claim(make_reference_problem):
    """(r + eta)/rho <= 30 m/s2 for the axle at static load; its supremum is 25.094."""
    return gain_claims(make_reference_problem(30.0), uses=PLANT)[-1].claim


@pytest.fixture(scope="session")
def settled():
    """Search for a claim and let the checker decide."""

    def found(claim, *, tolerance):
        return Inequality(key="claim", claim=claim).decide(settle(claim, tolerance=tolerance), Work())

    return found


@pytest.fixture(scope="session")
def proved(reference_claim, settled):
    """What the checker finds about the reference claim, with its proof."""
    found = settled(reference_claim, tolerance=0.01)
    assert found.status is Status.PROVED
    return found


@pytest.fixture(scope="session")
def proved_claim(reference_claim, proved):
    """Return the reference claim with the bound that its proof states."""
    return replace(reference_claim, bound=Fraction(float(proved.stated.proof["statement"]["bound"])))


@pytest.fixture(scope="session")
def tree(proved):
    return proved.stated.proof["tree"]


@pytest.fixture(scope="session")
def refusal():
    """Decide about a claim with any tree; return why it is refused, or nothing."""

    def reason(claim, tree, **changes):
        proof = proof_of(claim) | {"tree": tree}
        proof["statement"] = proof["statement"] | changes
        try:
            decide(proof, Work())
        except Refused as refused:
            return str(refused)
        return ""

    return reason
