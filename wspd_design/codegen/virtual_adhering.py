"""Exponential steps of wheels that adhere, in CasADi; the formulas are those of ``templates/adhering.c``."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from wspd_design.model.number import where

SETTLED = 1e-3  # relative: a sliding speed that is off its balance by no more has settled
STEADY = 0.3  # relative: change of a rate of settling within a step, at most
FAST = 1.0  # step times rate of settling, from which on a step is exponential


class Stage(NamedTuple):
    """Everything at one moment of a step."""

    motion: Any
    torque: Any
    rates: Any  # of the motion
    integrands: Any  # of the totals of lanes and stop
    force: Any
    slip: Any
    load: Any
    passed: Any
    given: Any  # torque of all brakes
    dynamic: Any  # of these that of the electrodynamic brake
    further: Any  # numbers of the further traces


class Adhering:
    """Exponential steps of wheels that adhere, as in ``adhering.c``."""

    def __init__(self, motion: Any, h: Any, settling: Any, given: Mapping[str, Any]) -> None:
        import casadi as ca

        self.radius, self.inertia, self.mass = (given[name] for name in ("radius", "inertia", "mass"))
        self.axles, self.motion, self.step = self.radius.size1(), motion, h
        z = h * settling
        self.fast = z < -FAST
        self.rate = where(self.fast, settling, 0.0)
        z = where(self.fast, z, -FAST)
        self.sliding = self._sliding(motion)
        self.decay = ca.exp(0.5 * z)
        whole = self.decay * self.decay
        one = (whole - 1.0) / z
        two = (one - 1.0) / z
        three = (two - 0.5) / z  # the functions phi
        self.half = h * (self.decay - 1.0) / z
        self.first, self.middle = h * (one - 3.0 * two + 4.0 * three), h * 2.0 * (two - 2.0 * three)
        self.last = h * (4.0 * three - two)

    def _sliding(self, motion: Any) -> Any:
        return motion[0] - self.radius * motion[1 : 1 + self.axles]

    def moved(self, stages: Sequence[Stage]) -> Any:
        """Change of the sliding speeds since the beginning of the step, by so many stages."""
        rest = [
            stage.rates[0]
            - self.radius * stage.rates[1 : 1 + self.axles]
            - self.rate * (self._sliding(stage.motion) - self.sliding)
            for stage in stages
        ]
        if len(rest) < 3:
            return self.half * rest[-1]
        if len(rest) == 3:
            return self.half * (self.decay * rest[0] + 2.0 * rest[2] - rest[0])
        return self.first * rest[0] + self.middle * (rest[1] + rest[2]) + self.last * rest[3]

    def placed(self, motion: Any, moved: Any) -> Any:
        """The motion with such wheels where their sliding speed has moved to."""
        wheels = motion[1 : 1 + self.axles]
        motion[1 : 1 + self.axles] = where(
            self.fast, (motion[0] - self.sliding - moved) / self.radius, wheels
        )
        return motion

    def ended(self, stages: Sequence[Stage], reached: Any) -> Any:
        """The end of the step: the train put right by the impulse of such wheels, and they where they have moved to."""
        part, turning = self.step / 6.0, self.inertia / (self.radius * self.radius)
        moved, axles = self.moved(stages), self.axles
        forced = part * weighted_sum([stage.force for stage in stages])
        taken = part * weighted_sum(
            [stage.integrands[:axles] + stage.integrands[axles : 2 * axles] for stage in stages]
        )
        impulse = taken / self.radius + turning * (reached[0] - self.motion[0] - moved)
        more, whole = 0.0, self.mass
        for axle in range(axles):
            more += where(self.fast[axle], 2.0 * forced[axle] - impulse[axle], 0.0)
            whole += where(self.fast[axle], turning[axle], 0.0)
        reached[0] += more / whole
        return self.placed(reached, moved)


def settling_rates(now: Mapping[str, Any], given: Mapping[str, Any], slope: Any) -> Any:
    """Rates at which the sliding speeds of wheels settle that adhere and have settled; zero for the others."""
    radius = given["radius"]
    axles = radius.size1()
    rate = slope * (1.0 + axles * given["inertia"] / (given["mass"] * radius * radius))
    change = now["rates"][0] - radius * now["rates"][1 : 1 + axles]
    calm = abs(change) < SETTLED * abs(rate * (now["speed"] - radius * now["axle"][:axles]))
    calm = where(now["locked"] + now["held"], 0.0, calm)
    return where(calm, where(rate < 0.0, rate, 0.0), 0.0)


def weighted_sum(four: list[Any]) -> Any:
    """Weighted sum of the four stages."""
    return (four[0] + four[3]) + 2.0 * (four[1] + four[2])
