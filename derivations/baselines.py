"""Published controllers, eqs. (16)-(18), Tables 3 and 5: what their thresholds and signs imply.

Claims: (16) is the slip band 0.10 to 0.22 that contains 0.14; (18) is continuous at 60 km/h and its regions II, III
and IV cannot be reached below 3.4, 7.1 and 11.0 km/h; Table 3 is a consistent code that needs a rule for its signs;
with the row variable as printed, Table 5 raises the pressure while the slide grows.
"""

import sympy as sp

from derivations import slip_equation
from derivations.notation import symbols, time

v, omega, R, slip = symbols("speed wheel_speed wheel_radius slip")

# --- (16): wheel speeds 0.78 v and 0.90 v as slip ---------------------------------------------------------
slip_band = tuple(
    slip_equation.slip_of_speeds.subs(omega, sp.Rational(ratio) * v / R) for ratio in ("0.90", "0.78")
)

# --- (17): absolute slide ---------------------------------------------------------------------------------
slide = v - R * omega
slide_residual = sp.simplify(slide - slip_equation.slip_of_speeds * v)

# --- (18): region limits, all speeds in km/h --------------------------------------------------------------
KINK = 60
limits_below = tuple(sp.Rational(slope, 60) * v + offset for slope, offset in ((7, 3), (9, 6), (11, 9)))
limits_above = (10, 15, 20)
jumps = tuple(low.subs(v, KINK) - high for low, high in zip(limits_below, limits_above, strict=True))
# A slide cannot exceed the train speed (omega >= 0): a region starts where its lower limit falls below v.
regions_from = tuple(sp.solve(sp.Eq(limit, v), v)[0] for limit in limits_below)  # II, III, IV in km/h
kmh = sp.Symbol("kmh", positive=True)
limits_with_unit = tuple(kmh * limit.subs(v, v / kmh) for limit in limits_below)

# --- Table 3: (direction of the pressure, printed u) of each cell -----------------------------------------
UP, HOLD, DOWN = 1, 0, -1
TABLE_3 = (
    ((UP, 2), (DOWN, 1), (UP, 2)),
    ((UP, 2), (DOWN, 1), (DOWN, 1)),
    ((UP, 2), (DOWN, 1), (HOLD, 0)),
)
# As a code it is consistent: every arrow has one number, every number one arrow.
_codes = {(arrow, u) for row in TABLE_3 for arrow, u in row}
table_3_ambiguities = len(_codes) - len({arrow for arrow, _ in _codes})
# Section 4.2 states a rule for Table 4: a negative u reduces the pressure. Read so, these cells contradict.
table_3_wrong = [(arrow, u) for row in TABLE_3 for arrow, u in row if sp.sign(u) != arrow]
table_3_wrong_with_sign = [
    (arrow, u) for row in TABLE_3 for arrow, u in ((a, a * abs(n)) for a, n in row) if sp.sign(u) != arrow
]

# --- the rule for dc of Section 4.2, and T_d of Section 7 --------------------------------------------------
DUTY_OF_LEVEL = {0: sp.Rational(0), 1: sp.Rational("0.33"), 2: sp.Rational("0.5"), 3: sp.Rational(1)}
_T, _t = symbols("braking_torque time")
_gain, _decay, _frequency = sp.symbols(
    "disturbance_gain disturbance_decay disturbance_frequency", positive=True
)
disturbing_torque = _gain * _T * sp.exp(-_decay * _t) * sp.sin(_frequency * _t)
disturbing_torque_printed = disturbing_torque.subs(
    {_gain: sp.Rational("0.05"), _decay: 4, _frequency: 10 * sp.pi}
)

# --- Table 5: output level, rows BNB ... BPB of the row variable, columns of growing slide ----------------
_LEVELS = {"IB": 3, "IM": 2, "IS": 1, "ZO": 0, "DS": -1, "DM": -2, "DB": -3}
TABLE_5 = sp.Matrix(
    [
        [_LEVELS[name] for name in row.split()]
        for row in (
            "IB IB IS IS",
            "IM IM IS IS",
            "IS IS IS IS",
            "ZO ZO ZO IS",
            "DS ZO DS DM",
            "DS DS DM DM",
            "DM DM DM DB",
        )
    ]
)
level_per_row = sp.Rational(sum(TABLE_5.row(-1) - TABLE_5.row(0)), 4 * (TABLE_5.rows - 1))
level_per_slide_rate_printed = (
    -level_per_row
)  # the row variable is -d sigma/dt: > 0, pressure grows with slide
level_per_slide_rate_corrected = level_per_row
# Figure 5 (b) is named after the deceleration of the wheelset. It differs from +d sigma/dt by the deceleration a.
_v, _omega = (sp.Function(name, real=True)(time) for name in ("v", "omega"))
_a = sp.Symbol("deceleration", real=True)
wheel_deceleration_apart = sp.simplify(
    (-R * sp.diff(_omega, time) - sp.diff(_v - R * _omega, time)).subs(sp.diff(_v, time), -_a)
)
# A steady slide of the largest size (BZO, SPB) fills the brake, whichever sign the row variable has; a locked
# wheel reads a row of BNB to BZO in the last column by +d sigma/dt = -a, and BZO by its deceleration: it fills too.
level_at_largest_slide = TABLE_5[3, 3]
levels_of_locked_wheel = tuple(TABLE_5[row, 3] for row in range(4))
