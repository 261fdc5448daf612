"""What holds on the way from rolling to the reference for all numbers at once, with the identities of the proofs."""

from derivations import rolling_bounds as bounds
from derivations import rolling_instants as instants
from derivations import rolling_sample as sample
from derivations.theorem import Identity, Theorem

THEOREMS = (
    Theorem(
        anchor="all-ways-in",
        title="One sample of the way in, for all numbers at once",
        statement="Count torques of the law with h over its inertia J and all rates per sample. Let f be the mean "
        "over a sample of friction less damping of a wheel, D = kappa f + drag what its reference loses in it, g the "
        "true over the assumed effect of a torque, c the change of the torque T, lambda c what of it is in its mean "
        "and chi lambda c what the law takes for that. Of y = g T - (1 + kappa) f - drag, z = fhat - f + (g - 1) T - "
        "beta p, p the error of the observed wheel speed, beta = (1 - theta)/theta, e = K + D, K the filtered change "
        "of the reference, and x = T* - T, the torque T* = fhat + P - K being wanted, one sample makes, with d = "
        "lambda c (g - chi) and means f and drag that change by Df and Dd: y+ = y + g c - (1 + kappa) Df - Dd, z+ = "
        "theta z - Df + (g - 1) c - (1 - theta) d, p+ = theta p + theta^2 (z + d), e+ = kept e + kappa Df + Dd, x+ = "
        "x - c + n + k (ahead (n - c) - y - g lambda c), n = (1 - kept) e - (1 - theta)^2 (z + p/theta + d), k the "
        "change of the pull over that of the predicted error. At each sample y = P - x + z + beta p - e, and the "
        "error of the wheel speed falls by y + g lambda c. All of it is exact, whatever the friction does within a "
        "sample. From rest fhat is the sum of (1 - theta)^2 (j + 1) theta^j times what was put in 1 + j samples ago, "
        "the change of the wheel speed and the mean torque of the law; p is that of -theta^2 (j + 1) theta^j times "
        "what it changed by; -K is the sum of (1 - kept) kept^j D.",
        hypotheses=(
            "all wheelsets do the same, at a constant slip that is wanted",
            "wheel speeds, train speed and pressure are measured exactly, and the scale of the train speed is that of "
            "rolling wheels",
            "the observed friction is above 0; where it is cut there, b is added to z+ and to n",
        ),
        sketch="Newton's laws give the changes of both speeds from the means. The innovation of the observer is -(z "
        "+ p/theta + d), so that the mean friction, which the law does not know, is in z only. A sum over the "
        "samples before has the weights that its recursion has. The map is affine in each of its numbers but theta.",
        not_said="What f does: it has to be enclosed. What a change within a sample that is late has in its mean.",
        identities=(
            Identity("D = kappa f + drag", sample.reference_residual),
            Identity("a sample changes the wheel speed by f - g (T + lambda c)", sample.wheel_residual),
            Identity("the error falls by y + g lambda c", sample.error_fall_residual),
            Identity("y = P - x + z + beta p - e", sample.fall_residual),
            Identity("predicted error: the error and ahead (x - P)", sample.predicted_residual),
            Identity("it changes by ahead (n - c) - y - g lambda c", sample.predicted_change_residual),
            Identity("y+", sample.fall_next_residual),
            Identity("z+", sample.observed_next_residual),
            Identity("p+", sample.error_next_residual),
            Identity("e+", sample.lag_next_residual),
            Identity("x+", sample.way_next_residual),
            Identity("x+ with each state once", sample.learned_residual),
            Identity("x+ for c = rho x", sample.part_residual),
            Identity(
                "(z - y)+ = theta (z - y) - (1 - theta) y - c + kappa Df - (1 - theta) d + Dd",
                sample.unseen_residual,
            ),
            Identity("what is put in makes fhat+", sample.put_in_residual),
            Identity("and p+", sample.put_in_error_residual),
            Identity("fhat has two poles theta", sample.friction_sum_residual),
            Identity("p has the same", sample.error_sum_residual),
            Identity("the weights (j + 1) theta^j have them", sample.weight_residual),
            Identity("the first two weights", sample.first_weights_residual),
            Identity("those of fhat add up to 1", sample.many_residual),
            Identity("K+ = kept K - (1 - kept) D", sample.filter_sum_residual),
            Identity("x - P = fhat - T - K", sample.asked_residual),
        ),
        certificates=("slip_way_in",),
    ),
    Theorem(
        anchor="ways-in-cells",
        title="Ways from rolling into a band, in cells of all numbers",
        statement="Divide the box of friction, supply rate and a share of the ranges of mass, inertia, radius, pads "
        "and both valve times into cells. While a valve fills without a pause the torque is a function of time alone, "
        "so that at each slip the motion q = Y - w of a wheel of the cell lies between two bounds, and with it in "
        "which parts of the slip the wheel was a sample before. What observer and filter have not yet learned is "
        "followed from part to part: of what it was a sample before a share is kept, and what the friction changed by "
        "since is added. From the first slip at which valves may pause, the slip passes rows so narrow that each "
        "sample leads out of its row; in a row the states (y, z, p, e, x), the room of the supply, the speed and the "
        "least supply lie in boxes, one for each pair of slices of y and x, and what a sample makes of a box lies in "
        "boxes of later rows. Beyond the last row the wheels of all cells of a group lie in one box; from there on "
        "(P, z, p, x) lies in polytopes: for some samples one after the other, then in rows of the pull P, each as "
        "wide as its largest fall in a sample, then one after the other again. If the last polytopes lie in the "
        "ellipsoids of a band, in all of its cells that the group meets and in all windows that the train may be in, "
        "about the centers for the drifts of these wheels at these speeds, and the supply has what the band asks for, "
        "the wheels stay in the band down to the lowest speed, and have not slipped more than in any row or polytope.",
        hypotheses=(
            "friction and supply rate as stated, six numbers within the stated share, everything else at its nominal "
            "value, and the scale of the train speed found while rolling",
            "no dead band, no shortest pulse and no dead time; the supply is that of a main pipe, each cylinder "
            "follows it with a lag",
            "IEEE 754, with exp, log, arctan and square root within 8 units in the last place",
        ),
        sketch="Intervals are rounded outwards. q moves over the slip by d(q^2)/ds = 2 (v/R) (q'), with the bounds of "
        "q' of the section on bounds; S q is at least the least slope times the least motion in the parts that a "
        "sample may pass. The change Df weighs S q over two samples, with a weight that rises in the first and falls "
        "in the second. y = P - x + z + beta p - e cuts each box. The map is affine in g, in the part rho of a way "
        "that the valve goes, in the share lambda of it that is in the mean and in the slope k of the pull, one by "
        "one, so that corners of their ranges decide. A polytope is kept by bounds of fixed directions; multipliers "
        "of its half-spaces that are not negative bound what a direction reaches, wherever they come from.",
        not_said="Masses, inertias, radii, pads and valve times farther from the nominal ones; noise and dead time.",
        identities=(
            Identity("y = P - x + z + beta p - e", sample.fall_residual),
            Identity("x+ for c = rho x", sample.part_residual),
            Identity("it changes by ahead (n - c) - y - g lambda c", sample.predicted_change_residual),
            Identity("z counted from an instant: z+", instants.instant_residual),
            Identity("e counted from an instant: e+", instants.lag_instant_residual),
            Identity("what is added to z is f' with a weight from theta to 1", instants.weight_residual),
            Identity("of the mean (1 + theta)/2", instants.weights_residual),
            Identity("the mean is the instant and f' with a weight from 1 to 0", instants.mean_residual),
            Identity("x - P by what the observer has of torque and motion", instants.beyond_pull_residual),
            Identity(
                "an even rise in a mean of two samples, from the first mean on", instants.above_residual
            ),
            Identity("and before", instants.below_residual),
        ),
        certificates=("slip_way_in",),
    ),
    Theorem(
        anchor="bounds-of-ways-in",
        title="Bounds on the way in that need no simulation",
        statement="Count time in samples. (a) With the slip s, q = s' v/R, S = (R/v) df/ds, L = -v'/v, S_l = -v "
        "dS/dv and sigma = (s_r - s)/(1 - s_r): as long as 0 <= s <= s_r, dS/ds <= 0, q >= 0 and S > 0, l = (1 + "
        "kappa) S q has l' <= (1 + kappa) S (B - l), B = g T' + q (L (1 + max(S_l, 0)/S) - kappa sigma S) - (1 + "
        "sigma) drag' - (1 + kappa (1 + sigma)) f_v v', so that it stays below what it was and the largest B since, "
        "of moments with q > 0 and l as large as that. (b) A pulse of the part l of a sample that begins with it, "
        "for the share u of the room, fills room (1 - (1 - u)^rho) and of r, the first rate of the supply, between 0 "
        "and (l/2 + l^2 h/(12 T_F)) r/room times it more, rho the time of the inversion over T_F. (c) Of its change "
        "the share 1 - l/2 to 1 - l/2 + l^2 h/(12 T_F) is in the mean if the supply is constant, and at least 1 - "
        "l/2 - l w/6 if the part w comes from its rise; venting, the same with T_V. (d) What the law takes for the "
        "change in the mean is that of its nominal valve from a constant supply. (e) While the valve only fills, "
        "from an empty cylinder one sample after the supply began, at a given torque T' and the room grow with the "
        "supply rate, T' falls and the room grows with T_F >= h; T' has one maximum; what the torque grew by over a "
        "time before is largest for the largest rate and the smallest T_F. (f) If what is put into the observer has "
        "been at least -m since it rested, an observer that takes no friction below 0 has at most m more of it than "
        "one that is not cut, at most theta^2 m/(1 - theta^2) more in p and m/(1 + theta) more in z, and less of "
        "none. A cut adds at most (1 - theta) m - theta fhat, and none if that is negative. What is put in is the "
        "mean torque of the law less the mean of (1 - s) D/(1 - s_r) + q, and f - d - (g - 1) T. f is never below "
        "-drag (1 - s)/(1 - s_r + kappa (1 - s)) of the largest drag, unless it began so, while S >= 0. (g) While q "
        "= 0, q' = g T' - (1 + kappa (1 + sigma)) f_v v' - (1 + sigma) drag': where that is positive, q does not "
        "fall through 0; where q < 0, q' is larger than that if (1 + kappa (1 + sigma)) S >= L + (1 + sigma) kappa "
        "q_d, q_d the damping of a wheel.",
        hypotheses=(
            "the friction is one of the slip and the speed, less the damping of the wheel",
            "for (c): s h and h/T_F at most 1/4",
            "for (e): h <= T_F, a supply by eq. (8)",
        ),
        sketch="(a) (S q)' = S q' + S' q, and S' is at most L S_l: it rises only because v falls. (b) The supply "
        "rises at most at its first rate. (c) The part of an exponential change that is in the mean over its pulse "
        "is 1/2 and half of coth y - 1/y at half its length y, between 0 and y/6. What the rise adds grows at least "
        "as t and at most as t^2, so that 1/3 to 1/2 of it is in that mean. (e) dV/dT of V = T' grows with the "
        "supply rate, and with h/T_F where s (U - T) > V, which holds all the time if it does in the beginning. A "
        "larger V at each torque takes less time. (f) Both differences are that of the map from b >= 0. When it "
        "cuts, what is not cut is at least -m, as a mean of what was put in, and at least theta times what it was "
        "less (1 - theta) m. (g) In the identity of q' all but the first three terms count with q.",
        not_said="That S falls where the friction curve is convex. The slip is not monotone at the start: a wheel "
        "rolls with a small negative slip until the torque comes.",
        identities=(
            Identity("E' = -y", bounds.error_rate_residual),
            Identity("w' = -(1 - s) D/(1 - s_r) - q", bounds.wheel_rate_residual),
            Identity("q = 0 without torque at the least f", bounds.free_residual),
            Identity("f' = S q + f_v v'", bounds.friction_rate_residual),
            Identity(
                "q' = g T' - (1 + kappa (1 + sigma)) (S q + f_v v') - (1 + sigma) drag' + L q",
                bounds.growth_rate_residual,
            ),
            Identity("drag' of damping and resistance", bounds.drag_rate_residual),
            Identity("S' = dS/ds s' + L S_l", bounds.steepness_rate_residual),
            Identity("l' = (1 + kappa) S (B - l) where S' = L S_l", bounds.level_residual),
            Identity("S of Polach's curve", bounds.steepness_residual),
            Identity("S_l of it", bounds.falling_steepness_residual),
            Identity("f_v v' of it", bounds.fixed_slip_residual),
            Identity("f as programs compute it", bounds.kernel_residual),
            Identity("S", bounds.kernel_steepness_residual),
            Identity("S_l", bounds.kernel_falling_residual),
            Identity("f_v v'", bounds.kernel_fixed_residual),
            Identity("W = S_z - z S_z' has the derivative -z S_z''", bounds.lacking_residual),
            Identity("S_z''", bounds.bend_residual),
            Identity("it is negative for k_A = 3 k_S", bounds.concave_residual),
            Identity("part of an exponential change in the mean over its pulse", bounds.share_residual),
            Identity("that is 1/2 and half of coth y - 1/y", bounds.halved_residual),
            Identity("y cosh y - sinh y has the derivative y sinh y", bounds.above_residual),
            Identity(
                "(1 + y^2/3) sinh y - y cosh y has y/3 of that as its derivative", bounds.below_residual
            ),
            Identity("both begin at 0", bounds.bounds_start_residual),
            Identity("share of a change in the mean over the sample", bounds.in_mean_residual),
            Identity("what it is at most", bounds.in_mean_most_residual),
            Identity("what it is at least, with the part w from the rise", bounds.in_mean_least_residual),
            Identity("what an even rise adds", bounds.raised_residual),
            Identity("over t^2 that is a mean of falling exponentials", bounds.raised_falls_residual),
            Identity("so it falls with any rise that is concave", bounds.added_falls_residual),
            Identity("where what is added is convex", bounds.added_grows_residual),
            Identity("a pulse of the inversion goes 1 - (1 - u)^rho", bounds.own_power_residual),
            Identity("the supply rises with s times what it lacks", bounds.filling_supply_residual),
            Identity("dV/dT", bounds.filling_slope_residual),
            Identity("it grows with the supply rate", bounds.faster_supply_residual),
            Identity("and with h/T_F by (Q' - (tau - s) room)/V", bounds.faster_valve_residual),
            Identity("that keeps its sign", bounds.faster_valve_sign_residual),
            Identity("what it begins with", bounds.begins_residual),
            Identity("(1 - s) exp(s) <= 1 makes it positive", bounds.begins_below_residual),
            Identity("d room/dT", bounds.room_slope_residual),
            Identity("V'' = -tau s Q' where V' = 0", bounds.one_maximum_residual),
            Identity("after a cut p goes on as before", bounds.cut_error_residual),
            Identity("z by what was cut", bounds.cut_observed_residual),
            Identity("without one the difference of fhat fades", bounds.cut_fades_residual),
            Identity("by at least this", bounds.cut_fades_more_residual),
            Identity("a weight is at least theta times the one before", bounds.least_ratio_residual),
            Identity("what is cut at most", bounds.most_cut_residual),
            Identity("m/(1 + theta) is kept", bounds.most_observed_residual),
            Identity("theta^2 m/(1 - theta^2) is kept", bounds.most_error_residual),
            Identity("together they are m", bounds.together_residual),
        ),
        certificates=("slip_way_in",),
    ),
)
