"""Claims on the brake actuator and the published controllers, eqs. (8)-(18), Tables 2 to 5 and the duties."""

import sympy as sp

from derivations import baselines, brake_actuator
from derivations.claim import FULL_SUPPLY, Claim
from derivations.notation import symbol, symbols
from derivations.printing import Form, form, plain, typst

_BRAKE, _BASELINES = "test_equations_brake.py", "test_equations_baselines.py"
_B = brake_actuator
_v, _omega, _R = symbols("speed wheel_speed wheel_radius")
_lag = symbol("time_constant") * sp.Symbol("torque_rate") + symbol("torque")
_limits = ", ".join(f"Δσ{n} = {plain(limit)}" for n, limit in enumerate(baselines.limits_below, start=1))
_slide_rate, _deceleration = sp.Symbol("slide_rate"), symbol("deceleration")

CLAIMS = (
    Claim(
        number="8",
        title="Supply pressure",
        derivation=brake_actuator,
        functions=("brake.supply_pressure",),
        test=f"{_BRAKE}::test_supply_is_a_first_order_lag",
        printed=form("supply_pressure", _B.supply),
        residual=_B.supply_residual,
        domain="t >= 0 since the brake was applied",
        remark="The paper's rate r is 0.75 1/s.",
    ),
    Claim(
        number="9",
        title="Cylinder pressure",
        derivation=brake_actuator,
        functions=("brake.cylinder_pressure_rate",),
        test=f"{_BRAKE}::test_valve_states_of_table_2",
        printed=form("pressure_rate", _B.pressure_rate_printed),
        corrected_residual=_B.pressure_rate_residual,
        domain="0 <= P_c <= P_cin; commands 0 or 1",
        remark="u_EV = 0, u_BV = 1 holds the pressure, as Table 2 says.",
    ),
    Claim(
        number="Table 2",
        title="States of the valves",
        derivation=brake_actuator,
        test=f"{_BRAKE}::test_valve_states_of_table_2",
        printed=Form("(u_EV, u_BV) = (1, 1) reduces, (0, 1) holds, (0, 0) increases"),
        residual=sp.Abs(_B.pressure_rate_on_hold)
        + sp.Abs(sp.simplify(_B.pressure_rate_on_reduction + _B.P / _B.T_V))
        + sp.Abs(sp.simplify(_B.pressure_rate_on_increase - (_B.P_in - _B.P) / _B.T_F)),
        domain="0 <= P_c <= P_cin",
        sides=(sp.Symbol("u_EV"), sp.Symbol("u_BV")),
        remark="Agrees with (9). The printed index RV stands for BV.",
    ),
    Claim(
        number="10",
        title="Filling",
        derivation=brake_actuator,
        functions=("brake.filled_pressure",),
        test=f"{_BRAKE}::test_exact_filling_law_solves_the_valve_equation",
        printed=form("pressure", _B.filled_printed),
        corrected=form("pressure", _B.filled),
        residual=_B.filled_residual_constant_supply,
        corrected_residual=_B.filled_residual,
        gap=_B.filled_residual_printed,
        certainty=("proved",),
        assumption="Constant supply pressure P_cin.",
        domain="t >= t_0, r T_F != 1 for the second form",
        remark="With (8) the exact law, the second form, has a second exponential.",
    ),
    Claim(
        number="11",
        title="Venting",
        derivation=brake_actuator,
        functions=("brake.vented_pressure",),
        test=f"{_BRAKE}::test_venting",
        printed=form("pressure", _B.vented),
        residual=_B.vented_residual,
        domain="t >= t_0",
    ),
    Claim(
        number="12",
        title="Braking torque of the cylinder",
        derivation=brake_actuator,
        functions=("brake.braking_torque",),
        test=f"{_BRAKE}::test_torque_is_proportional_to_pressure",
        printed=form("braking_torque", _B.K * sp.Symbol("mu_brake") * _B.P),
        corrected=form("braking_torque", _B.torque_of_pressure),
        domain="P_c >= 0, v_rel > 0",
        remark="The radius r_b of the pads is printed R, beside R_W of the wheel. Second form: constant pad "
        "friction, as the model uses it.",
    ),
    Claim(
        number="13",
        title="Rate of the braking torque",
        derivation=brake_actuator,
        test=f"{_BRAKE}::test_product_rule_term",
        printed=form("torque_rate", _B.torque_rate_printed_13),
        corrected=form("torque_rate", _B.torque_rate_derived),
        residual=_B.bracket_residual,
        corrected_residual=sp.simplify(
            _B.torque_rate_derived - (_B.torque_rate_printed_13 - _B.product_rule_residual)
        ),
        gap=_B.product_rule_residual,
        certainty=("proved",),
        assumption="Constant pad friction mu_brake: the product-rule term in its derivative is dropped.",
        domain="P_c >= 0, v_rel > 0, u_EV = u_BV",
        remark="K_b is not defined in the text; by (12) it is 2 A_eff E_b eta_b.",
    ),
    Claim(
        number="14",
        title="Brake as a first-order lag",
        derivation=brake_actuator,
        functions=("brake.torque_rate",),
        test=f"{_BRAKE}::test_lag_under_full_supply",
        printed=form(_lag, _B.lag_right_side_printed),
        corrected=form(_lag, _B.lag_right_side),
        residual=_B.lag_residual,
        corrected_residual=sp.simplify(_B.tau * _B.torque_rate + _B.T - _B.lag_right_side),
        gap=_B.supply_residual_of_lag,
        certainty=("proved", "scan"),
        assumption=f"{FULL_SUPPLY}: by (8) it is {100 * float(_B.supply_share):.0f} % of that at "
        f"{1 / 0.75:.2f} s.",
        domain="0 <= T <= T_max, T_F = T_V = tau",
        remark="Units prove the misprint. For T_F != T_V the brake is bilinear in T and u.",
    ),
    Claim(
        number="15",
        title="Average over the pulse width modulation",
        derivation=brake_actuator,
        functions=("brake.torque_ripple",),
        test=f"{_BRAKE}::test_average_of_a_simulated_pulse_train",
        printed=form(_lag, _B.T_max * sp.Symbol("duty_cycle")),
        residual=_B.average_residual,
        gap=_B.supply_residual_of_lag,
        assumption=f"{FULL_SUPPLY}, as in (14).",
        domain="0 <= dc <= 1, T_F = T_V = tau",
        remark="Exact for the average over a period h of any length, and for the torque itself as h -> 0, as the "
        "paper states. At half duty the torque ripples about it by T_max tanh(h/(4 tau)) peak to peak.",
    ),
    Claim(
        number="16",
        title="Speed limits (Trenitalia)",
        derivation=baselines,
        test=f"{_BASELINES}::test_speed_limits_are_a_slip_band",
        printed=Form("V_min = 0.78 v, V_max = 0.90 v", 'V_"min" = 0.78 v, quad V_"max" = 0.90 v'),
        domain="v > 0",
        sides=(_R * _omega, sp.Rational("0.78") * _v, sp.Rational("0.9") * _v),
        remark=f"The slip band {baselines.slip_band[0]} to {baselines.slip_band[1]}, around 0.14.",
    ),
    Claim(
        number="17",
        title="Absolute slide",
        derivation=baselines,
        test=f"{_BASELINES}::test_slide_is_slip_times_speed",
        printed=form("slide", baselines.slide),
        corrected_residual=baselines.slide_residual,
        domain="v > 0, omega >= 0",
    ),
    Claim(
        number="18",
        title="Slide regions (Knorr-Bremse)",
        derivation=baselines,
        test=f"{_BASELINES}::test_slide_regions",
        printed=Form(
            f"{_limits} (km/h), constant above 60 km/h",
            ", quad ".join(
                f"Delta sigma_{n} = {typst(limit)}" for n, limit in enumerate(baselines.limits_below, start=1)
            ),
        ),
        residual=sum(abs(jump) for jump in baselines.jumps),
        domain="v > 0, speeds in km/h",
        sides=(sp.Symbol("slide_limit"), *baselines.limits_with_unit),
        remark="Continuous at 60 km/h. A slide does not exceed v, so that the regions II, III and IV cannot be "
        "reached "
        f"below {', '.join(f'{float(v):.2f}' for v in baselines.regions_from)} km/h.",
    ),
    Claim(
        number="dc",
        title="Duty of the levels 0 to 3 (Section 4.2)",
        derivation=baselines,
        test=f"{_BASELINES}::test_duty_of_the_levels",
        printed=Form(
            "dc = "
            + ", ".join(f"{float(dc):g}" for dc in baselines.DUTY_OF_LEVEL.values())
            + " for |u| = 0 to 3"
        ),
        domain="Table 4",
        sides=(sp.Symbol("duty_cycle"), sp.Integer(1)),
        remark="A negative sign reduces the pressure, a positive one increases it, 0 keeps it. That Table 3 uses the "
        "same duties, .5 and .33, is inferred, not printed.",
    ),
    Claim(
        number="Table 3",
        title="Decisions (Trenitalia)",
        derivation=baselines,
        test=f"{_BASELINES}::test_signs_of_table_3",
        printed=Form("u = 2 where the pressure is to grow, 1 where it is to be reduced, 0 where it is held"),
        corrected=Form("u = -1 where the pressure is to be reduced"),
        residual=sp.Integer(baselines.table_3_ambiguities),
        corrected_residual=sp.Integer(len(baselines.table_3_wrong_with_sign)),
        gap=sp.Integer(len(baselines.table_3_wrong)),
        certainty=("inferred", "scan"),
        assumption="u is a code; the rule of signs of Section 4.2 speaks about Table 4 only.",
        domain="three states of the wheel speed, three of its rate",
        sides=(sp.Integer(2), sp.Integer(1)),
        remark="0, 1, 2 is a consistent code: one number for each arrow. Left over by the rule of Section 4.2: the "
        "number of cells whose sign contradicts their arrow.",
    ),
    Claim(
        number="Table 4",
        title="Decisions (Knorr-Bremse)",
        derivation=baselines,
        test=f"{_BASELINES}::test_duty_of_the_levels",
        printed=Form("lost in the text at hand, but for its symbols U3 to P3"),
        domain="four slide regions",
        lost=True,
        remark="The rules that are shipped were not read there: see wspd sources knorr-bremse.",
    ),
    Claim(
        number="Table 5",
        title="Fuzzy rules (Mitsubishi)",
        derivation=baselines,
        test=f"{_BASELINES}::test_row_variable_of_table_5",
        printed=Form("row variable -dσ/dt", "-dot(sigma)"),
        corrected=Form("row variable +dσ/dt", "+dot(sigma)"),
        residual=sp.Max(baselines.level_per_slide_rate_printed, 0),
        corrected_residual=sp.Max(baselines.level_per_slide_rate_corrected, 0),
        certainty=("inferred", "scan"),
        domain="v > 0, omega >= 0",
        sides=(-_slide_rate, _R * sp.Symbol("wheel_speed_rate"), _deceleration),
        remark="Residual: output level gained per row of growing slide; positive means more brake while sliding. "
        "That settles the sign, not the variable: Figure 5 (b) is named after the deceleration of the wheelset, "
        "which is dσ/dt + a, 3 to 4 m/s2 more. Under either sign (BZO, SPB) fills the brake at the largest slide, "
        "and a locked wheel reads IS.",
    ),
)
