"""Claims on the convergence, eqs. (45)-(48)."""

from derivations import barbalat
from derivations.equation_map import Claim
from derivations.printing import Form, plain, typst

_BARBALAT = "test_equations_barbalat.py"
_B = barbalat

CLAIMS = (
    Claim(
        number="45",
        title="Gamma bounded by -V2'",
        derivation=barbalat,
        test=f"{_BARBALAT}::test_gamma_exceeds_the_decrease",
        printed=Form(f"Γ = {plain(_B.gamma)} ≤ -V2'", f"Gamma = {typst(_B.gamma)} <= -dot(V)_2"),
        residual=_B.violation_on_surface,
        corrected_residual=_B.excess,
        assumption="Constant G.",
        remark="Residual: Gamma + V2' at s = 0, positive while braking.",
    ),
    Claim(
        number="46",
        title="Integral of Gamma",
        derivation=barbalat,
        test=f"{_BARBALAT}::test_gamma_exceeds_the_decrease",
        printed=Form("∫Γ dt ≤ V2(0) - V2(t)", "integral_0^t Gamma dif tau <= V_2(0) - V_2(t)"),
        residual=_B.violation_on_surface,
        corrected=Form(
            f"dV/dσ = {plain(_B.sigma_rate)}, σ = ∫dt/v", f"(dif V)/(dif sigma) = {typst(_B.sigma_rate)}"
        ),
        corrected_residual=_B.sigma_rate_residual,
        assumption="Rests on (45). In sigma-time, with adaptation rates alpha/v, the like of it holds.",
    ),
    Claim(
        number="47",
        title="Limit of the integral",
        derivation=barbalat,
        test=f"{_BARBALAT}::test_stop_is_finite_in_time_and_infinite_in_sigma",
        printed=Form("lim ∫Γ dt ≤ ∞ for t → ∞", "lim_(t -> infinity) integral_0^t Gamma dif tau <= infinity"),
        corrected=Form("lim ∫Γ dt < ∞", "lim_(t -> infinity) integral_0^t Gamma dif tau < infinity"),
        residual=_B.integral_of_one,
        assumption="An infinite horizon, and < in place of <=: even Gamma = 1 satisfies the printed form.",
        remark=f"Residual: the limit for Gamma = 1. The train stops at t = {plain(_B.stopping_time)}.",
    ),
    Claim(
        number="48",
        title="Convergence by Barbalat's lemma",
        derivation=barbalat,
        test=f"{_BARBALAT}::test_hypotheses_of_the_lemma",
        printed=Form("lim Γ = lim s = 0 for t → ∞", "lim_(t -> infinity) Gamma = lim_(t -> infinity) s = 0"),
        residual=_B.gain_rate_at_standstill,
        assumption="Gamma uniformly continuous, psi > |xi| strictly, an infinite horizon: none is shown.",
        remark="Residual: G' at standstill. inf G > 0 does hold, G is least at the start. Gamma = 0 for "
        "psi = |xi|.",
    ),
)
