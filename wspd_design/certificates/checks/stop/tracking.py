"""The loop as it is built, with sampling, valves, lag and lock: does the slip stay at its reference?"""

from wspd_design.certificates.checks.frame import OutsideModel, certified, level, series
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting import laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.metrics import metrics
from wspd_design.simulation.records import Ending, Scenario
from wspd_design.simulation.stop import simulate

NAME, TITLE = "tracking", "Slip of the sampled loop"
SETTLED_SHARE = 0.5  # of the initial speed: build-up of the brake and the transient lie above it


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Simulate a stop from the highest speed and judge the slip error once the transient is over."""
    import numpy as np

    law = problem.controller
    if not isinstance(law, (AdaptiveFuzzy, SlidingMode)):
        return laws.not_applicable(
            problem, NAME, "The slip error stays below 2 Phi/K_P.", "has no boundary layer"
        )
    if min(problem.speeds) <= 0.0:
        raise OutsideModel(f"the speeds {problem.speeds[0]:g} to {problem.speeds[1]:g} m/s must be positive")
    bound = 2.0 * laws.layer(law)
    reference = law.gains.slip_reference
    scenario = Scenario(rail=problem.rail, initial_speed=problem.speeds[1])
    run = simulate(problem.vehicle, law, scenario, plant="quarter")
    settled = SETTLED_SHARE * problem.speeds[1]
    errors = np.abs(run.slip[:, 0] - reference)
    judged = np.flatnonzero((run.speed <= settled) & (run.speed >= problem.speeds[0]))
    if judged.size == 0:  # never slow enough: the last instant shows it
        judged = np.array([len(run.time) - 1])
    worst = int(judged[np.argmax(errors[judged])])
    stays = float(errors[worst]) <= bound and run.ending is Ending.STOPPED
    figures = metrics(run, problem.vehicle, scenario, slip_reference=reference)
    outside = float(np.mean(errors[judged] > bound))
    where = (
        Point(name="time", value=float(run.time[worst]), unit="s"),
        Point(name="speed", value=float(run.speed[worst]) * KMH, unit="km/h"),
        Point(name="slip", value=float(run.slip[worst, 0]), unit="-"),
        Point(name="torque", value=float(run.torque[worst, 0]), unit="N m"),
        Point(name="slip rms about the reference", value=figures.slip_rms, unit="-"),
    )
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"In the sampled loop with valves, lag and wheel lock the slip error stays below 2 Phi/K_P = "
        f"{bound:.3g} from {settled * KMH:.3g} km/h, half of the initial speed, down to "
        f"{problem.speeds[0] * KMH:.3g} km/h on {problem.rail.name}.",
        status=Status.EVIDENCE if stays else Status.REFUTED,
        explanation=f"The slip strays as far as {run.slip[worst, 0]:.3f} from its reference "
        f"{reference:g} and is outside the bound at {outside:.0%} of the judged instants; its rms about "
        f"the reference above {JUDGING_SPEED * KMH:.0f} km/h is {figures.slip_rms:.3f}. The wheels lock for "
        f"{figures.lock_time:.2g} s; {run.ending.value}."
        + (
            ""
            if stays
            else " The claim is about a simulated stop: the witness is this stop itself; the step check of wspd "
            "simulate says how far its steps can be trusted."
        ),
        margin=Range(low=None, high=bound - float(errors[worst]), unit="-"),
        worst_point=where,
        witness=() if stays else where,
        assumptions=(
            "quarter locomotive, nominal parameters",
            "exact measurement",
            "the integral of the error has decayed: 2 Phi/K_P bounds the error only after the transient",
        ),
        method="simulation of one stop, valve edge to valve edge",
        resolution=f"one run; {judged.size} instants are judged",
        reference="eqs. (25), (37); docs/theory.md#layer",
        series=(
            series("slip", "time [s]", "slip [-]", run.time, run.slip[:, 0]),
            level("reference", "time [s]", "slip [-]", run.time, reference),
            series("speed", "time [s]", "speed [km/h]", run.time, run.speed * KMH),
        ),
    )
