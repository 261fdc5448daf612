"""Claims on the slip dynamics and the sliding mode, eqs. (19)-(28)."""

import sympy as sp

from derivations import sliding_surface, slip_equation
from derivations.claim import TORQUE_IS_COMMAND, Claim
from derivations.notation import symbol
from derivations.printing import Form, form, plain, typst

_SLIP, _SLIDING = "test_equations_slip.py", "test_equations_sliding_surface.py"
_F, _S = slip_equation, sliding_surface
_e, _c, _s = symbol("error"), _S.K_I / _S.K_P, symbol("sliding_variable")
_DOMAIN = "v > 0, omega >= 0, slip 0 to 1"
_READS_E = "Prints lambda for e"

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
        domain=_DOMAIN,
        sides=(sp.Symbol("slip_rate"), _F.slip_rate_printed, _F.drift + _F.slip_gain * _F.T),
        remark="Correct as printed. Second form: slip instead of wheel speed, F and G separated. G > 0 always. "
        "F(λ, t) hides v: the equation is scalar only along a given v(t).",
    ),
    Claim(
        number="20",
        title="Uncertainty",
        derivation=slip_equation,
        test=f"{_SLIP}::test_uncertainty_contains_the_gain",
        printed=Form("λ' = F + G*T + δ, |δ| ≤ W", "dot(lambda) = F + G T + delta, quad abs(delta) <= W"),
        corrected=Form("|δ| ≤ W0/v", "abs(delta) <= W_0 / v"),
        corrected_residual=sp.diff(_F.uncertainty_times_speed, _F.v),
        gap=_F.circular_residual,
        certainty=("inferred",),
        assumption="q = |ΔG|/G < 1: delta contains Delta G T and T contains W, so that W >= D + q W, D = |ΔF| + q G "
        "|u_eq|; and v >= v_low > 0, because Delta G T grows as 1/v.",
        domain="v >= v_low > 0, slip 0 to 1",
        sides=(
            sp.Symbol("slip_rate"),
            symbol("drift"),
            symbol("gain") * symbol("torque"),
            symbol("uncertainty"),
            symbol("uncertainty_bound"),
        ),
        remark="That delta is bounded is stated, that its bound is circular is not. Delta G T times v is constant in "
        "v, so that W = W0/v serves it; for Delta F it has to be shown on the domain.",
    ),
    Claim(
        number="21",
        title="Slip error",
        derivation=sliding_surface,
        functions=("sliding_surface.slip_error",),
        test=f"{_SLIDING}::test_surface",
        printed=form("error", _S.slip_error),
        domain="v > 0",
    ),
    Claim(
        number="22",
        title="Sliding surface",
        derivation=sliding_surface,
        functions=("sliding_surface.sliding_variable",),
        test=f"{_SLIDING}::test_surface",
        printed=form("sliding_variable", _S.sliding_variable),
        corrected_residual=_S.sliding_pole + _c,
        domain="v > 0, K_P, K_I > 0",
        remark="E is the integral of e. On the surface e decays at K_I/K_P, 0.306 1/s as printed.",
    ),
    Claim(
        number="23",
        title="Equivalent and robust control",
        derivation=sliding_surface,
        functions=("sliding_surface.equivalent_torque", "sliding_surface.lag_characteristic"),
        test=f"{_SLIDING}::test_equivalent_control_keeps_the_surface",
        printed=Form(
            f"u_eq = {plain(_S.equivalent_printed)}, u_ht = {plain(_S.robust_form)}",
            f'u_"eq" = {typst(_S.equivalent_printed)}, quad u_"ht" = (W op("sat")(s\\/Phi))/(G)',
        ),
        corrected=form("u_eq", _S.equivalent_corrected),
        residual=_S.printed_contradiction,
        corrected_residual=_S.equivalent_residual_corrected,
        certainty=("proved", "scan"),
        domain=_DOMAIN,
        sides=(sp.Symbol("u_eq"), _S.equivalent_printed, _S.equivalent_corrected, _S.robust_size),
        remark=f"{_READS_E} and for lambda_d. Residual: what the printed law demands to be zero when inserted into "
        "(19). With a valve lag the loop inside the layer is the cubic tau q^3 + (1 - p tau) q^2 + (c + k) q + k c, "
        "p = dF/dλ at fixed speed, k = W K_P/Phi, c = K_I/K_P.",
    ),
    Claim(
        number="24",
        title="Lyapunov function of the surface",
        derivation=sliding_surface,
        functions=("sliding_surface.lyapunov_surface",),
        test=f"{_SLIDING}::test_surface",
        printed=form("lyapunov", _S.lyapunov),
        sides=(_S.lyapunov, sp.Integer(1)),
        domain="any s",
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
        gap=_S.torque_rate_of_surface,
        certainty=("proved", "scan"),
        assumption=TORQUE_IS_COMMAND,
        domain=f"{_DOMAIN}, |s| > Phi",
        remark=f"{_READS_E}; the conclusion -K_P (W - |delta|) |s| is right, and only <= 0 where |delta| = W: take "
        "W >= |delta| + eta. Inside the layer |e| <= 2 Phi/K_P after the transient of rate c.",
    ),
    Claim(
        number="26",
        title="Duty of the valves",
        derivation=sliding_surface,
        test=f"{_SLIDING}::test_unit_of_the_printed_gains",
        printed=Form("dc = u/T_max", 'd c = u / T_"max"'),
        gap=_S.torque_residual,
        assumption=f"{TORQUE_IS_COMMAND}. Left over with the lag of (15): T - u.",
        domain="0 <= u <= T_max",
        sides=(sp.Symbol("duty_cycle"), sp.Symbol("u") / symbol("max_torque")),
        unknown=("u",),
        remark="u is a torque, and the printed gains make it one in kN m, or a duty: in N m the largest u that they "
        f"allow stops the ER24PC after {_S.distance_in_newton_metres:.0f} m at the earliest, without running "
        f"resistance; Table 10 has {_S.printed_distance} m.",
    ),
    Claim(
        number="27",
        title="Ideal control",
        derivation=sliding_surface,
        test=f"{_SLIDING}::test_ideal_control_is_bounded_at_standstill",
        printed=form("u_ideal", _S.equivalent_derived),
        residual=_S.ideal_residual,
        domain=_DOMAIN,
        remark="Bounded as v -> 0 at a fixed slip, although F and G are not.",
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
        gap=_S.ideal_torque_residual,
        certainty=("proved", "scan"),
        assumption=f"{TORQUE_IS_COMMAND}, with u = u* of (27).",
        domain=_DOMAIN,
        remark="Prints lambda' for e'.",
    ),
)
