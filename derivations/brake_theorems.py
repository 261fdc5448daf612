"""What the closed forms of the brakes rest on."""

from derivations import brake_actuator, corner, valve_flow
from derivations.theorem import Identity, Theorem

THEOREMS = (
    Theorem(
        anchor="orifice",
        title="Every build-up and valve has a closed form",
        statement="While a valve stays in one state, the cylinder pressure is known at every moment without an "
        "integration. Through a lag it follows a demand that rises evenly, or as that of the main pipe, up to a limit. "
        "Through an orifice of ISO 6358 it fills and vents choked up to the critical ratio b and along an ellipse from "
        "there to equal pressures, which it reaches in finite time. Where build-up and orifice both limit it, "
        "p(t) = min(Q(t, t0, p0), D(t), Q(t, s, D(s))): D the demanded pressure, Q(t, t1, p1) what the "
        "orifice makes of "
        "the pressure p1 at t1, and s the moment at which the orifice begins to pass less than the demand rises; the "
        "last one counts from s on, if t0 <= s.",
        hypotheses=(
            "air and cylinder keep their temperature, the cylinder its volume; nothing flows back while it fills",
            "the reservoir keeps its pressure while the valve stays in one state: it is counted anew when a "
            "command or a "
            "watchdog acts, nothing refills it during a stop, and it holds more than the cylinders",
            "at the start of the state the pressure is not above the demand, which never falls",
            "for b within 5e-9 of 1/2 the advance is its series, exact to the last digit there",
        ),
        sketch="On the ellipse r = b + (1 - b) cos(2 chi) the flow is sin(2 chi). Filling, r' = phi(r)/tau makes the "
        "angle fall evenly. Venting, r = p_a/p has r' = r phi(r)/tau, and y = tan(chi) obeys y' = -(1 + (2 b - 1) y^2) "
        "over the progress: a tangent for b > 1/2, a hyperbolic tangent for b < 1/2, a line between them. For the "
        "minimum let f(p) be what the orifice passes at p. The pressure has p' = f(p) below D and p' = "
        "min(f(D), D') on "
        "it: it is the least of Q(t, s, D(s)) over all s from t0 to t, and of Q(t, t0, p0), since Q keeps the order of "
        "its starts. In s this rises where D' > f(D) and falls where D' < f(D). Along the demand f(D) - D' "
        "is concave in "
        "D, because f is constant up to b and an ellipse from there, and D' is linear in D for the main pipe "
        "and constant "
        "for a ramp; so it is positive on one interval of D at most. Before that interval the least is at "
        "t0, within it "
        "at t, beyond it at its upper end, where A cos(theta) + B sin(theta) = C on the ellipse. A ramp that ends is "
        "followed by D' = 0, where the least is at t again.",
        not_said="That a real valve is an orifice, or which b and tau it has: no measured blow-down of a dump valve is "
        "known here. Pipes, heat, the inertia of valves and the hysteresis of the cylinder are left out. Within one "
        "state the reservoir is taken as it was at its start, so that what the other cylinders take meanwhile counts "
        "one command later.",
        identities=(
            Identity("lag behind a ramp: p' = (k (t - t_r) - p)/T_F", valve_flow.ramp_residual),
            Identity("it begins at P_0", valve_flow.ramp_start_residual),
            Identity(
                "lag behind the main pipe: p' = (P_in - p)/T_F with (8)", brake_actuator.filled_residual
            ),
            Identity("lag behind a limit: p' = (P_in - p)/T_F", valve_flow.approached_residual),
            Identity("venting and then a leak: p' = -p/T_V, p' = -k_H p", valve_flow.released_residual),
            Identity("the same for the leak", valve_flow.leak_residual),
            Identity("phi^2 = sin^2(2 chi) at r = b + (1 - b) cos(2 chi)", valve_flow.ellipse_residual),
            Identity("b + (1 - b) cos(2 chi) = 1 - 2 (1 - b) sin^2(chi)", valve_flow.angle_residual),
            Identity("filling: r' = phi/tau with chi' = -1/(2 (1 - b) tau)", valve_flow.filling_residual),
            Identity("tan^2(chi) = (1 - r)/(r + 1 - 2 b)", valve_flow.tangent_residual),
            Identity(
                "venting: r' = r phi/tau with y' = -(1 + (2 b - 1) y^2)/(2 (1 - b) tau)",
                valve_flow.venting_residual,
            ),
            Identity(
                "y = (y_0 - Y)/(1 + (2 b - 1) y_0 Y) with Y' = 1 + (2 b - 1) Y^2", valve_flow.falling_residual
            ),
            Identity("b > 1/2: Y = tan(kappa xi)/kappa, kappa^2 = 2 b - 1", valve_flow.above_residual),
            Identity("b < 1/2: Y = tanh(kappa xi)/kappa, kappa^2 = 1 - 2 b", valve_flow.below_residual),
            Identity("b near 1/2: Y = xi + (2 b - 1) xi^3/3 + O(xi^5)", valve_flow.near_residual),
            Identity("choked venting meets r = b after tau ln(b/r)", valve_flow.choked_residual),
            Identity("the flow is the choked one at r = b, y = 1", valve_flow.meeting_residual),
            Identity(
                "A cos(theta) + B sin(theta) = C where the demand gets ahead", valve_flow.leaving_residual
            ),
        ),
        certificates=(),
    ),
    Theorem(
        anchor="corners",
        title="Rounded corners keep the order of the integration",
        statement="A corner max(x, 0) that is replaced within w of zero by its mean under the bump 15/16 (1 - "
        "(x/w)^2)^2 / w has three continuous derivatives and is the sharp one elsewhere. Friction of pads"
        " over speed and temperature, the characteristic of an electrodynamic brake and the force of a "
        "track brake are sums of such corners. A step of a Runge-Kutta method of order four across one "
        "has an error of the order h^5, as any other.",
        hypotheses=(
            "the rest of the right-hand side has four derivatives within the step",
            "what the corner depends on moves smoothly; its speed times the step is small against w",
        ),
        sketch="The second derivative of the smeared corner is the bump, which has a derivative of its own that "
        "vanishes at its ends; the fourth derivative of the corner is bounded and jumps. A function with "
        "three continuous derivatives and a bounded fourth one differs by O(h^4) from its Taylor "
        "polynomial of order three, so that what a step of length h adds to the state is wrong by O(h^5).",
        not_said="How large the constant is: where a wheel crosses the width of a corner in one or two steps, the "
        "step check of a run tells whether they were short enough. The widths, 0.5 m/s and 10 K, are a "
        "choice; a real table has no corners.",
        identities=(
            Identity("the bump has the weight 1", corner.whole_residual),
            Identity("second derivative of the rounded corner = the bump", corner.second_residual),
            Identity(
                "value and three derivatives meet those of max(x, 0) at both ends", corner.meeting_residual
            ),
            Identity("it is 5/32 w at the corner", corner.middle_residual),
            Identity("the fourth derivative jumps by 15/2 / w^3", corner.fourth_residual),
        ),
        certificates=(),
    ),
)
