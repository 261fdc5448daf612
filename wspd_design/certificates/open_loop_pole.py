"""Without feedback of torque or acceleration the valve must be faster than the slip pole: p tau < 1."""

from wspd_design.certificates import domain, laws, slip_pole
from wspd_design.certificates.checking import OutsideModel, certified
from wspd_design.certificates.domain import KMH, SPEED
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status

NAME, TITLE = "open_loop_pole", "Slip pole against the valve"


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Search the largest slip pole on the domain and compare it with the rate of the valve.

    At an equilibrium the sum of all closed-loop poles is p - 1/tau for every law whose memory holds integrals
    alone, whatever its gains. If it is positive, one pole is unstable.
    """
    brake = problem.vehicle.brake
    lag = min(brake.fill_time, brake.vent_time)
    poles = slip_pole.pole_map(problem)
    highest = poles.highest
    limit = 1.0 / lag
    exceeded = highest.value >= limit
    if exceeded:
        checked = slip_pole.exact_pole(problem, highest.point)
        if checked < limit:
            raise OutsideModel(
                f"two ways to compute the slip pole disagree: {highest.value:g}, {checked:g} 1/s"
            )
    form = laws.slip_feedback_only(problem)
    where = domain.readable(highest.point)
    spot = f"p = {highest.value:.3g} 1/s at {highest.point[SPEED] * KMH:.3g} km/h"
    if form.status is Status.REFUTED:
        status = Status.NOT_APPLICABLE
        meaning = "The law uses more than the slip, so that this limit does not bind it"
    elif exceeded:
        status = Status.REFUTED
        meaning = (
            "Every equilibrium there is unstable whatever the gains: the slip swings around its reference"
        )
    else:
        status = Status.EVIDENCE
        meaning = "The valve is fast enough for feedback of the slip alone"
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"The open-loop slip pole p stays below 1/tau = {limit:.3g} 1/s at slip {problem.slip:g}, "
        f"as any law without feedback of torque or acceleration needs; on {domain.described(problem)}.",
        status=status,
        explanation=f"{meaning}: {spot}. {slip_pole.unstable_speeds(poles, limit)}.",
        margin=Range(low=None, high=limit - highest.value, unit="1/s"),
        worst_point=where,
        witness=(*where, Point(name="slip pole", value=checked, unit="1/s")) if exceeded else (),
        hypotheses=(form,),
        assumptions=(
            "frozen train speed",
            "averaged valve with the smaller of its two time constants",
            "static wheel load",
        ),
        method="grid over speed, even Sobol sampling, local optimization; a witness is checked by CasADi's "
        "derivative",
        resolution=f"{len(poles.speeds)} speeds with all corners of the parameters, "
        f"{highest.evaluations} further points",
        reference="eqs. (14), (19); findings, section 2, no-go",
        series=slip_pole.plots(poles, "1/tau", limit),
    )
