"""The theorem on slips that take more than full pressure, with the identities that carry its proof."""

import sympy as sp

from derivations import adhesion
from derivations.slip_equation import B_W, R, drift, f, f_d, inertia, m, slip, slip_gain, v
from derivations.theorem import Identity, Theorem

# --- what holds a slip while its own wheelset alone slows the train down: f_d makes that of the eight wheels -----
_alone = 2 * f - 8 * f
_held = sp.simplify((-drift / slip_gain).subs(f_d, _alone))
_by_hand = 2 * (R * f + inertia * (1 - slip) * (2 * f / m) / R - B_W * (1 - slip) * v / R)
holding_residual = sp.simplify(_held - _by_hand)

# --- along the stop: the same slip, a lower speed -----------------------------------------------------------------
_force, _fading = sp.Function("f")(v), sp.Symbol("f_v", real=True)
_slope = sp.diff(_by_hand.subs(f, _force), v).subs(sp.diff(_force, v), _fading)
_slope_by_hand = 2 * R * (1 + 2 * inertia * (1 - slip) / (m * R**2)) * _fading - 2 * B_W * (1 - slip) / R
slope_residual = sp.simplify(_slope - _slope_by_hand)

# --- the adhesion falls with the friction -------------------------------------------------------------------------
_weak, _slow = adhesion.kA * adhesion.gradient, adhesion.kS * adhesion.gradient
_per_friction = adhesion.shape - adhesion.gradient * adhesion.shape_slope_of_gradient
_shown = 2 * _weak**3 / (1 + _weak**2) ** 2 + sp.atan(_slow) - _slow / (1 + _slow**2)
friction_residual = sp.simplify(_per_friction - _shown)

THEOREMS = (
    Theorem(
        anchor="limit",
        title="A slip that takes more than full pressure is not exceeded again",
        statement="Let T_s = 2 (R f + I (1 - s) (2 f/m)/R - B_W (1 - s) v/R) be the torque that holds the slip s of a "
        "wheelset that slows the train down alone. If the force f at this slip does not rise with the speed, a "
        "wheelset that slips at most s at a speed at which T_s >= T_max slips at most s for the rest of the stop, "
        "whatever its torque does between 0 and T_max.",
        hypotheses=(
            "mass, inertia, radius, pads and the numbers of contact and rail do not change; the load is the static one",
            "the train slows down, at least as this wheelset alone slows it down",
            "the torque of the brake never exceeds T_max",
        ),
        sketch="(19) is slip' = G (T - T_h) with G > 0, and T_h grows with the deceleration of the train: at slip s it "
        "is at least T_s, so that the slip does not grow there under T <= T_max. While the train slows down, T_s at "
        "the same slip does not fall: f does not rise with the speed, and B_W v falls. By Polach's method f changes "
        "with the speed as the friction does, times (2/pi) Q times a factor that is not negative.",
        not_said="Whether the brake is the limit anywhere; what the slip does at a higher speed, nor where full "
        "pressure is a little more than what holds the slip. That the wheel slips, or brakes: it may roll.",
        identities=(
            Identity("T_s = -F/G with f_d + 8 f = 2 f", holding_residual),
            Identity(
                "dT_s/dv = 2 R (1 + 2 I (1 - s)/(m R^2)) df/dv - 2 B_W (1 - s)/R at a given slip",
                slope_residual,
            ),
            Identity(
                "with w = kA eps, y = kS eps the factor is 2 w^3/(1 + w^2)^2 + atan(y) - y/(1 + y^2)",
                friction_residual,
            ),
        ),
        certificates=("slip_limit",),
    ),
)
