"""Claims on the brake actuator and the published controllers, eqs. (8)-(18), Tables 3 and 5."""

import sympy as sp

from derivations import baselines, brake_actuator
from derivations.equation_map import Claim
from derivations.notation import symbol
from derivations.printing import Form, form, plain, typst

_BRAKE, _BASELINES = "test_equations_brake.py", "test_equations_baselines.py"
_B = brake_actuator
_lag = symbol("time_constant") * sp.Symbol("torque_rate") + symbol("torque")
_limits = ", ".join(f"Δσ{n} = {plain(limit)}" for n, limit in enumerate(baselines.limits_below, start=1))

CLAIMS = (
    Claim(
        number="8",
        title="Supply pressure",
        derivation=brake_actuator,
        functions=("brake.supply_pressure",),
        test=f"{_BRAKE}::test_supply_is_a_first_order_lag",
        printed=form("supply_pressure", _B.supply),
        residual=_B.supply_residual,
        remark="The paper's rate r is 0.75 1/s.",
    ),
    Claim(
        number="9",
        title="Cylinder pressure",
        derivation=brake_actuator,
        functions=("brake.cylinder_pressure_rate",),
        test=f"{_BRAKE}::test_valve_states_of_table_2",
        printed=form("pressure_rate", _B.pressure_rate_printed),
        corrected_residual=_B.pressure_rate_on_hold,
        remark="u_EV = 0, u_BV = 1 holds the pressure, as Table 2 says.",
    ),
    Claim(
        number="10",
        title="Filling",
        derivation=brake_actuator,
        functions=("brake.filled_pressure",),
        test=f"{_BRAKE}::test_exact_filling_law_solves_the_valve_equation",
        printed=form("pressure", _B.filled_printed),
        corrected=form("pressure", _B.filled),
        residual=_B.filled_residual_printed,
        corrected_residual=_B.filled_residual + _B.filled_residual_constant_supply,
        assumption="Constant supply pressure; with (8) the exact law has a second exponential.",
        remark="Residual of (9) with the supply (8).",
    ),
    Claim(
        number="11",
        title="Venting",
        derivation=brake_actuator,
        functions=("brake.vented_pressure",),
        test=f"{_BRAKE}::test_venting",
        printed=form("pressure", _B.vented),
        residual=_B.vented_residual,
    ),
    Claim(
        number="12",
        title="Braking torque of the cylinder",
        derivation=brake_actuator,
        functions=("brake.braking_torque",),
        test=f"{_BRAKE}::test_torque_is_proportional_to_pressure",
        printed=form("braking_torque", _B.K * sp.Symbol("mu_brake") * _B.P),
        corrected=form("braking_torque", _B.torque_of_pressure),
        remark="K_b = 2 A_eff E_b eta_b R. Second form: constant pad friction, as the model uses it.",
    ),
    Claim(
        number="13",
        title="Rate of the braking torque",
        derivation=brake_actuator,
        test=f"{_BRAKE}::test_product_rule_term",
        printed=form("torque_rate", _B.torque_rate_printed_13),
        corrected=form("torque_rate", _B.torque_rate_derived),
        residual=_B.product_rule_residual,
        corrected_residual=_B.bracket_residual,
        assumption="Constant pad friction mu_brake: the product-rule term in its derivative is dropped.",
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
        remark="Needs P_cin = P_cmax as well; bilinear in T and u unless T_F = T_V.",
    ),
    Claim(
        number="15",
        title="Average over the pulse width modulation",
        derivation=brake_actuator,
        functions=("brake.torque_ripple",),
        test=f"{_BRAKE}::test_ripple_of_a_simulated_pulse_train",
        printed=form(_lag, _B.T_max * _B.u),
        corrected=form("ripple", _B.ripple_printed),
        residual=_B.ripple_derived,
        corrected_residual=_B.ripple_residual,
        assumption="Infinite PWM frequency. At period h and half duty the torque ripples by the "
        "residual, peak to peak.",
    ),
    Claim(
        number="16",
        title="Speed limits (Trenitalia)",
        derivation=baselines,
        test=f"{_BASELINES}::test_speed_limits_are_a_slip_band",
        printed=Form("V_min = 0.78 v, V_max = 0.90 v", 'V_"min" = 0.78 v, quad V_"max" = 0.90 v'),
        remark=f"The slip band {baselines.slip_band[0]} to {baselines.slip_band[1]}, around 0.14.",
    ),
    Claim(
        number="17",
        title="Absolute slide",
        derivation=baselines,
        test=f"{_BASELINES}::test_slide_is_slip_times_speed",
        printed=form("slide", baselines.slide),
        corrected_residual=baselines.slide_residual,
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
        remark="Continuous at 60 km/h. Region IV cannot be reached below "
        f"{float(baselines.region_four_from):.1f} km/h.",
    ),
    Claim(
        number="Table 3",
        title="Decisions (Trenitalia)",
        derivation=baselines,
        test=f"{_BASELINES}::test_sign_missing_in_table_3",
        printed=Form("u = 1 where the pressure is to be reduced"),
        corrected=Form("u = -1 where the pressure is to be reduced"),
        residual=sp.Integer(len(baselines.table_3_wrong)),
        corrected_residual=sp.Integer(len(baselines.table_3_wrong_with_sign)),
        remark="Residual: number of cells whose sign contradicts their arrow.",
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
        remark="Residual: output level gained per row of growing slide; positive means more brake while "
        "sliding.",
    ),
)
