"""Published controllers, eqs. (16)-(18), Tables 3 and 5: what their thresholds and signs imply.

Claims: (16) is the slip band 0.10 to 0.22 that contains 0.14; (18) is continuous at 60 km/h and its region
IV cannot be reached below 11 km/h; Table 3 lacks the sign of pressure reduction; with the row variable as
printed, Table 5 raises the pressure while the slide grows.
"""

import sympy as sp

from derivations import slip_equation
from derivations.notation import symbols

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
# A slide cannot exceed the train speed (omega >= 0): region IV starts where its limit falls below v.
region_four_from = sp.solve(sp.Eq(limits_below[2], v), v)[0]

# --- Table 3: (direction of the pressure, printed u) of each cell -----------------------------------------
UP, HOLD, DOWN = 1, 0, -1
TABLE_3 = (
    ((UP, 2), (DOWN, 1), (UP, 2)),
    ((UP, 2), (DOWN, 1), (DOWN, 1)),
    ((UP, 2), (DOWN, 1), (HOLD, 0)),
)
# Section 4.2: a negative u reduces the pressure. These printed entries say the opposite of their arrow.
table_3_wrong = [(arrow, u) for row in TABLE_3 for arrow, u in row if sp.sign(u) != arrow]
table_3_wrong_with_sign = [
    (arrow, u) for row in TABLE_3 for arrow, u in ((a, a * abs(n)) for a, n in row) if sp.sign(u) != arrow
]

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
