"""Theorems about the plant and about every stop."""

from derivations import slip_equation, stop_limit, torque_balance
from derivations.theorem import Identity, Theorem

THEOREMS = (
    Theorem(
        anchor="bound",
        title="No controller stops shorter than the rail and the filling brake allow",
        statement="At every instant v' >= -P(v), P = (f_d + m g_0 mu)/m, with g_0 = 9.81 m/s2 and mu(v) the largest "
        "creep force over load of any slip, and (m + n I_w/R^2)(v_0 - v) <= (f_d(v_0) + 2 n B_W v_0 (1 + s)/R^2) t + "
        "(n/R) int T_fill dt + n I_w s v_0/R^2 for n wheelsets of inertia I_w, T_fill the torque of a brake that "
        "only fills, and s a small slip. The second bounds the speed until some instant and the first from then on; "
        "the best instant bounds time and distance of every stop. Over ranges of the numbers it holds with each at the "
        "end where the stop is shortest, and mu at the least load of an axle.",
        hypotheses=(
            "the wheels roll and the cylinders are empty at v_0",
            "level track; the wheel loads add up to the weight",
            "every wheel has the static load, or else mu is the peak at the least load of a wheel",
            "f_d and B_W >= 0 are largest at v_0",
            "if all wheelsets are alike: abs(f(-s)) (8/m + 2 R^2/I_w) >= (1 + s) f_d/m at v_0, with s = 0.0001",
            "if they differ: abs(f(-s)) 2 R^2/I_w >= (1 + s) D at the least load, D the largest deceleration of the "
            "train; for the ER24PC from 120 km/h s between 0.01 and 0.02 will do on polach-dry, polach-wet and "
            "table10-dry",
        ),
        sketch="The momentum of train and wheels changes by resistance, brake and damping alone. At the slip -s the "
        "creep force turns the slip back to 0 by the last hypotheses, so that R omega <= (1 + s) v for good. The "
        "creep force grows with the friction, since S - eps S' >= 0: the peak falls with the speed, and the bound of "
        "mu at one speed holds above it. It also falls with the load: f/Q depends on s C/Q, and C/Q falls with Q; "
        "under less load Q' the slip s (C/Q)/(C'/Q') < s has the same gradient, slides less and finds no less "
        "friction. So sum Q_i mu(Q_i) <= m g_0 mu(min Q_i).",
        not_said="That a controller reaches it. That load transfer lowers the sum of the peaks on every rail: "
        "with mu0 .42, A .15, B .6 s/m, k_A .2, k_S .04 at 57 km/h wheel loads of 130 and 70 % raise it by "
        f"{100 * stop_limit.load_transfer_example:.2f} %.",
        identities=(
            Identity("R m v' + 8 I omega' = -R f_d - 4 T - 8 B_W omega", stop_limit.momentum_residual),
            Identity(
                "(m + J)(v_0 - v) = m (v_0 - v) + J (v_0 - R omega) + J s v for R omega = (1 + s) v, J = 8 I/R^2",
                stop_limit.overspeed_residual,
            ),
            Identity(
                "v slip' at the slip -s = abs(f)(8/m + R^2/I) - (1 + s) f_d/m + 8 s abs(f)/m + (1 + s) v B_W/I + "
                "R T/(2 I)",
                stop_limit.outrun_residual,
            ),
            Identity(
                "v slip' at the slip -s = abs(f) R^2/I - (1 + s) D + (1 + s) v B_W/I + R T/(2 I), v' = -D",
                stop_limit.outrun_others_residual,
            ),
            Identity(
                "S - eps S' = 2 x^3/(1 + x^2)^2 + atan y - y/(1 + y^2), x = k_A eps, y = k_S eps",
                stop_limit.friction_residual,
            ),
            Identity("(atan y - y/(1 + y^2))' = 2 y^2/(1 + y^2)^2", stop_limit.surplus_rate_residual),
            Identity(
                "the torque integral of Table 10 is a momentum balance", torque_balance.identity_residual
            ),
        ),
        certificates=("stop_bound", "conservation"),
    ),
    Theorem(
        anchor="slip-equation",
        title="The slip equation",
        statement="(19) follows from (1) to (3): slip' = F + G T with G = R/(2 I v) > 0, affine in the torque.",
        hypotheses=("v > 0",),
        sketch="Differentiate (3) and insert (1), (2).",
        not_said="Anything at standstill, where the slip ratio is singular.",
        identities=(
            Identity("(19) as printed", slip_equation.slip_rate_residual),
            Identity("drift F", slip_equation.drift_residual),
            Identity("slope of F at fixed speed", slip_equation.drift_slope_residual),
        ),
        certificates=("derivation", "gain_positive", "well_posed"),
    ),
)
