"""Claims on the adaptive fuzzy law, eqs. (29)-(44)."""

import sympy as sp

from derivations import adaptive_fuzzy
from derivations.equation_map import Claim
from derivations.printing import Form, form, plain

_FUZZY = "test_equations_adaptive_fuzzy.py"
_A = adaptive_fuzzy
_MU = sp.Symbol("mu_A")
_c = _A.K_I / _A.K_P
_rate_true = _A.rate_claimed + _A.rate_omitted


def _definition(number: str, title: str, plain_form: str, typst_form: str, remark: str = "") -> Claim:
    """State a definition that SymPy has nothing to compute about."""
    return Claim(
        number=number,
        title=title,
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_fuzzy_basis",
        printed=Form(plain_form, typst_form),
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
    ),
    _definition(
        "30",
        "Output of the fuzzy system",
        "u_fuz = Σ b_r μ_A / Σ μ_A",
        'u_"fuz" = (sum b^r mu_(A^r))/(sum mu_(A^r))',
    ),
    Claim(
        number="31",
        title="Fuzzy basis functions",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_fuzzy_basis",
        printed=Form("w_r = μ_A / Σ μ_A", "w^r = mu_(A^r) / (sum mu_(A^r))"),
        corrected_residual=_A.partition_residual,
        remark="The basis functions sum to 1.",
    ),
    Claim(
        number="32",
        title="Output as a scalar product",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_fuzzy_basis",
        printed=Form("u_fuz = b'w", 'u_"fuz" = b^top w'),
        residual=_A.output_residual,
    ),
    Claim(
        number="33",
        title="Approximation of the ideal control",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_ideal_control_depends_on_speed",
        printed=Form("u* = b'w(s) + ξ", "u^* = b^top w(s) + xi"),
        residual=_A.ideal_speed_dependence,
        assumption="u* depends on slip, speed and time, the fuzzy system on s only: xi need not be small.",
        remark="Residual: du*/dv at fixed slip, creep force and error.",
    ),
    Claim(
        number="34",
        title="Bound of the approximation error",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_ideal_control_depends_on_speed",
        printed=Form("|ξ| ≤ ψ", "abs(xi) <= psi"),
        corrected=Form("ψ = sup |u* - b*'w| + η, any constant b*", "psi = sup abs(u^* - b^(*top) w) + eta"),
        residual=_A.ideal_speed_dependence,
        assumption="psi has to be a bound over all speeds and times; with a margin eta for convergence.",
    ),
    _definition("35", "Estimated fuzzy control", "u_fuz = b^'w", 'hat(u)_"fuz" = hat(b)^top w'),
    _definition("36", "Control", "u = b^'w + u_r", "u = hat(b)^top w + u_r"),
    Claim(
        number="37",
        title="Compensating control",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_saturation_is_a_relay",
        printed=Form(
            "u_r = ψ^ sgn(s) sgn(G), with sat(s) for sgn(s)", 'u_r = hat(psi) op("sgn")(s) op("sgn")(G)'
        ),
        corrected=Form("u_r = ψ^ sat(s/Φ)", 'u_r = hat(psi) op("sat")(s / Phi)'),
        residual=_A.layer_excess,
        corrected_residual=_A.layer_excess.subs(_A.s, 1),
        assumption="sgn(s) in the proof, sat(s) in the controller: equal only for |s| >= 1.",
        remark="Residual: what sat(s) adds to V2' inside the layer. The layer is 1 in s, "
        f"{plain(_A.layer_in_slip)} in slip with K_P = 1800: a relay.",
    ),
    Claim(
        number="38",
        title="Closed loop",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_error_dynamics",
        printed=Form("λ' = F + G*(b^'w + u_r)", "dot(lambda) = F + G (hat(b)^top w + u_r)"),
        residual=_A.error_dynamics_residual,
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
        remark="Prints lambda' for e'. Both sides are s'/K_P.",
    ),
    _definition(
        "40",
        "Errors of the estimates",
        "b~ = b - b^, ψ~ = ψ - ψ^, u~ = u* - u_fuz = b~'w + ξ",
        'tilde(b) = b - hat(b), quad tilde(psi) = psi - hat(psi), quad tilde(u)_"fuz" = tilde(b)^top w + xi',
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
        remark="Read literally in the text at hand: b^' = -b^' leaves only b^' = 0.",
    ),
    Claim(
        number="42",
        title="Adaptation of the bound",
        derivation=adaptive_fuzzy,
        test=f"{_FUZZY}::test_bound_estimate_never_falls",
        printed=form("psi_hat_rate", _A.bound_rate_printed),
        corrected=form("psi_hat_rate", _A.bound_rate_corrected),
        residual=_A.bound_rate_residual,
        corrected_residual=_A.bound_rate_printed.subs(_A.sgn_G, 1) - _A.bound_rate_corrected,
        assumption="G > 0, which holds: for G < 0 the estimate would fall.",
        remark="Monotone: the estimate drifts up without leakage or projection. Residual: at sgn(G) = -1.",
    ),
    Claim(
        number="43",
        title="Lyapunov function V2",
        derivation=adaptive_fuzzy,
        functions=("adaptive_fuzzy.lyapunov_printed", "adaptive_fuzzy.lyapunov_repaired"),
        test=f"{_FUZZY}::test_printed_v2_rises_and_repaired_v_falls",
        printed=form("lyapunov2", _A.lyapunov_printed),
        corrected=form("lyapunov", _A.lyapunov_repaired),
        residual=_A.omitted,
        corrected_residual=_A.repaired_rate_residual,
        assumption="Constant G; G = R/(2 I v) grows as the train slows down.",
        remark="Residual: the terms of G' that make V2 rise. The repaired V is V2/G with a dead zone.",
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
        printed=form("lyapunov2_rate", _A.rate_claimed),
        corrected=form("lyapunov2_rate", _rate_true),
        residual=_A.omitted,
        corrected_residual=sp.simplify(_A.rate_true - _rate_true),
        assumption="Constant G: the terms in G' = G a/v > 0 are omitted.",
        remark="The last printed line also lacks the brackets of |s| G (psi - |xi|).",
    ),
)
