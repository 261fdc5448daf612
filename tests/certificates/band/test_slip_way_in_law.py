"""What the law makes of a sample, for random boxes of states and numbers, against one in equations of its own.

Valves that fill and vent at unlike rates, a dead band, a shortest pulse; torques and rooms from none to all of them.
"""

from dataclasses import replace

import numpy as np
import pytest

import wspd_design as wd
from tests.certificates.band.conftest import problem_of
from tests.certificates.band.sampled_runs import Law, measured_from
from wspd_design.certificates.kernel.affine import Affine
from wspd_design.certificates.theorems.slip_band.followed_law import decide
from wspd_design.certificates.theorems.slip_band.followed_plant import NUMBERS, State, plant_of

BOXES, POINTS = 600, 60
FIRST_STATE, FRESH, SIZE = 16, 24, 40  # symbols: 8 numbers, 8 combinations of them, 8 states, others
KNOWN = [*range(8), *range(FIRST_STATE, FRESH)]
# Half widths of speed, sliding speed, innovation, observed friction, torque, acceleration, change of the speed, supply
WIDEST = np.array([0.1, 0.1, 1e-3, 1500.0, 1500.0, 0.1, 2e-3, 0.02])
VALVES = {  # times of filling and venting, dead band, shortest pulse
    "alike": (0.6, 0.6, 0.0, 0.0),
    "slow to fill": (0.9, 0.4, 0.0, 0.0),
    "slow to vent": (0.4, 0.9, 0.0, 0.0),
    "very slow": (9.0, 9.0, 0.0, 0.0),
    "with dead band": (0.9, 0.4, 900.0, 0.0),
    "with shortest pulse": (0.4, 0.9, 0.0, 0.008),
    "with little dead band": (0.6, 0.5, 50.0, 0.0),
    "with both": (0.5, 0.6, 400.0, 0.004),
}


@pytest.fixture(scope="module", params=VALVES)
def problem(request):
    fill, vent, dead_band, least = VALVES[request.param]
    whole = problem_of(1.0, rail=wd.load_rail("low-adhesion"))
    law = whole.controller
    valve = replace(
        law.valve, brake=replace(law.valve.brake, fill_time=fill, vent_time=vent), least_pulse=least
    )
    tracking = replace(law.core.tracking, valve=valve, dead_band=dead_band, dead_band_share=1e3)
    return replace(whole, controller=replace(law, valve=valve, core=replace(law.core, tracking=tracking)))


def states(problem, random, size):
    """Middles of boxes and their half widths: most of them near the reference, or at one end of the torques."""
    full = problem.controller.valve.brake.max_torque

    def near():
        return random.normal(size=BOXES) * 10.0 ** random.uniform(-4.0, 0.0, BOXES)

    speed, supply = random.uniform(8.0, 33.0, BOXES), random.uniform(0.05, 1.0, BOXES)
    share = np.where(random.random(BOXES) < 0.5, random.random(BOXES), 0.5 + 0.5 * np.tanh(4.0 * near()))
    share = np.where(random.random(BOXES) < 0.3, np.round(share) + 0.01 * near(), share)
    torque = np.maximum(share * supply * full, 0.0)
    middles = np.stack(
        [
            speed,
            np.maximum(speed * 0.14 * (1.0 + 0.3 * near()), 0.0),
            0.01 * near(),
            np.maximum(torque * (1.0 + 0.3 * near()) + 2e3 * near() - 1e3, 0.0),
            torque,
            -random.uniform(0.0, 1.5, BOXES),
            -random.uniform(0.0, 0.03, BOXES),
            supply,
        ],
        axis=1,
    )
    widths = WIDEST * size[:, None]
    widths[:, 4] = np.minimum(widths[:, 4], torque)  # no brake pushes
    return middles, widths


