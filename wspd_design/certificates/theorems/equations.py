"""Theorem about the equations that the program runs on: they follow from the laws of motion, as identities.

The derivations prove them at development time. Here the functions that are installed are executed on SymPy symbols,
so that a changed sign or constant in any of them is found where the numbers are made. Both sides of an identity are
compared in a prime field; nothing is simplified.
"""

from collections.abc import Callable
from typing import Any

from wspd_design.certificates.kernel.obligation import Identity
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.theorems.theorem import Findings, Theorem, all_of, hypothesis
from wspd_design.certificates.theorems.whom import every_law
from wspd_design.model.generated import adaptive_fuzzy, brake, motion, sliding_surface, slip
from wspd_design.parameters.equations import load_equations

Symbols = Callable[[str], Any]
"""Makes a positive SymPy symbol of a name."""


def slip_equation(symbol: Symbols) -> tuple[Any, Any]:
    """Eq. (19): the rate of the slip ratio by eqs. (1) to (3), and F + G T."""
    import sympy as sp

    v, lam, m, i, r, b, f, f_d, torque = map(symbol, ("v", "lam", "m", "I", "R", "B", "f", "f_d", "T"))
    wheel = symbol("omega")
    ratio = slip.slip_ratio(v, wheel, r, v)
    rate = sp.diff(ratio, v) * motion.train_acceleration(f, f_d, m)
    rate += sp.diff(ratio, wheel) * motion.wheel_acceleration(f, wheel, torque, i, r, b)
    stated = slip.slip_drift(lam, v, f, f_d, m, i, r, b) + slip.slip_gain(v, i, r) * torque
    return rate.subs(wheel, slip.wheel_speed_at_slip(lam, v, r)), stated


def brake_lag(symbol: Symbols) -> tuple[Any, Any]:
    """Eq. (14): the rate of torque of the filling law (9) under full supply, and that of the first-order lag."""
    pressure, full, most, duty, tau = map(symbol, ("P", "P_max", "T_max", "u", "tau"))
    rate = brake.cylinder_pressure_rate(pressure, full, duty, 1 - duty, tau, tau)
    torque = brake.braking_torque(pressure, most, full)
    return brake.braking_torque(rate, most, full), brake.torque_rate(torque, duty, most, tau)


def filling(symbol: Symbols) -> tuple[Any, Any]:
    """Eqs. (8) to (10): the rate of the exact filling law, and what the equation of the cylinder asks for."""
    import sympy as sp

    t, t0, start, full, rate, tau = map(symbol, ("t", "t_0", "P_0", "P_max", "r", "T_F"))
    pressure = brake.filled_pressure(t, t0, start, full, rate, tau)
    supply = brake.supply_pressure(t, full, rate)
    return sp.diff(pressure, t), brake.cylinder_pressure_rate(pressure, supply, 1, 0, tau, tau)


def error_dynamics(symbol: Symbols) -> tuple[Any, Any]:
    """Eq. (39): e' + c e, and G (u* - u) with the equivalent torque of eq. (23) as u*."""
    drift, gain, reference_rate, e, c, u = map(symbol, ("F", "G", "lam_d_rate", "e", "c", "u"))
    ideal = sliding_surface.equivalent_torque(drift, gain, reference_rate, e, c)
    return reference_rate - (drift + gain * u) + c * e, gain * (ideal - u)


def printed_energy(symbol: Symbols) -> tuple[Any, Any]:
    """Eq. (44) corrected: the rate of V2 along the loop for s > 0, and (44) with the terms of G'."""
    import sympy as sp

    s, gain, gain_rate, k_p, xi, psi = map(symbol, ("s", "G", "G_rate", "K_P", "xi", "psi"))
    b2, bound, a1, a2, b_w = map(symbol, ("b2", "psi_error", "alpha_1", "alpha_2", "b_w"))
    energy = adaptive_fuzzy.lyapunov_printed(s, gain, b2, bound, k_p, a1, a2)
    moves = {
        s: k_p * gain * (b_w + xi - (psi - bound)),
        b2: -2 * a1 * s * b_w,
        bound: -a2 * s,
        gain: gain_rate,
    }
    rate = sum(sp.diff(energy, x) * moved for x, moved in moves.items())
    return rate, adaptive_fuzzy.lyapunov_printed_rate_true(s, gain, gain_rate, xi, psi, b2, bound, a1, a2)


