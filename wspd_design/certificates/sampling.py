"""With sampling and valve lag, feedback of the slip stabilizes a slip pole only below p_max(h, tau)."""

import math

from wspd_design.certificates import domain, laws, slip_pole
from wspd_design.certificates.checking import certified
from wspd_design.certificates.domain import KMH, SPEED
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status

NAME, TITLE = "sampling", "Slip pole against sampling and valve"


def largest_pole(sample_time: float, lag: float) -> float:
    """Return the largest slip pole that feedback of the sampled slip can stabilize [1/s].

    The plant 1/((s - p)(tau s + 1)) behind a zero-order hold is b(z)/a(z) with the poles exp(p h) and
    exp(-h/tau). A gain moves them towards each other on the real axis until they meet and part; a stabilizing
    gain exists exactly if they meet inside the unit circle. At the limit they meet at z = 1, where
    a'(1) b(1) = a(1) b'(1). For small h the limit is 1/(tau + h/2): half a sample counts as lag.

    Parameters
    ----------
    sample_time : float
        Sampling interval h [s].
    lag : float
        Time constant of the valve tau [s].
    """
    from scipy.optimize import brentq

    slow = math.exp(-sample_time / lag)

    def meeting(pole: float) -> float:
        """Negative while the poles meet inside the unit circle."""
        growth = math.exp(pole * sample_time)
        # Step response 1/p (exp(pt) - 1) filtered by the lag, as residues at the two poles.
        fast_part = (growth - 1.0) / (pole * (1.0 + pole * lag))
        slow_part = (slow - 1.0) * lag / (1.0 + pole * lag)
        gain = fast_part + slow_part  # b1
        rest = -fast_part * slow - slow_part * growth  # b0
        a_at_one, slope_of_a = (1.0 - growth) * (1.0 - slow), 2.0 - growth - slow
        return a_at_one * gain - slope_of_a * (gain + rest)

    return float(brentq(meeting, 1e-6 / lag, 1.0 / lag))


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Search the largest slip pole on the domain and compare it with what sampled feedback can stabilize."""
    brake = problem.vehicle.brake
    lag = min(brake.fill_time, brake.vent_time)
    limit = largest_pole(problem.sample_time, lag)
    poles = slip_pole.pole_map(problem)
    highest = poles.highest
    form = laws.slip_feedback_only(problem)
    exceeded = highest.value >= limit
    where = domain.readable(highest.point)
    growth = math.exp(max(highest.value, 0.0) * problem.sample_time)
    over_lag = math.exp(max(highest.value, 0.0) * (problem.sample_time + lag))
    if form.status is Status.REFUTED:
        status, meaning = (
            Status.NOT_APPLICABLE,
            "The law uses more than the slip; this limit does not bind it.",
        )
    elif exceeded:
        status, meaning = Status.REFUTED, "No gain on the sampled slip is stable there."
    else:
        status, meaning = (
            Status.EVIDENCE,
            "A stabilizing gain on the sampled slip exists at every speed tried.",
        )
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"The slip pole stays below p_max = {limit:.3g} 1/s, the largest that proportional feedback of "
        f"the slip, sampled every {problem.sample_time * 1e3:g} ms, stabilizes through a valve of {lag:g} s; "
        f"at slip {problem.slip:g} on {domain.described(problem)}.",
        status=status,
        explanation=f"{meaning} At {highest.point[SPEED] * KMH:.3g} km/h a deviation of the slip grows by a "
        f"factor of {growth:.4g} within one sample and {over_lag:.4g} within sample and valve lag. "
        f"{slip_pole.unstable_speeds(poles, limit)}.",
        margin=Range(low=None, high=limit - highest.value, unit="1/s"),
        worst_point=where,
        witness=(*where, Point(name="slip pole", value=highest.value, unit="1/s")) if exceeded else (),
        hypotheses=(form,),
        assumptions=(
            "frozen train speed",
            "averaged valve with the smaller of its two time constants",
            "torque command held over a sample: pulse width modulation without ripple",
            "proportional feedback of the slip error",
        ),
        method="exact zero-order-hold discretization; grid over speed, Sobol sampling, local optimization",
        resolution=f"{len(poles.speeds)} speeds with all corners of the parameters, "
        f"{highest.evaluations} further points",
        reference="eqs. (13)-(15), (19); docs/theory.md#routh",
        series=slip_pole.plots(poles, "p_max", limit),
    )