class Decision:
    """Forms of what is decided, and what the other law decides at points of the same boxes."""

    def __init__(self, problem, random, boxes, size):
        centers, widths = boxes
        count, law = len(centers), problem.controller
        z = random.uniform(-1.0, 1.0, (count, SIZE, POINTS))
        self.z = np.where(random.random(z.shape) < 0.6, np.sign(z), z)
        nominal = np.array([problem.nominal(name) for name in NUMBERS])
        halves = nominal * 0.05 * size[:, None]

        def form(values, half, symbol):
            slopes = np.zeros((count, SIZE))
            slopes[:, symbol] = half
            return Affine(np.array(values), slopes, np.zeros(count))

        numbers = {name: form(np.full(count, nominal[k]), halves[:, k], k) for k, name in enumerate(NUMBERS)}
        state = State(
            *(form(centers[:, k], widths[:, k], FIRST_STATE + k) for k in range(len(State._fields)))
        )
        plant = plant_of(problem.vehicle, problem.rail, law.valve.brake.max_torque, numbers, 8)
        free = iter(range(FRESH, SIZE))
        with np.errstate(all="ignore"):
            self.decided = decide(law, plant, state, lambda form: form.named(next(free)))
        points = nominal[:, None] + halves[:, :, None] * self.z[:, : len(NUMBERS)]
        self.other(
            Law(law, problem.slip),
            points[:, NUMBERS.index("wheel radius")],
            np.moveaxis(centers[:, :, None] + widths[:, :, None] * self.z[:, FIRST_STATE:FRESH], 1, 0),
        )

    def other(self, law, radius, states):
        """Pulses, and what the observer expects, in the words of the forms."""
        torque, supply = states[4], states[7]
        memory, wheel = measured_from(law, radius, states)
        with np.errstate(all="ignore"):
            fill, vent, mean = law.pulses(memory, wheel, torque, law.full * supply)
        self.seen = {
            "fill": fill / law.h,
            "vent": vent / law.h,
            "friction": memory.friction,
            "acceleration": memory.acceleration / memory.scale,
            "innovation": -radius * (memory.observed + law.h / law.inertia * (memory.friction - mean)),
        }
        up, down = (
            law.valve.time_share * each for each in (law.valve.brake.fill_time, law.valve.brake.vent_time)
        )
        # A pulse tells what is asked of the valve, where nothing is left out and there is room for the logarithms.
        room, least = law.full * supply - torque, 2.0 * (1e-3 * law.full + 1e-3)
        self.asked = -room * np.expm1(-fill / up) + torque * np.expm1(-vent / down)
        self.told = (room > least) & (torque > least)

    def beyond(self, name, value, where=True):
        """By how much values are farther from their form than the error allows, at most."""
        form = getattr(self.decided, name)
        known = form.center[:, None] + np.einsum("bs,bsp->bp", form.slopes[:, KNOWN], self.z[:, KNOWN])
        others = [k for k in range(SIZE) if k not in KNOWN]
        error = form.error + np.abs(form.slopes[:, others]).sum(axis=1)
        return np.max(np.where(where, np.abs(value - known) - error[:, None], 0.0))


SCALES = {"fill": 1.0, "vent": 1.0, "friction": 1e3, "acceleration": 1.0, "innovation": 1.0}


def exact(problem):
    """Whether nothing of a way is left out."""
    law = problem.controller
    return not law.core.tracking.dead_band and not law.valve.least_pulse


@pytest.mark.parametrize("seed", range(3))
def test_law_decides_in_random_boxes_as_one_in_other_equations(problem, seed):
    random = np.random.default_rng(seed)
    size = 10.0 ** random.uniform(-4.0, 0.0, BOXES)  # of a box, over the widest one
    found = Decision(problem, random, states(problem, random, size), size)
    for name, scale in SCALES.items():
        assert found.beyond(name, found.seen[name]) <= 1e-9 * scale, name
    if exact(problem):
        assert found.beyond("way", found.asked, found.told) <= 1e-6
    # Pulses of all lengths, and none, are among them.
    for name in ("fill", "vent"):
        assert {0.0, 1.0} <= set(np.round(found.seen[name].ravel(), 3))
        assert np.count_nonzero((found.seen[name] > 0.1) & (found.seen[name] < 0.9)) > 100


@pytest.mark.parametrize("more", [False, True])
@pytest.mark.parametrize("fills", [True, False])
def test_law_that_takes_its_logarithm_of_another_ratio_commands_less_than_is_asked(problem, fills, more):
    """In little room or with little torque, a thousandth of all of it is what the logarithm is taken of at least."""
    law, random, count = problem.controller, np.random.default_rng(1), 200
    full, brake, h = law.valve.brake.max_torque, law.valve.brake, law.sample_time
    time = law.valve.time_share * (brake.fill_time if fills else brake.vent_time)
    least = 1e-3 * full + 1e-3
    edge = least * np.exp(h / time)  # from there on all of the sample is what is asked
    near, around = edge * (1.0 - 1e-5 * random.random(count)), edge * random.uniform(0.9, 1.2, count)
    left = np.where(random.random(count) < 0.5, near, around)
    # All of it is asked and more, or just so much that less is left than counts.
    short = np.maximum(least - left * np.exp(-h / time), 0.0) * random.random(count)
    way = left - (-least if more else least - short)
    torque = 0.5 * full - left if fills else left
    acceleration = -0.7 if fills else 0.7  # a train that gets faster lets a law that sees no friction vent
    centers = np.tile([25.0, 3.5, 0.0, 0.0, 0.0, acceleration, acceleration * h, 0.5], (count, 1))
    centers[:, 3] = friction_for(problem, torque, way if fills else -way, acceleration)
    centers[:, 4] = torque
    size = np.full(count, 1e-9)
    found = Decision(problem, random, (centers, WIDEST * size[:, None]), size)
    for name, scale in SCALES.items():
        assert found.beyond(name, found.seen[name]) <= 1e-9 * scale, name
    if not law.core.tracking.dead_band:  # which may be more than is asked
        share = found.seen["fill" if fills else "vent"]
        assert np.count_nonzero(share < 1.0 - 1e-6) > 100
        assert share.max() == pytest.approx(1.0)


def friction_for(problem, torque, way, acceleration):
    """Observed friction with which the law at its reference asks for a way [N m]."""
    law = problem.controller
    inertia, ahead = law.wheelset_inertia, law.core.tracking.ahead * law.sample_time
    rate = 0.86 / problem.nominal("wheel radius") * acceleration
    # What is asked is the friction, less what turns the wheel, and the pull to an error that goes with the friction.
    pulled = law.core.tracking.approach_rate * ahead
    return torque + inertia * rate + way / (1.0 + pulled)
