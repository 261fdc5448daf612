"""What the laws of a vehicle rest on: valve, observer, surface and adaptation."""

from derivations import friction_observer, fuzzy_loop, fuzzy_surface, slip_tracking, valve_inversion
from derivations.theorem import Identity, Theorem

THEOREMS = (
    Theorem(
        anchor="valve-inversion",
        title="A pulse brings the torque to a wanted value",
        statement="If the valve fills and vents through lags T_F and T_V and the demanded pressure does not change, "
        "filling for (T_F/h) ln((T_in - T)/(T_in - T*)) of a sample, or venting for (T_V/h) ln(T/T*), leads from T to "
        "T*. Worked out with times that are c times those of the valve, the pulse goes the part rho of the way, "
        "rho = (1 - x^c)/(1 - x), x = T*/T or (T_in - T*)/(T_in - T): about c for small steps.",
        hypotheses=(
            "lags (9), a demand that stays within the sample, no dead time",
            "the pulse is not longer than the sample, and not shorter than the valve can open",
        ),
        sketch="Both solutions of (9) are solved for the time at which they pass T*. With other times the exponent is "
        "multiplied by c.",
        not_said="That a valve is a lag: an orifice is inverted with the time constant that it has at the present "
        "torque. With the nominal times a valve twice as fast goes nearly twice the way; the laws take .6 of them.",
        identities=(
            Identity("filling for its share leads to T*", valve_inversion.filled_residual),
            Identity("venting for its share leads to T*", valve_inversion.vented_residual),
            Identity("mean torque of filling, venting and holding", valve_inversion.mean_residual),
            Identity("wrong times: T+ = T + rho (T* - T), venting", valve_inversion.part_residual),
            Identity("the same, filling", valve_inversion.part_fill_residual),
            Identity("rho = c for small steps", valve_inversion.small_step_residual),
            Identity("rho = 1 for a step to nothing", valve_inversion.full_step_residual),
        ),
        certificates=(),
    ),
    Theorem(
        anchor="friction-observer",
        title="The friction torque is observed without a model of the friction",
        statement="If the friction torque is constant, the errors of the observed speed and torque decay with the "
        "double pole theta = exp(-w_o h). If the torque of the brake is known up to a constant, the speed has no error "
        "and the observed torque is the one that explains the motion. A friction torque that changes by delta in each "
        "sample is observed too late by (1 + theta)/(1 - theta) delta.",
        hypotheses=(
            "J w' = tau_r - T, with the mean of T over each sample",
            "wheel speeds without noise",
        ),
        sketch="The errors obey a linear map of two dimensions; its characteristic polynomial is (z - theta)^2.",
        not_said="How much noise it passes on: the observed torque moves by (1 - theta)^2 J/h times the noise of the "
        "wheel speed. That the observed torque is kept from falling below 0 is not counted.",
        identities=(
            Identity("det(z - A) = (z - theta)^2", friction_observer.poles_residual),
            Identity(
                "constant error of the torque: no error of the speed", friction_observer.offset_residual
            ),
            Identity("even drift: constant lateness", friction_observer.drift_residual),
        ),
        certificates=(),
    ),
    Theorem(
        anchor="slip-tracking",
        title="Surfaces that the valve moves, and a braking curve that it can follow",
        statement="If the friction torque is known, the torque tau - J (w_r' - y) makes the error of the wheel speed "
        "fall at the rate y. The valve moves the error in its second derivative and e' + k e in the first. On the "
        "curve y^2 = 2 s (e - s/(2 k^2)) the pull falls evenly with the slew s, and meets y = k e with the same slope. "
        "With y = k_1 abs(e)^(1/2) sgn(e) + z, z' = k_2 sgn(e), a quadratic function of (abs(e)^(1/2) sgn(e), z) "
        "falls. "
        "With y = k e + W sgn(e + k int e dt) the surface is reached against disturbances below W.",
        hypotheses=(
            "J e' = tau - T - J w_r', the torque T being that which is asked for",
            "for the curve: e' = -y all the way",
            "for super-twisting: k_1, k_2 > 0 and no disturbance that changes",
        ),
        sketch="The torque is inserted into the motion. On the curve y' = (dy/de) e' = -s. The function of "
        "super-twisting is Moreno's: its rate is -zeta' Q zeta/abs(e)^(1/2), Q positive definite.",
        not_said="Anything about sampling, the lag between the torque that is asked for and the one that is there, or "
        "the noise. Within a layer the laws replace the root and the sign by straight lines.",
        identities=(
            Identity("w_r' = (v'/R)(1 - lambda_d - v dlambda_d/dv)", slip_tracking.reference_residual),
            Identity("dlambda_d/dv = -lambda_d/(2 v) for c/sqrt(v)", slip_tracking.falling_residual),
            Identity("w_r' = (v'/R)(1 - lambda_d/2) for c/sqrt(v)", slip_tracking.falling_rate_residual),
            Identity("e' = -y under the wanted torque", slip_tracking.target_residual),
            Identity("e' does not contain the command of the valve", slip_tracking.degree_residual),
            Identity(
                "(e' + k e)' contains it with the factor -(T_in - T)/(J T_F)",
                slip_tracking.surface_rate_residual,
            ),
            Identity("y' = -s on the braking curve", slip_tracking.curve_slew_residual),
            Identity("it meets k e at e = s/k^2", slip_tracking.meeting_residual),
            Identity("with the same slope", slip_tracking.meeting_slope_residual),
            Identity(
                "and is nowhere above it: (k e)^2 - y^2 = (k e - s/k)^2", slip_tracking.below_line_residual
            ),
            Identity("super-twisting: V' = -zeta' Q zeta/sqrt(e)", slip_tracking.twisting_residual),
            Identity("det Q = k_1^2 k_2/2", slip_tracking.definite_residual),
            Identity("integral sliding mode: s' = d - W sgn(s)", slip_tracking.reaching_residual),
        ),
        certificates=(),
    ),
    Theorem(
        anchor="mended-fuzzy",
        title="An adaptive fuzzy law on a surface that the valve moves at once",
        statement="If weights exist with which the fuzzy part makes the command that keeps sigma = e' + k e, up to an "
        "error below psi, then outside the layer V = sigma_D^2/(2 g) + sum (b_r - b*_r)^2/(2 alpha) rises by no more "
        "than the leakage times sum b*_r^2/4: weights stay bounded, and without leakage V does not increase.",
        hypotheses=(
            "sigma' = g (u* - u) with a constant g: the valve moves the torque in proportion to the command",
            "the command is not saturated; the weights are not at the limits that they are projected to",
        ),
        sketch="The terms of sigma_D and the weight errors cancel by the adaptation law. -b (b - b*) is at most "
        "b*^2/4.",
        not_said="That the surface is reached: with leakage an error stays. g changes with the torque, and the law is "
        "sampled: for that see the theorem below.",
        identities=(
            Identity(
                "the command moves sigma' with the factor -R (T_in - T)/(J T_F)",
                fuzzy_surface.degree_residual,
            ),
            Identity(
                "V' = sigma_D (xi - psi) - leakage b (b - b*), one rule", fuzzy_surface.lyapunov_residual
            ),
            Identity("-b (b - b*) = -(b - b*/2)^2 + b*^2/4", fuzzy_surface.leak_residual),
        ),
        certificates=(),
    ),
    Theorem(
        anchor="fuzzy-sector",
        title="What the mended adaptive fuzzy law keeps, and the sector of its valve",
        statement="Weights: if they adapt by at most the part h alpha leakage <= 1 of the way in a sample, a weight "
        "stays in every interval that holds its first value, 0 and all values of sigma_D w/leakage. With "
        "memberships of one width the weight of a rule takes the sign opposite to its center by no more than "
        "exp(-kappa (Phi - m) - 1)/(kappa leakage), and psi does not fall below its first value. Inside the layer "
        "the weights fade, and with a whole sample at its edge the command is sigma/Phi. Sector: there one sample "
        "makes x+ = A x of x = (e, e before, filtered e', W), with one A for all deviations while the valve fills "
        "and another while it vents. If some P > 0 has c^2 P - A'PA positive definite at the corners of all numbers "
        "of a sample, small deviations fall by c < 1 a sample, however filling and venting follow each other. If "
        "the product of the A of some course of filling and venting has an eigenvalue outside of the unit circle, "
        "no function falls along all courses; and if it is real, above 1, and the surface has along its eigenvector "
        "the sign that each step of the course asks for, the loop itself takes that course and leaves its "
        "reference.",
        hypotheses=(
            "weights that have faded, as they do inside the layer with the time constant 1/(alpha leakage)",
            "the numbers of the loop frozen at one speed, the fall of which counts in q = p - a/v alone; small "
            "deviations: the pulse is short and lies at the start of the sample",
            "no least pulse: what is shorter is not commanded, and leaves deviations that it would answer",
            "wheel speed and train speed measured exactly, without dead time; full supply pressure",
        ),
        sketch="A weight moves to a mean of itself and sigma_D w/leakage. The surface has relative degree one in the "
        "valve, whose authority is (T_in - T)/T_F or T/T_V: a sector that is as wide as the brake is far from half of "
        "its torque. On a poor rail it fills many times faster than it vents. What falls along every course in the "
        "sector falls along that of the loop, not the other way round.",
        not_said="A band of slip: deviations that leave the layer, where the weights come in, are not followed. That "
        "the loop leaves its reference where only the sector fails: the sign of the surface decides which course it "
        "takes.",
        identities=(
            Identity(
                "a sample of adaptation is a mean of b and sigma_D w/leakage", fuzzy_loop.mixed_residual
            ),
            Identity(
                "ratio of two memberships of one width: -kappa (sigma - m) in the exponent",
                fuzzy_loop.ratio_residual,
            ),
            Identity("x exp(-kappa x) is largest at x = 1/kappa", fuzzy_loop.turning_residual),
            Identity("what it is there, from the layer on", fuzzy_loop.bound_residual),
            Identity("phi e - psi W solves e' = q e - W", fuzzy_loop.between_residual),
            Identity("a short filling moves T by h (T_in - T)/T_F for u = 1", fuzzy_loop.fill_residual),
            Identity("a short venting by -h T/T_V", fuzzy_loop.vent_residual),
        ),
        certificates=("fuzzy_sector",),
    ),
)
