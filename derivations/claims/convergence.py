"""Claims on the convergence, eqs. (45)-(48)."""

import sympy as sp

from derivations import adaptive_fuzzy, barbalat
from derivations.claim import Claim
from derivations.notation import symbols, time
from derivations.printing import Form, plain, typst

_BARBALAT = "test_equations_barbalat.py"
_B = barbalat
_STOP = "0 <= t < v0/a, v > 0"
_RATE = sp.Symbol("lyapunov2_rate")
_integral = sp.Integral(_B.gamma, (time, 0, time))
_sliding, _error = symbols("sliding_variable error")

CLAIMS = (
    Claim(
        number="45",
        title="Gamma bounded by -V2'",
        derivation=barbalat,
        test=f"{_BARBALAT}::test_gamma_exceeds_the_decrease",
        printed=Form(f"Γ = {plain(_B.gamma)} ≤ -V2'", f"Gamma = {typst(_B.gamma)} <= -dot(V)_2"),
        residual=_B.excess,
        gap=_B.violation_on_surface,
        assumption="Constant G.",
        domain=_STOP,
        sides=(sp.Symbol("gamma"), _B.gamma, _RATE),
        remark="Left over: Gamma + V2' at s = 0, positive while braking.",
    ),
    Claim(
        number="46",
        title="Integral of Gamma",
        derivation=barbalat,
        test=f"{_BARBALAT}::test_gamma_exceeds_the_decrease",
        printed=Form("∫Γ dt ≤ V2(0) - V2(t)", "integral_0^t Gamma dif tau <= V_2(0) - V_2(t)"),
        residual=_B.excess,
        gap=_B.violation_on_surface,
        corrected=Form(
            f"dV/dσ = {plain(_B.sigma_rate)}, σ = ∫dt/v", f"(dif V)/(dif sigma) = {typst(_B.sigma_rate)}"
        ),
        corrected_residual=_B.sigma_rate_residual,
        certainty=("proved",),
        assumption="Constant G, as in (45).",
        domain=_STOP,
        sides=(_integral, adaptive_fuzzy.lyapunov_printed),
        remark="In sigma-time, with adaptation rates alpha/v, the second form holds without it.",
    ),
    Claim(
        number="47",
        title="Limit of the integral",
        derivation=barbalat,
        test=f"{_BARBALAT}::test_stop_is_finite_in_time_and_infinite_in_sigma",
        printed=Form("lim ∫Γ dt ≤ ∞ for t → ∞", "lim_(t -> infinity) integral_0^t Gamma dif tau <= infinity"),
        corrected=Form("lim ∫Γ dt < ∞", "lim_(t -> infinity) integral_0^t Gamma dif tau < infinity"),
        residual=_B.integral_of_one,
        corrected_residual=_B.excess,
        gap=_B.stopping_time,
        certainty=("inferred", "scan"),
        assumption="An infinite horizon. Left over: the time at which the train stands.",
        domain="t -> infinity",
        sides=(_integral, sp.Integer(1)),
        remark="Prints <= for <: even Gamma = 1 satisfies the printed form. Residual: the limit for Gamma = 1.",
    ),
    Claim(
        number="48",
        title="Convergence by Barbalat's lemma",
        derivation=barbalat,
        test=f"{_BARBALAT}::test_hypotheses_of_the_lemma",
        printed=Form("lim Γ = lim s = 0 for t → ∞", "lim_(t -> infinity) Gamma = lim_(t -> infinity) s = 0"),
        residual=_B.filter_residual,
        gap=_B.gain_rate_at_standstill,
        assumption="Gamma uniformly continuous, psi > |xi| strictly, an infinite horizon: none is shown.",
        domain="t -> infinity",
        sides=(_sliding, _error),
        remark="Left over: G' at standstill. inf G > 0 does hold, G is least at the start. Gamma = 0 for psi = |xi|. "
        "The step from s -> 0 to e -> 0, not shown either, holds: e is s/K_P through the stable filter q/(q + c).",
    ),
)
