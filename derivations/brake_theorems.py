"""What the closed forms of the brakes rest on."""

from derivations import brake_actuator, valve_flow
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
)
