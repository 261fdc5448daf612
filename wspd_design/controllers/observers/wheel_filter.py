"""The train speed from the wheels: a Kalman filter on the law's own friction torques, with axles released to look."""

from dataclasses import dataclass
from typing import NamedTuple

from wspd_design.controllers.observers.kalman import Belief, corrected, predicted
from wspd_design.controllers.observers.protocol import TRAIN_ACCELERATION, SpeedEstimate
from wspd_design.controllers.observers.rolling import RELEASED_DEMAND, mean_rim_speed, total
from wspd_design.controllers.protocol import TRAIN_SPEED, State, VehicleMeasurement
from wspd_design.model.number import Number, clip, exp, maximum, minimum, sqrt, where


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelFilterNumbers:
    share: float = 0.31
    hold_time: float = 0.06
    rim_noise: float = 0.05
    acceleration_noise: float = 0.15
    scale_spread: float = 0.2
    bias_spread: float = 0.03
    grade_spread: float = 0.04
    scale_walk: float = 0.05
    torque_noise: float = 0.05
    force_noise: float = 0.03
    gate: float = 3.0
    fall: float = 0.1
    bound: float = 2.0
    surprise: float = 1.0
    rate_bandwidth: float = 15.0
    quiet: float = 1.0
    quiet_time: float = 0.06
    rise: float = 0.35
    long_release: float = 1.5
    give_up: float = 4.0
    pause: float = 0.3
    lost: float = 0.4
    low_torque: float = 800.0
    low_time: float = 0.5
    creep_stiffness: float = 4.2e6
    creep_share: float = 1.0
    sure: float = 0.1
    lapse: float = 0.5
    creep_time: float = 0.5
    slowest: float = 3.0
    usual_time: float = 1.0
    quiet_share: float = 0.3
    least_quiet: float = 0.3


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelFilter:
    sample_time: float
    wheel_radius: float
    wheelsets: int
    mass: float
    inertia: float
    resistance: tuple[float, float, float]
    accelerometer: bool
    grade: bool
    numbers: WheelFilterNumbers

    @property
    def unknowns(self):
        return (TRAIN_SPEED, "torque_scale", *(("accelerometer_bias",) if self.accelerometer else ()),
                *(("grade_acceleration",) if self.grade else ()))

    @property
    def memory(self):
        n = len(self.unknowns)
        cov = [f"covariance_{i + 1}{j + 1}" for i in range(n) for j in range(i, n)]
        per = [f"{w}_{k}" for w in ("rolls", "rim_speed", "rim_rate", "rise", "quiet", "released", "held", "free")
               for k in range(1, self.wheelsets + 1)]
        return (*self.unknowns, *cov, *per, TRAIN_ACCELERATION, "release_clock", "turn", "torque_peak", "accelerometer")

    def start(self, seen):
        n = self.numbers
        v = mean_rim_speed(seen, self.wheel_radius)
        zero = 0.0 * v
        spread = [n.rim_noise, n.scale_spread]
        x = [v, 1.0 + zero]
        if self.accelerometer:
            spread.append(n.bias_spread); x.append(zero)
        if self.grade:
            spread.append(n.grade_spread); x.append(zero)
        cov = [spread[i] ** 2 + zero if i == j else zero for i in range(len(x)) for j in range(i, len(x))]
        rolling = where(seen.demand <= RELEASED_DEMAND, 1.0, 0.0)
        W = range(self.wheelsets)
        rims = [self.wheel_radius * w for w in seen.wheel_speeds]
        z = [zero for _ in W]
        return (*x, *cov, *[rolling * h for h in seen.healthy], *rims, *z, *z, *z, *z, *z, *z, zero, zero, zero, zero, seen.acceleration)

    def step(self, state, seen, friction_torques, slip_references):
        n, h, W = self.numbers, self.sample_time, range(self.wheelsets)
        m = len(self.unknowns); c = m * (m + 1) // 2; N = self.wheelsets
        belief = Belief(state[:m], state[m:m + c])
        rest = state[m + c:]
        rolls, rim, rate, rise, quiet, released, held, free0 = [rest[k * N:(k + 1) * N] for k in range(8)]
        _, clock, turn, peak, _ = rest[8 * N:]
        healthy = seen.healthy
        count = maximum(total(healthy), 1.0)
        torque = total([a * t for a, t in zip(healthy, friction_torques)]) * (N / count)
        a_F = torque / (self.wheel_radius * self.mass)
        v0 = belief.mean[0]
        a0, a1, a2 = self.resistance
        d = (a0 + a1 * v0 + a2 * v0 * v0) / self.mass
        # prediction
        slowing = belief.mean[1] * a_F + d + (belief.mean[-1] if self.grade else 0.0)
        F = [[1.0 if i == j else 0.0 for j in range(m)] for i in range(m)]
        F[0][1] = -h * a_F
        if self.grade: F[0][m - 1] = -h
        density = (n.torque_noise * a_F + n.force_noise) ** 2
        noise = [h * density, h * n.scale_walk ** 2] + [0.0] * (m - 2)
        mean = (maximum(v0 - h * slowing, 0.0), *belief.mean[1:])
        belief = predicted(belief, mean, F, noise)
        if self.accelerometer:
            row = [0.0, -a_F, 1.0] + [0.0] * (m - 3)
            z = 0.5 * (seen.acceleration + rest[-1]) - (-belief.mean[1] * a_F - d + belief.mean[2])
            belief = corrected(belief, row, z, n.acceleration_noise ** 2 + density / h, 1.0, density)
            belief = belief._replace(mean=(belief.mean[0], clip(belief.mean[1], 0.4, 2.2), *belief.mean[2:]))
        acceleration = -(belief.mean[1] * a_F + d + (belief.mean[-1] if self.grade else 0.0))
        # wheels
        theta = exp(-n.rate_bandwidth * h)
        new = {k: [] for k in ("rolls", "rim", "rate", "rise", "quiet", "released", "held", "free")}
        lam = total(slip_references) / N
        rolling_before = total(rolls)
        usual = peak + (1 - exp(-h / n.usual_time)) * (torque / N - peak)
        quiet_rate = clip(n.quiet_share * usual * self.wheel_radius / self.inertia, n.least_quiet, n.quiet)
        for i in W:
            u = self.wheel_radius * seen.wheel_speeds[i]
            ahead = rim[i] + h * rate[i]
            err = u - ahead
            rim_i = ahead + (1 - theta * theta) * err
            rate_i = rate[i] + (1 - theta) ** 2 / h * err
            delta = rate_i - acceleration
            rise_i = where(released[i] > 0.5, rise[i] + (u - self.wheel_radius * 0) - u + h * delta, 0.0)
            q_i = where(abs(delta) < quiet_rate, quiet[i] + h, 0.0)
            v = belief.mean[0]
            s = minimum(friction_torques[i] / (2 * self.wheel_radius * n.creep_stiffness), 0.03)
            unknown = (n.creep_share * s * v) ** 2
            near = n.rim_noise ** 2 + unknown
            spun = rise_i > n.rise * lam * v
            lookq = (released[i] > 0.5) * ((spun * (q_i >= n.quiet_time - 1e-9) + (clock >= n.long_release) * (q_i >= 2 * n.quiet_time)) > 0)
            free_i = where((friction_torques[i] < n.low_torque) * (abs(delta) < quiet_rate), free0[i] + h, 0.0)
            free = free_i >= n.low_time
            found = (lookq + free) > 0
            row = [1.0 - s] + [0.0] * (m - 1)
            r = u - (1 - s) * v
            P = (1 - s) ** 2 * belief.covariance[0]
            sure = sqrt(P) < n.sure * lam * v
            alike = sure * (abs(r) < minimum(2 * sqrt(P + near), 0.3 * lam * v)) * (q_i >= n.low_time)
            lapsed = (friction_torques[i] > n.lapse * usual) * (rolling_before < count - 0.5)
            was = where((found + alike) > 0, 1.0, where(lapsed, 0.0, rolls[i])) * healthy[i]
            ok = where(found, 1.0, where(r > -(n.gate * sqrt(near) + minimum(n.gate * sqrt(P), n.fall * lam * v)), 1.0, 0.0))
            roll_i = was * ok
            # bound
            shift = healthy[i] * maximum(u - v - n.bound * n.rim_noise, 0.0)
            learnt = minimum(shift, 2 * sqrt(belief.covariance[0])) / belief.covariance[0]
            belief = Belief((v + shift, *[x + c * learnt for x, c in zip(belief.mean[1:], belief.covariance[1:m])]), (belief.covariance[0] + n.surprise * shift * shift, *belief.covariance[1:]))
            # measurement
            r = u - (1 - s) * belief.mean[0]
            var = n.rim_noise ** 2 + unknown * (1 + n.creep_time / h) * maximum(rolling_before, 1.0)
            extra = where(found, 1.0, 0.0) * roll_i * maximum(r * r / (1 - s) ** 2 - 4 * (belief.covariance[0] + var), 0.0)
            belief = Belief(belief.mean, (belief.covariance[0] + extra, *belief.covariance[1:]))
            belief = corrected(belief, row, r, var, roll_i)
            held_i = where((released[i] > 0.5) * (roll_i > 0.5), n.hold_time, maximum(held[i] - h, 0.0))
            rel_i = where((roll_i > 0.5) + (clock > n.give_up) > 0, 0.0, released[i])
            for k, x in zip(new, (roll_i, rim_i, rate_i, rise_i, q_i, rel_i, held_i, free_i)):
                new[k].append(x)
        v = belief.mean[0]
        mean_torque = torque / N
        peak = usual
        looking = total(new["released"]) > 0.5
        was_looking = total(released) > 0.5
        clock = where(looking, clock + h, where(was_looking, 0.0, clock + h))
        unsure = sqrt(belief.covariance[0]) > n.share * lam * v
        lost = mean_torque < n.lost * peak
        start = ((unsure + lost) > 0) * (total(new["rolls"]) < 0.5) * (total(new["released"]) < 0.5) * (total(new["held"]) <= 0) * (v > n.slowest) * (clock > n.pause)
        rel = [where(start * (abs(turn - i) < 0.5) * (healthy[i] > 0.5), 1.0, new["released"][i]) for i in W]
        turn = where(start, where(turn > N - 1.5, 0.0, turn + 1.0), turn)
        clock = where(start, 0.0, clock)
        belief = belief._replace(mean=(maximum(belief.mean[0], 0.0), clip(belief.mean[1], 0.4, 2.2), *belief.mean[2:]))
        state = (*belief.mean, *belief.covariance, *new["rolls"], *new["rim"], *new["rate"], *new["rise"], *new["quiet"], *rel, *new["held"], *new["free"], acceleration, clock, turn, peak, seen.acceleration)
        hold = tuple(where(x > 0.0, 1.0, 0.0) for x in new["held"])
        return state, SpeedEstimate(belief.mean[0], acceleration, tuple(rel), hold)
