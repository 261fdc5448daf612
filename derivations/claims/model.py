"""Claims on motion and adhesion, eqs. (1)-(7)."""

import sympy as sp

from derivations import adhesion, motion, slip_equation
from derivations.claim import Claim
from derivations.notation import symbol
from derivations.printing import Form, form

_slide = slip_equation.v - slip_equation.R * slip_equation.omega
_ROLLS = "v > 0, omega >= 0"
_UNIQUE = (
    "On v > 0, omega > 0 the right sides of (1) to (3) are locally Lipschitz, so that the motion exists and is "
    "unique until it leaves; at v = omega = 0 neither follows, because the slip has no limit there."
)
_MOTION, _ADHESION, _SLIP = (f"test_equations_{name}.py" for name in ("motion", "adhesion", "slip"))

CLAIMS = (
    Claim(
        number="1",
        title="Motion of the train",
        derivation=motion,
        functions=("motion.train_acceleration",),
        test=f"{_MOTION}::test_momentum_and_power_balance",
        printed=form("speed_rate", motion.train_acceleration),
        residual=motion.momentum_residual,
        domain=_ROLLS,
        remark=f"One creep force for all eight wheels; with (2) it conserves momentum and loses power. {_UNIQUE}",
    ),
    Claim(
        number="2",
        title="Rotation of one wheel",
        derivation=motion,
        functions=("motion.wheel_acceleration",),
        test=f"{_MOTION}::test_momentum_and_power_balance",
        printed=form("wheel_speed_rate", motion.wheel_acceleration),
        residual=motion.power_residual,
        certainty=("inferred", "scan"),
        domain="v > 0, omega > 0",
        remark="Prints f_f for f_fr. No stiction at omega = 0: a locked wheel has to be treated apart.",
    ),
    Claim(
        number="B_W",
        title="Damping between wheel and pads",
        derivation=motion,
        functions=("motion.wheel_damping",),
        test=f"{_MOTION}::test_printed_damping_grows",
        printed=form("wheel_damping", motion.damping_printed),
        corrected=form("wheel_damping", motion.damping_corrected),
        residual=sp.simplify(motion.damping_printed - motion.damping_corrected),
        corrected_residual=motion.damping_corrected_growth + sp.Rational(1, 100),
        certainty=("inferred", "scan"),
        domain="t >= 0",
        sides=(symbol("wheel_damping"), motion.initial ** (-motion.decay * motion.t)),
        remark="The printed power grows with time and has no unit, unless 0.25 is in N m s and stands before an "
        "exponential; negligible either way.",
    ),
    Claim(
        number="3",
        title="Longitudinal slip ratio",
        derivation=slip_equation,
        functions=("slip.slip_ratio", "slip.wheel_speed_at_slip"),
        test=f"{_SLIP}::test_slip_ratio",
        printed=form("slip", slip_equation.slip_of_speeds),
        corrected_residual=slip_equation.round_trip_residual,
        domain="v > 0",
        remark="Singular at v = 0: along R omega = k v the slip is 1 - k down to standstill. The model refers it "
        "to a regularized speed there.",
    ),
    Claim(
        number="4",
        title="Running resistance",
        derivation=motion,
        functions=("motion.running_resistance",),
        test=f"{_MOTION}::test_resistance_may_be_negative",
        printed=form("resistance", motion.running_resistance),
        domain="v >= 0",
        remark="May be negative downhill; the Lyapunov arguments need f_d + 8 f >= 0.",
    ),
    Claim(
        number="5",
        title="Creep force (Polach)",
        derivation=adhesion,
        functions=(
            "adhesion.creep_force",
            "adhesion.creep_force_slip_derivative",
            "adhesion.creep_force_speed_derivative",
        ),
        test=f"{_ADHESION}::test_limits_of_the_creep_force",
        printed=form("creep_force", adhesion.force_of_gradient),
        residual=adhesion.force_residual,
        domain="v > 0, slip >= 0, Q > 0",
        remark="Judged by three marks: odd in the slip, Q mu for large slip, and (kA + kS)/2 of Kalker's slope at "
        "zero slip. Depends on slip and on speed.",
    ),
    Claim(
        number="6",
        title="Gradient of the tangential stress",
        derivation=adhesion,
        functions=("adhesion.contact_stiffness", "adhesion.creep_gradient"),
        test=f"{_ADHESION}::test_gradient_from_linear_theory",
        printed=form("gradient", adhesion.gradient_printed),
        residual=sp.simplify(adhesion.gradient_printed - adhesion.gradient_derived),
        domain="Q mu > 0",
        remark="Follows from Polach's gradient with Kalker's stiffness C_t = 3 G c11 / (8 a).",
    ),
    Claim(
        number="7",
        title="Friction falling with sliding speed",
        derivation=adhesion,
        functions=("adhesion.friction_coefficient",),
        test=f"{_ADHESION}::test_friction_needs_the_magnitude_of_sliding",
        printed=form("friction", adhesion.friction_printed.subs(adhesion.w, _slide)),
        corrected=form("friction", adhesion.friction_corrected.subs(adhesion.w, _slide)),
        corrected_residual=adhesion.friction_asymmetry_corrected,
        domain="v >= R omega",
        remark="Holds on its domain, a wheel that brakes; for v < R omega the printed friction would grow without "
        "limit. The second form, with the magnitude, goes on there. The function of the model takes the magnitude.",
    ),
    Claim(
        number="Table 1",
        title="Coefficients of the friction",
        derivation=adhesion,
        test=f"{_ADHESION}::test_legible_cells_of_table_1",
        printed=Form("B = 0.6 s/m, μ0 = 0.55 (dry); μ0 = 0.3 (wet)"),
        domain="the two rail conditions of the table",
        sides=(1 / symbol("friction_decay"), symbol("sliding_speed")),
        remark="The text at hand has lost A, kS, B of the wet rail and the headings; the values that are shipped "
        "come from the source that the table cites.",
    ),
)