def repaired_energy(symbol: Symbols) -> tuple[Any, Any]:
    """Eq. (44) of the repaired V: its rate along the loop for s_D > 0, outside the layer, and the stated one."""
    import sympy as sp

    s, v, a, g, xi, psi = map(symbol, ("s_D", "v", "a", "g", "xi", "psi"))
    b2, bound, a1, a2, b_w = map(symbol, ("b2", "psi_error", "alpha_1", "alpha_2", "b_w"))
    energy = adaptive_fuzzy.lyapunov_repaired(s, v, g, b2, bound, a1, a2)
    moves = {s: g / v * (b_w + xi - (psi - bound)), v: -a, b2: -2 * a1 * s * b_w, bound: -a2 * s}
    rate = sum(sp.diff(energy, x) * moved for x, moved in moves.items())
    return rate, adaptive_fuzzy.lyapunov_repaired_rate(s, a, g, xi, psi)


IDENTITIES: tuple[tuple[str, str, Callable[[Symbols], tuple[Any, Any]]], ...] = (
    ("slip", "(19) slip' = F + G T from (1) to (3)", slip_equation),
    ("lag", "(14) tau T' + T = T_max u from (9), (12)", brake_lag),
    ("filling", "(10) exact with the supply of (8)", filling),
    ("error", "(39) e' + c e = G (u* - u)", error_dynamics),
    ("printed", "(44) V2' of the printed V2, with the terms of G' that the paper omits", printed_energy),
    ("repaired", "(44) V' of the repaired V", repaired_energy),
)


def identities(problem: Problem) -> tuple[Identity, ...]:  # noqa: ARG001 - they hold for all numbers
    """Execute the installed functions on symbols and return what is claimed about them."""
    import sympy as sp

    def symbol(name: str) -> Any:
        return sp.Symbol(name, positive=True)

    sides = ((key, text, *made(symbol)) for key, text, made in IDENTITIES)
    return tuple(Identity(key=key, text=text, left=left, right=right) for key, text, left, right in sides)


def _tell(problem: Problem, findings: Findings) -> Certificate:
    status = all_of(*findings.values())
    left_over = _left_over(problem, findings) if status is Status.REFUTED else ""
    return Certificate(
        claim="The functions that compute slip, brake, error and energy satisfy (19), (14), (10), (39) and (44) in "
        "its corrected and in its repaired form as identities.",
        status=status,
        explanation={
            Status.PROVED: f"All residuals are 0. {misprints()}",
            Status.REFUTED: f"{left_over}: a function of the model is wrong.",
            Status.UNDECIDED: "Nothing is stated about some of them.",
        }[status],
        hypotheses=tuple(hypothesis(text, findings[key]) for key, text, _ in IDENTITIES),
        assumptions=(
            "all symbols positive",
            "s > 0 for the printed (44); outside the boundary layer, s_D > 0, for the repaired one",
        ),
        method="the installed functions on SymPy symbols; both sides compared in a prime field, where two different "
        "functions would agree with a probability below 1e-60",
        reference="eqs. (1)-(3), (8)-(10), (14), (19), (39), (43), (44); docs/theory.md#slip-equation",
    )


def _left_over(problem: Problem, findings: Findings) -> str:
    """Say what is left of the identities that do not hold."""
    import sympy as sp

    wrong = [each for each in identities(problem) if findings[each.key].status is Status.REFUTED]
    return "; ".join(
        f"{each.text} leaves {sp.simplify(sp.nsimplify(each.left - each.right))}" for each in wrong
    )


def misprints() -> str:
    """List the equations that the paper prints otherwise, each with what SymPy finds left over."""
    listed = (
        f"{entry.number if entry.number[0].isalpha() else f'({entry.number})'}: {entry.residual}"
        for entry in load_equations()
        if "misprint" in entry.verdicts
    )
    return f"Printed otherwise in the paper, with what the printed form leaves over: {'; '.join(listed)}."


DERIVATION = Theorem(
    name="derivation",
    title="Equations of the model",
    claim="The functions of the model satisfy the equations of the paper in their corrected form.",
    speaks_about=every_law,
    obligations=identities,
    tell=_tell,
    assumes=frozenset(),
)
