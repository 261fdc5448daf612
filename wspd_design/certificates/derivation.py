"""The equations that the program runs on follow from the laws of motion: identities of the functions themselves.

The derivations prove them at development time. Here the functions that are installed are executed on SymPy symbols,
so that a changed sign or constant in any of them is found where the numbers are made.
"""

from collections.abc import Callable
from typing import Any

from wspd_design.certificates.checking import certified
from wspd_design.certificates.records import Certificate, Hypothesis, Problem, Status
from wspd_design.model.equations import load_equations
from wspd_design.model.generated import adaptive_fuzzy, brake, motion, sliding_surface, slip

NAME, TITLE = "derivation", "Equations of the model"


def slip_equation(symbol: Callable[[str], Any]) -> Any:
    """Eq. (19): the rate of the slip ratio by eqs. (1) to (3), less F + G T."""
    import sympy as sp

    v, lam, m, i, r, b, f, f_d, torque = map(symbol, ("v", "lam", "m", "I", "R", "B", "f", "f_d", "T"))
    wheel = symbol("omega")
    ratio = slip.slip_ratio(v, wheel, r, v)
    rate = sp.diff(ratio, v) * motion.train_acceleration(f, f_d, m)
    rate += sp.diff(ratio, wheel) * motion.wheel_acceleration(f, wheel, torque, i, r, b)
    stated = slip.slip_drift(lam, v, f, f_d, m, i, r, b) + slip.slip_gain(v, i, r) * torque
    return rate.subs(wheel, slip.wheel_speed_at_slip(lam, v, r)) - stated


def brake_lag(symbol: Callable[[str], Any]) -> Any:
    """Eq. (14): the torque of the filling law (9) under full supply, less the first-order lag."""
    pressure, full, most, duty, tau = map(symbol, ("P", "P_max", "T_max", "u", "tau"))
    rate = brake.cylinder_pressure_rate(pressure, full, duty, 1 - duty, tau, tau)
    torque = brake.braking_torque(pressure, most, full)
    return brake.braking_torque(rate, most, full) - brake.torque_rate(torque, duty, most, tau)


def filling(symbol: Callable[[str], Any]) -> Any:
    """Eqs. (8) to (10): the exact filling law solves the differential equation of the cylinder."""
    import sympy as sp

    t, t0, start, full, rate, tau = map(symbol, ("t", "t_0", "P_0", "P_max", "r", "T_F"))
    pressure = brake.filled_pressure(t, t0, start, full, rate, tau)
    supply = brake.supply_pressure(t, full, rate)
    return sp.diff(pressure, t) - brake.cylinder_pressure_rate(pressure, supply, 1, 0, tau, tau)


def error_dynamics(symbol: Callable[[str], Any]) -> Any:
    """Eq. (39): e' + c e less G (u* - u), with the equivalent torque of eq. (23) as u*."""
    drift, gain, reference_rate, e, c, u = map(symbol, ("F", "G", "lam_d_rate", "e", "c", "u"))
    ideal = sliding_surface.equivalent_torque(drift, gain, reference_rate, e, c)
    return reference_rate - (drift + gain * u) + c * e - gain * (ideal - u)


def repaired_energy(symbol: Callable[[str], Any]) -> Any:
    """Eq. (44) repaired: the rate of V along the loop for s_D > 0, outside the layer, less the stated one."""
    import sympy as sp

    s, v, a, g, xi, psi = map(symbol, ("s_D", "v", "a", "g", "xi", "psi"))
    b2, bound, a1, a2, b_w = map(symbol, ("b2", "psi_error", "alpha_1", "alpha_2", "b_w"))
    energy = adaptive_fuzzy.lyapunov_repaired(s, v, g, b2, bound, a1, a2)
    moves = {s: g / v * (b_w + xi - (psi - bound)), v: -a, b2: -2 * a1 * s * b_w, bound: -a2 * s}
    rate = sum(sp.diff(energy, x) * moved for x, moved in moves.items())
    return rate - adaptive_fuzzy.lyapunov_repaired_rate(s, a, g, xi, psi)


IDENTITIES: tuple[tuple[str, Callable[[Callable[[str], Any]], Any]], ...] = (
    ("(19) slip' = F + G T from (1) to (3)", slip_equation),
    ("(14) tau T' + T = T_max u from (9), (12)", brake_lag),
    ("(10) exact with the supply of (8)", filling),
    ("(39) e' + c e = G (u* - u)", error_dynamics),
    ("(44) V' of the repaired V", repaired_energy),
)


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:  # noqa: ARG001 - the identities hold for all numbers
    """Execute the model's functions on symbols and simplify what must vanish."""
    import sympy as sp

    def symbol(name: str) -> Any:
        return sp.Symbol(name, positive=True)

    residuals = [(text, sp.simplify(sp.nsimplify(left_over(symbol)))) for text, left_over in IDENTITIES]
    wrong = [(text, residual) for text, residual in residuals if residual != 0]
    misprints = [entry.number for entry in load_equations() if entry.verdict == "misprint"]
    return Certificate(
        name=NAME,
        title=TITLE,
        claim="The functions that compute slip, brake, error and energy satisfy (19), (14), (10), (39) and the "
        "repaired (44) as identities.",
        status=Status.REFUTED if wrong else Status.PROVED,
        explanation=(
            f"{wrong[0][0]} leaves {wrong[0][1]}: a function of the model is wrong."
            if wrong
            else f"All residuals are 0. Printed otherwise in the paper: {', '.join(misprints)}; see wspd equations."
        ),
        hypotheses=tuple(
            Hypothesis(text=text, status=Status.PROVED if residual == 0 else Status.REFUTED)
            for text, residual in residuals
        ),
        assumptions=("all symbols positive", "outside the boundary layer, s_D > 0, for (44)"),
        method="SymPy on the installed functions",
        resolution="exact",
        reference="eqs. (1)-(3), (8)-(10), (14), (19), (39), (44)",
    )
