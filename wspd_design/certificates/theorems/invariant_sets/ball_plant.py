"""Motion of a wheelset and its brake on balls, with formulas of its own: eqs. (1)-(7), (9) written out."""

from wspd_design.certificates.records import Problem
from wspd_design.certificates.theorems.invariant_sets.ball_slopes import Ball, hull
from wspd_design.parameters.loading import constants


class BallPlant:
    """Motion, valve and law over the box of parameters."""

    def __init__(self, problem: Problem) -> None:
        from flint import arb, fmpq

        self.point = arb
        self.problem, vehicle = problem, problem.vehicle
        contact = vehicle.contact
        self.sample, self.full = arb(problem.sample_time), arb(vehicle.brake.max_torque)
        self.radius, self.reference = arb(vehicle.wheel_radius), arb(problem.slip)
        self.inertia = hull(*map(arb, problem.span("wheelset inertia"))) / 2
        self.mass = hull(*map(arb, problem.span("mass")))
        self.damping = hull(arb(0), arb(vehicle.wheel_damping))
        self.gravity = arb(constants().gravity)
        self.pull = self.gravity  # deceleration per adhesion, where every wheel brakes alike
        product = arb.pi() / 4 * arb(contact.shear_modulus) * arb(contact.semi_axis_rolling)
        slope = product * arb(contact.semi_axis_lateral) * arb(contact.kalker_c11)
        power = fmpq(2, 3)
        self.ends = []
        for mu0, mass in dict.fromkeys(zip(problem.span("mu0"), problem.span("mass"), strict=True)):
            load = arb(mass) * self.gravity / (2 * vehicle.wheelsets)
            shaping = mass if problem.contact_grows_with_load else vehicle.mass
            ratio = arb(shaping) * self.gravity / (2 * vehicle.wheelsets) / arb(contact.reference_load)
            self.ends.append((arb(mu0), load, slope * ratio ** arb(power)))
        self.load = hull(self.ends[0][1], self.ends[-1][1])

    def loss(self, speed: float) -> Ball:
        """Speed that a sample takes off at most: creep force below (1 + 1/pi) mu0 Q."""
        grip = self.pull * self.point(self.problem.span("mu0")[1]) * (1 + 1 / self.point.pi())
        return self.sample * (self.resistance(self.point(speed)) / self.mass + grip).upper()

    def resistance(self, speed: Ball) -> Ball:
        """Resistance of the train [N]."""
        vehicle = self.problem.vehicle
        linear, square = vehicle.resistance_linear * speed, vehicle.resistance_quadratic * speed * speed
        return self.point(vehicle.resistance_constant) + linear + square

    def rate(self, slip: Ball, speed: Ball, torque: Ball) -> Ball:
        """Rate of the slip from eqs. (1)-(7), written out."""
        rail, sliding = self.problem.rail, slip * speed
        falling = (
            self.point(rail.friction_ratio)
            + (1 - self.point(rail.friction_ratio)) * (-rail.friction_decay * sliding).exp()
        )
        bounds = []
        for mu0, load, slope in self.ends:
            grip = mu0 * falling * load
            strain = slope * slip / grip
            shape = _hump(rail.adhesion_reduction * strain) + (rail.slip_reduction * strain).atan()
            bounds.append(shape * 2 * grip / self.point.pi())
        force = hull(bounds[0], bounds[-1])
        deceleration = self.resistance(speed) / self.mass + self.pull * force / self.load
        drive = self.radius * (torque / 2 - self.radius * force) / self.inertia
        return (drive - (1 - slip) * deceleration) / speed + (1 - slip) * self.damping / self.inertia

    def advance(
        self, edge: Ball, speed: Ball, torque: Ball, span: Ball, sign: int
    ) -> tuple[Ball, Ball] | None:
        """Follow a bound of the slip, above (sign 1) or below (sign -1): after a step and during it."""
        zero = self.point(0)
        guess = (sign * span * self.rate(edge, speed, torque)).upper()
        ahead, behind = guess.max(zero) * 1.3 + 1e-6, (-guess).max(zero) * 1.3
        near = hull(edge - sign * behind, edge + sign * ahead)
        move = (sign * span * self.rate(near, speed, torque)).upper()
        if not move <= ahead:
            return None
        after, during = edge + sign * move.max(-behind), edge + sign * move.max(zero)
        return (after.upper(), during.upper()) if sign > 0 else (after.lower(), during.lower())

    def torque(self, start: Ball, fill: Ball, vent: Ball, share: Ball) -> Ball:
        """Torque at a share of the sample; all arguments are thin."""
        brake, zero = self.problem.vehicle.brake, self.point(0)
        filled = share.min(fill) * self.sample
        vented = (share - fill).max(zero).min(vent) * self.sample
        peak = self.full - (self.full - start) * (-filled / brake.fill_time).exp()
        return peak * (-vented / brake.vent_time).exp()


def _hump(x: Ball) -> Ball:
    """Enclose x/(1 + x^2), which rises up to x = 1 and falls from there."""
    low, high = x.lower(), x.upper()
    ends = hull(low / (1 + low * low), high / (1 + high * high))
    if low >= 1 or (low >= -1 and high <= 1):
        return ends
    return hull(ends, type(low)(0.5)) if low >= 0 else x / (1 + x * x)
