"""Claims on the adaptive fuzzy law, eqs. (29)-(44)."""

import sympy as sp

from derivations import adaptive_fuzzy
from derivations.claim import TORQUE_IS_COMMAND, Claim
from derivations.notation import symbol
from derivations.printing import Form, form, plain

_FUZZY = "test_equations_adaptive_fuzzy.py"
_A = adaptive_fuzzy
_MU, _W, _B, _U = (sp.Symbol(name) for name in ("mu_A", "basis", "weight", "u"))
_c = _A.K_I / _A.K_P
_rate_true = _A.rate_claimed + _A.rate_omitted
_CONSTANT = "constant b and psi"


def _definition(
    number: str,
    title: str,
    plain_form: str,
    typst_form: str,
    sides: tuple[sp.Expr, ...],
    domain: str = "any s",
    remark: str = "",
) -> Claim:
    """State a definition that SymPy has nothing but units to compute about."""
    return Claim(
        number=number,
        title=title,
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_fuzzy_basis",
        printed=Form(plain_form, typst_form),
        domain=domain,
        sides=sides,
        remark=remark,
    )


CLAIMS = (
    Claim(
        number="29",
        title="Membership function",
        derivation=adaptive_fuzzy,
        functions=("adaptive_fuzzy.membership",),
        test=f"{_FUZZY}::test_fuzzy_basis",
        printed=form(_MU, _A.membership),
        domain="any s, width > 0",
    ),
    _definition(
        "30",
        "Output of the fuzzy system",
        "u_fuz = Σ b_r μ_A / Σ μ_A",
        'u_"fuz" = (sum b^r mu_(A^r))/(sum mu_(A^r))',
        (_U, _B * _MU / _MU),
    ),
    Claim(
        number="31",
        title="Fuzzy basis functions",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_fuzzy_basis",
        printed=Form("w_r = μ_A / Σ μ_A", "w^r = mu_(A^r) / (sum mu_(A^r))"),
        corrected_residual=_A.partition_residual,
        domain="any s",
        sides=(_W, _MU / _A.mu_sum),
        remark="The basis functions sum to 1.",
    ),
    Claim(
        number="32",
        title="Output as a scalar product",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_fuzzy_basis",
        printed=Form("u_fuz = bᵀw", 'u_"fuz" = b^top w'),
        residual=_A.output_residual,
        domain="any s",
        sides=(_U, _B * _W),
    ),
    Claim(
        number="33",
        title="Approximation of the ideal control",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_ideal_control_depends_on_speed",
        printed=Form("u* = bᵀw(s) + ξ", "u^* = b^top w(s) + xi"),
        gap=_A.ideal_speed_dependence,
        assumption=f"{_CONSTANT}, any ones: (41), (42) need them; xi then carries all that u* depends on besides s.",
        domain="v > 0, omega >= 0, slip 0 to 1",
        sides=(sp.Symbol("u_ideal"), _B * _W, symbol("approximation_error")),
        remark="u* depends on slip, speed and time, the fuzzy system on s only: xi need not be small. Left over: "
        "du*/dv at fixed slip and error, with the friction and the resistance moving with the speed.",
    ),
    Claim(
        number="34",
        title="Bound of the approximation error",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_ideal_control_depends_on_speed",
        printed=Form("|ξ| ≤ ψ", "abs(xi) <= psi"),
        corrected=Form("ψ = sup |u* - b*ᵀw| + η, any constant b*", "psi = sup abs(u^* - b^(*top) w) + eta"),
        residual=_A.ideal_singular_part,
        certainty=("inferred",),
        domain="slip 0 to 1, 0 < v <= v0",
        sides=(symbol("approximation_error"), symbol("bound")),
        remark="Presumed in the paper, and true: u* has no negative power of v, so that it is bounded with f and f_d "
        "(residual: the part that has). The second form has the margin eta that convergence needs.",
    ),
    _definition(
        "35", "Estimated fuzzy control", "u_fuz = b^ᵀw", 'hat(u)_"fuz" = hat(b)^top w', (_U, _B * _W)
    ),
    _definition(
        "36",
        "Control",
        "u = b^ᵀw + u_r",
        "u = hat(b)^top w + u_r",
        (_U, _B * _W, symbol("bound_estimate")),
    ),
    Claim(
        number="37",
        title="Compensating control",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_saturation_is_a_relay",
        printed=Form(
            "u_r = ψ^ sgn(s) sgn(G), with sat(s) for sgn(s)", 'u_r = hat(psi) op("sgn")(s) op("sgn")(G)'
        ),
        corrected=Form("u_r = ψ^ sat(s/Φ)", 'u_r = hat(psi) op("sat")(s / Phi)'),
        residual=_A.layer_excess_at_edge,
        corrected_residual=_A.sign_of_gain - 1,
        gap=_A.layer_excess,
        certainty=("inferred",),
        assumption="|s| >= 1, where sat(s) = sgn(s): the proof has sgn(s), the controller sat(s).",
        domain="any s, either sign",
        sides=(_U, symbol("bound_estimate")),
        remark="Left over: what sat(s) adds to V2' inside the layer. The layer is 1 in s, "
        f"{plain(_A.layer_in_slip)} in slip with K_P = 1800: a relay. The second form leaves sgn(G) out, which is "
        "1 by (19).",
    ),
    Claim(
        number="38",
        title="Closed loop",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_error_dynamics",
        printed=Form("λ' = F + G*(b^ᵀw + u_r)", "dot(lambda) = F + G (hat(b)^top w + u_r)"),
        residual=_A.error_dynamics_residual,
        gap=_A.torque_residual_of_slip,
        assumption=TORQUE_IS_COMMAND,
        domain="v > 0, omega >= 0, slip 0 to 1",
        sides=(
            sp.Symbol("slip_rate"),
            symbol("drift"),
            symbol("gain") * (_B * _W + symbol("bound_estimate")),
        ),
        remark="The largest silent assumption of the paper enters here: (19) has T_brake, (36) makes u.",
    ),
    Claim(
        number="39",
        title="Error dynamics",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_error_dynamics",
        printed=form(_A.error_dynamics_left_printed, _A.G * (_A.u_ideal - _A.u)),
        corrected=form(sp.Symbol("error_rate") + _c * _A.e, _A.G * (_A.u_ideal - _A.u)),
        residual=_A.error_dynamics_residual_printed,
        corrected_residual=_A.error_dynamics_residual,
        gap=_A.torque_residual,
        certainty=("proved", "scan"),
        assumption=TORQUE_IS_COMMAND,
        domain="v > 0, omega >= 0, slip 0 to 1",
        remark="Prints lambda' for e'. Both sides are s'/K_P.",
    ),
    _definition(
        "40",
        "Errors of the estimates",
        "b~ = b - b^, ψ~ = ψ - ψ^, u~ = u* - u_fuz = b~ᵀw + ξ",
        'tilde(b) = b - hat(b), quad tilde(psi) = psi - hat(psi), quad tilde(u)_"fuz" = tilde(b)^top w + xi',
        (sp.Symbol("u_ideal"), _U, sp.Symbol("b_error_times_w"), symbol("approximation_error")),
        domain=_CONSTANT,
    ),
    Claim(
        number="41",
        title="Adaptation of the weights",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_printed_adaptation_is_zero",
        printed=Form("b^' = -b^' = α1*s*w", "dot(hat(b)) = -dot(hat(b)) = alpha_1 s w"),
        corrected=Form("b^' = -b~' = α1*s*w", "dot(hat(b)) = -dot(tilde(b)) = alpha_1 s w"),
        residual=_A.adaptation_residual,
        corrected_residual=_A.frozen_gain_residual,
        certainty=("proved", "scan"),
        domain="constant b, G > 0",
        sides=(sp.Symbol("b_hat_rate"), _A.alpha1 * _A.s * _W),
        unknown=("weight_rate",),
        remark="Read literally in the text at hand: b^' = -b^' leaves only b^' = 0. For G < 0 it would lack "
        "sgn(G). With a valve lag this adaptation makes the loop the quartic of adaptive_loop.py; the Routh "
        "argument about a cubic is for frozen b^ and ψ^.",
    ),
    Claim(
        number="42",
        title="Adaptation of the bound",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_bound_estimate_never_falls",
        printed=form("psi_hat_rate", _A.bound_rate_printed),
        corrected=form("psi_hat_rate", _A.bound_rate),
        residual=_A.bound_rate_residual,
        corrected_residual=_A.bound_rate_residual,
        certainty=("proved",),
        domain="constant psi, G > 0",
        unknown=("bound_rate",),
        remark="sgn(G) = 1 by (19); for G < 0 (43) would not be positive definite. Monotone: the estimate drifts up "
        "without leakage or projection.",
    ),
    Claim(
        number="43",
        title="Lyapunov function V2",
        derivation=adaptive_fuzzy,
        functions=("adaptive_fuzzy.lyapunov_printed", "adaptive_fuzzy.lyapunov_repaired"),
        test=f"{_FUZZY}::test_printed_v2_rises_and_repaired_v_falls",
        printed=form("lyapunov2", _A.lyapunov_printed),
        corrected=form("lyapunov", _A.lyapunov_repaired),
        residual=_A.frozen_gain_residual,
        corrected_residual=sp.Abs(_A.repaired_rate_residual) + sp.Abs(_A.repaired_scale_residual),
        gap=_A.omitted,
        certainty=("proved",),
        assumption="Constant G; G = R/(2 I v) grows as the train slows down.",
        domain="v > 0, G > 0",
        unknown=("weight_rate", "bound_rate"),
        remark="Left over: the terms of G' that make V2 rise. The repaired V is V2/(G K_P) with the rates divided by "
        "K_P, and with a dead zone.",
    ),
    Claim(
        number="44",
        title="Rate of V2",
        derivation=adaptive_fuzzy,
        functions=(
            "adaptive_fuzzy.lyapunov_printed_rate_claimed",
            "adaptive_fuzzy.lyapunov_printed_rate_true",
            "adaptive_fuzzy.lyapunov_repaired_rate",
        ),
        test=f"{_FUZZY}::test_true_rate_of_v2_along_a_trajectory",
        printed=Form(
            f"V2' = {plain(_A.rate_claimed)} ≤ {plain(_A.last_line_printed)}",
            "dot(V)_2 = G s xi - psi G abs(s) <= -psi G abs(s) - abs(xi)",
        ),
        corrected=form("lyapunov2_rate", _rate_true),
        residual=_A.last_line_residual,
        corrected_residual=sp.simplify(_A.rate_true - _rate_true),
        gap=_A.omitted,
        certainty=("proved", "scan"),
        assumption=f"Constant G: the terms in G' = G a/v > 0 are omitted; {TORQUE_IS_COMMAND}; {_CONSTANT}.",
        domain="v > 0, omega >= 0, slip 0 to 1",
        sides=(sp.Symbol("lyapunov2_rate"), _A.rate_claimed, _A.last_line_printed),
        remark="The last printed line lacks the brackets of |s| G (psi - |xi|): units prove it.",
    ),
)
