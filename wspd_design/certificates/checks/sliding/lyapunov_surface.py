"""V = s^2/2 of (24) along the loop of the sliding-mode law: it must not rise outside the boundary layer."""

from itertools import product
from typing import TypeAlias

from wspd_design.certificates.checks.certain_rise import (
    Rise,
    certain_rise,
    certainty,
    exact_law,
    rising_state,
)
from wspd_design.certificates.checks.frame import certified, level, series
from wspd_design.certificates.checks.ideal_run import (
    ASSUMPTIONS,
    RELATIVE_TOLERANCE,
    ProofRun,
    State,
    cut_short,
    largest_rise,
    numeric_rate,
    sliding_flow,
    sliding_run,
    verdict,
)
from wspd_design.certificates.records import Certificate, Point, Problem, Range
from wspd_design.certificates.setting import domain, laws
from wspd_design.certificates.setting.domain import KMH
from wspd_design.certificates.setting.plant import Parameters, exact_plant
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.model.generated import sliding_surface
from wspd_design.model.number import Number

RisingRun: TypeAlias = tuple[ProofRun, Parameters, int, int]
"""A run, its parameters, and the instants between which V rises."""

NAME, TITLE = "lyapunov_surface", "V of the sliding mode"
TOLERANCE = 100.0 * RELATIVE_TOLERANCE  # of the largest V


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Run the idealized loop from both ends of the slip range, with nominal and extreme parameters."""
    import numpy as np

    law = problem.controller
    if not isinstance(law, SlidingMode):
        reason = "is no sliding mode with a friction model; (24) does not speak about it"
        return laws.not_applicable(
            problem, NAME, "V = s^2/2 does not rise outside the boundary layer.", reason
        )
    domain.box(problem)
    nominal = (problem.vehicle.mass, problem.vehicle.wheelset_inertia, problem.rail.mu0)
    corners = product(problem.mass_bounds, problem.inertia_bounds, problem.mu0_bounds)
    parameters = list(dict.fromkeys([nominal, *corners]))
    edge = float(sliding_surface.lyapunov_surface(law.gains.boundary_layer))
    curves, runs = [], []
    worst: tuple[float, *RisingRun] | None = None
    for chosen, slip in product(parameters, problem.slips):
        vehicle, rail = domain.varied(problem, *chosen)
        run = sliding_run(vehicle, rail, law, speeds=problem.speeds, slip=slip)
        runs.append(run)
        values = sliding_surface.lyapunov_surface(_surface(law, run.states))
        # Inside the layer V may do as it likes, below the value at its edge.
        rise, start, end = largest_rise(np.maximum(values, edge))
        rise /= max(float(values.max()), edge)
        if worst is None or rise > worst[0]:
            worst = rise, run, chosen, start, end
        if chosen == nominal:
            curves.append(series(f"V from slip {slip:g}", "time [s]", "V [-]", run.time, values))
    assert worst is not None
    rise, run, (mass, inertia, mu0), start, end = worst
    rises = not rise <= TOLERANCE
    shown = _certain_rise(problem, law, worst[1:]) if rises else None
    where: tuple[Point, ...] = (
        Point(name="mass", value=mass, unit="kg"),
        Point(name="wheelset inertia", value=inertia, unit="kg m2"),
        Point(name="mu0", value=mu0, unit="-"),
        Point(name="rising since", value=float(run.time[start]), unit="s"),
        Point(name="rising until", value=float(run.time[end]), unit="s"),
    )
    if shown is not None:
        where = (*rising_state(run, shown, "dV/dt", "1/s"), *where)
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"V = sbar^2/2, sbar = s/K_P, does not rise while abs(sbar) > {law.gains.boundary_layer:g}, "
        f"from slip {problem.slips[0]:g} and {problem.slips[1]:g} at {problem.speeds[1] * KMH:.3g} km/h down "
        f"to {problem.speeds[0] * KMH:.3g} km/h.",
        status=verdict(rises, shown is not None, runs),
        explanation=(
            f"V rises by {rise:.3g} of its maximum between {run.time[start]:.3g} s and "
            f"{run.time[end]:.3g} s: the switching gain does not outweigh the model error there. "
            f"{certainty(run, shown, 'dV/dt', '1/s')}"
            if rises
            else f"In all {len(runs)} runs the distance to the surface only shrinks until the layer is "
            "reached, and the state stays inside."
        )
        + cut_short(runs),
        margin=Range(low=None, high=TOLERANCE - rise, unit="of max V"),
        worst_point=where,
        witness=where if shown is not None else (),
        assumptions=(ASSUMPTIONS[0], "quarter locomotive with static wheel load", ASSUMPTIONS[2]),
        method=f"integration with Radau's method, relative tolerance {RELATIVE_TOLERANCE:g}; at a witness the "
        "derivative by forward derivatives in balls",
        resolution=f"{len(runs)} runs: nominal parameters and all corners of their bounds, each from two "
        f"slips; a rise below {TOLERANCE:g} of the maximum counts as rounding",
        reference="eqs. (24), (25); docs/theory.md#reaching",
        series=(*curves, level("edge of the layer", "time [s]", "V [-]", run.time, edge)),
    )


def _surface(law: SlidingMode, states: State) -> Number:
    """Return sbar of states in whatever numbers."""
    _, slip, integral = states
    error = sliding_surface.slip_error(law.gains.slip_reference, slip)
    return sliding_surface.sliding_variable(error, integral, 1.0, law.gains.surface_rate)


def _certain_rise(problem: Problem, law: SlidingMode, worst: RisingRun) -> Rise | None:
    """Look for a state outside the layer at which V rises for certain, in the span of a run in which it rises."""
    import numpy as np

    run, parameters, start, end = worst

    def candidate(states: State) -> Number:
        return sliding_surface.lyapunov_surface(_surface(law, states))

    def outside(state: State) -> bool:
        return bool(abs(_surface(law, state)) > law.gains.boundary_layer)

    flow = sliding_flow(*exact_plant(problem, parameters), exact_law(law))
    order = start + np.argsort(-numeric_rate(candidate, run)[start : end + 1])
    return certain_rise(candidate, flow, run, order.tolist(), speaks=outside)
