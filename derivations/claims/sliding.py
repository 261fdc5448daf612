"""Claims on the slip dynamics and the sliding mode, eqs. (19)-(28)."""

import sympy as sp

from derivations import sliding_surface, slip_equation
from derivations.equation_map import Claim
from derivations.notation import symbol
from derivations.printing import Form, form, plain, typst

_SLIP, _SLIDING = "test_equations_slip.py", "test_equations_sliding_surface.py"
_F, _S = slip_equation, sliding_surface
_e, _c, _s = symbol("error"), _S.K_I / _S.K_P, symbol("sliding_variable")

CLAIMS = (
    Claim(
        number="19",
        title="Slip dynamics",
        derivation=slip_equation,
        functions=("slip.slip_drift", "slip.slip_gain", "slip.slip_drift_slip_derivative"),
        test=f"{_SLIP}::test_slip_dynamics_follow_from_the_laws_of_motion",
        printed=form("slip_rate", _F.slip_rate_printed),
        corrected=Form(
            f"λ' = F + G*T, F = {plain(_F.drift)}, G = {plain(_F.slip_gain)}",
            f"dot(lambda) = underbrace({typst(_F.drift)}, F(lambda, v, t)) "
            f"+ underbrace({typst(_F.slip_gain)}, G(v)) T",
        ),
        residual=_F.slip_rate_residual,
        corrected_residual=_F.drift_residual,
        remark="Correct as printed. Second form: slip instead of wheel speed, F and G separated. G > 0 "
        "always.",
    ),
    Claim(
        number="20",
        title="Uncertainty",
        derivation=slip_equation,
        test=f"{_SLIP}::test_uncertainty_contains_the_gain",
        printed=Form("λ' = F + G*T + δ, |δ| ≤ W", "dot(lambda) = F + G T + delta, quad abs(delta) <= W"),
        corrected=Form("|δ| ≤ W0/v", "abs(delta) <= W_0 / v"),
        residual=_F.gain_uncertainty * _F.T,
        corrected_residual=sp.diff(_F.uncertainty_times_speed, _F.v),
        assumption="W falls with speed: delta contains Delta G T, which grows as 1/v down to standstill.",
        remark="Residual: Delta G T for an inertia ratio rho. Times v it is constant in v, so W = W0/v "
        "serves.",
    ),
    Claim(
        number="21",
        title="Slip error",
        derivation=sliding_surface,
        functions=("sliding_surface.slip_error",),
        test=f"{_SLIDING}::test_surface",
        printed=form("error", _S.slip_error),
    ),
    Claim(
        number="22",
        title="Sliding surface",
        derivation=sliding_surface,
        functions=("sliding_surface.sliding_variable",),
        test=f"{_SLIDING}::test_surface",
        printed=form("sliding_variable", _S.sliding_variable),
        corrected_residual=_S.sliding_pole + _c,
        remark="E is the integral of e. On the surface e decays at K_I/K_P, 0.306 1/s as printed.",
    ),
    Claim(
        number="23",
        title="Equivalent and robust control",
        derivation=sliding_surface,
        functions=("sliding_surface.equivalent_torque", "sliding_surface.lag_characteristic"),
        test=f"{_SLIDING}::test_equivalent_control_keeps_the_surface",
        printed=form("u_eq", _S.equivalent_printed),
        corrected=form("u_eq", _S.equivalent_corrected),
        residual=_S.printed_contradiction,
        corrected_residual=_S.equivalent_residual_corrected,
        remark="Residual: what the printed law demands to be zero when inserted into (19). With a valve "
        "lag the "
        "loop inside the layer is the cubic tau q^3 + (1 - p tau) q^2 + (c + k) q + k c.",
    ),
    Claim(
        number="24",
        title="Lyapunov function of the surface",
        derivation=sliding_surface,
        functions=("sliding_surface.lyapunov_surface",),
        test=f"{_SLIDING}::test_surface",
        printed=form("lyapunov", _S.lyapunov),
    ),
    Claim(
        number="25",
        title="Reaching condition",
        derivation=sliding_surface,
        test=f"{_SLIDING}::test_reaching_condition",
        printed=form("lyapunov_rate", _S.first_line_printed),
        corrected=form("lyapunov_rate", _s * (_S.K_P * sp.Symbol("error_rate") + _S.K_I * _e)),
        residual=_S.first_line_residual,
        corrected_residual=_S.lyapunov_rate_residual,
        remark="Prints lambda for e; the conclusion -K_P (W - |delta|) |s| is right, and only <= 0 where "
        "|delta| = W: take W >= |delta| + eta. Inside the layer |e| <= 2 Phi/K_P.",
    ),
    Claim(
        number="26",
        title="Duty of the valves",
        derivation=sliding_surface,
        test=f"{_SLIDING}::test_unit_of_the_printed_gains",
        printed=Form("dc = u/T_max", 'd c = u / T_"max"'),
        residual=1 - _S.duty_of_printed_gains,
        assumption="u cannot be in N m: the printed gains fit kN m or a duty.",
        remark=f"The printed law starts with |u| <= 2, a duty of {plain(_S.duty_of_printed_gains)} if "
        "that were "
        "N m; residual: what it lacks to full braking.",
    ),
    Claim(
        number="27",
        title="Ideal control",
        derivation=sliding_surface,
        test=f"{_SLIDING}::test_ideal_control_is_bounded_at_standstill",
        printed=form("u_ideal", _S.equivalent_derived),
        residual=_S.ideal_residual,
        remark="Bounded as v -> 0, although F and G are not.",
    ),
    Claim(
        number="28",
        title="Error on the surface",
        derivation=sliding_surface,
        test=f"{_SLIDING}::test_equivalent_control_keeps_the_surface",
        printed=form(sp.Symbol("slip_rate") + _c * _e, sp.Integer(0)),
        corrected=form(sp.Symbol("error_rate") + _c * _e, sp.Integer(0)),
        residual=_S.ideal_residual_printed,
        corrected_residual=_S.ideal_residual,
        remark="Prints lambda' for e'.",
    ),
)
