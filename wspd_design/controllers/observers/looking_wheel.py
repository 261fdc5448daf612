"""One wheelset that may show the train speed: whether it adheres, is released to look, or is held while it shows."""

from dataclasses import dataclass
from typing import NamedTuple

from wspd_design.controllers.observers.wheel_filter_numbers import WheelFilterNumbers
from wspd_design.model.generated import wheel_filter as generated
from wspd_design.model.number import Number, exp, maximum, minimum, sqrt, where

_YES = 0.5  # flags are above it


class Wheel(NamedTuple):
    """What the filter remembers of a wheelset."""

    rolls: Number  # 1 while it adheres, so that it shows the train speed
    rim_speed: Number  # m/s, as tracked
    rim_rate: Number  # m/s2, as tracked
    steady_friction: Number  # N m, friction torque without its noise
    friction_before: Number  # N m, the same when it was released last
    risen: Number  # m/s, by which it has spun up since it was released
    quiet: Number  # s, for which it has turned as evenly as the train
    light: Number  # s, for which in addition its friction torque has fallen as that of its brake does
    idle: Number  # s, for which it has turned it with next to nothing
    vented: Number  # 1 while it is vented to look
    held: Number  # s, for which it is still held


class Around(NamedTuple):
    """What counts for every wheelset at a sample."""

    acceleration: Number  # m/s2, of the train
    slip_speed: Number  # m/s, that the law holds
    spin_up: Number  # m/s2, with which a free wheel would spin up
    usual_torque: Number  # N m, friction torque of a wheelset
    rolling: Number  # wheelsets that adhered at the last sample
    shown: Number  # 1 while a wheelset is held, because it shows the speed
    others_slide: Number  # 1 while a wheelset with a healthy sensor slides
    clock: Number  # s, since the last release began, or ended if none is on


@dataclass(frozen=True, slots=True, kw_only=True)
class Recognition:
    """How wheels that adhere are told from those that slide."""

    sample_time: float  # s
    idle_torque: float  # N m
    numbers: WheelFilterNumbers

    def tracked(self, wheel: Wheel, rim: Number) -> Wheel:
        """Track the speed of the rim."""
        pole = exp(-self.numbers.rim_rate * self.sample_time)
        speed, rate = generated.tracked_rim(rim, wheel.rim_speed, wheel.rim_rate, self.sample_time, pole)
        return wheel._replace(rim_speed=speed, rim_rate=rate)

    def timed(self, wheel: Wheel, friction_torque: Number, around: Around) -> Wheel:
        """Count how far the wheel has spun up, and how long it has been quiet and idle."""
        numbers, h = self.numbers, self.sample_time
        against_train = wheel.rim_rate - around.acceleration
        limit = numbers.quiet_share * around.spin_up
        limit = minimum(maximum(limit, numbers.least_quiet), numbers.largest_quiet)
        quiet = abs(against_train) < limit
        new = 1.0 - exp(-h / numbers.torque_time)
        friction = wheel.steady_friction + new * (friction_torque - wheel.steady_friction)
        return wheel._replace(
            steady_friction=friction,
            friction_before=where(wheel.vented > _YES, wheel.friction_before, friction),
            risen=where(wheel.vented > _YES, wheel.risen + h * against_train, 0.0),
            quiet=where(quiet, wheel.quiet + h, 0.0),
            light=where(
                quiet * (friction < numbers.light_share * wheel.friction_before), wheel.light + h, 0.0
            ),
            idle=where(quiet * (friction < self.idle_torque), wheel.idle + h, 0.0),
        )

    def found(self, wheel: Wheel, innovation: Number, spread: Number, around: Around) -> Number:
        """Tell whether a wheel that was released, or is idle, adheres now.

        A released wheel that spun up and is quiet has reached the train. So has one that is quiet while its friction
        falls with its brake, which that of a sliding wheel does not; where the rail gets worse, the wheel falls behind.
        Both are believed as far as the train speed can be wrong. A wheel at the slip that the law holds is quiet as
        well, but neither released nor idle, and the friction of one whose valve sticks does not fall.

        Parameters
        ----------
        wheel : Wheel
            After :meth:`timed`.
        innovation : number
            Rim speed less what is expected of a wheel that adheres [m/s].
        spread : number
            Variance of that expectation [m2/s2].
        around : Around
            What counts for every wheelset.
        """
        numbers = self.numbers
        late = 0.5 * self.sample_time  # times are sums of samples
        risen = wheel.risen > numbers.rise_share * around.slip_speed
        quiet_again = (wheel.quiet > numbers.quiet_time - late) * (wheel.quiet < around.clock - late)
        spun_up = risen * quiet_again
        fallen = wheel.risen < -around.slip_speed
        light = (wheel.light > numbers.light_time - late) * (fallen < _YES)
        possible = innovation > -numbers.surprise_gate * sqrt(spread + numbers.rim_noise * numbers.rim_noise)
        shows = (wheel.vented > _YES) * possible * ((spun_up + light) > 0)
        return (shows + (wheel.idle > numbers.idle_time - late)) > 0

    def adheres(
        self,
        wheel: Wheel,
        found: Number,
        *,
        innovation: Number,
        spread: Number,
        creep_variance: Number,
        friction_torque: Number,
        around: Around,
    ) -> Number:
        """Tell whether a wheel adheres, 1 or 0.

        A wheel that adhered goes on until it falls behind, or its friction torque is what makes others slide. One that
        turns as fast as another that shows the speed has begun to.

        Parameters
        ----------
        wheel : Wheel
            After :meth:`timed`.
        found : number
            Whether a release or idleness showed that it adheres.
        innovation : number
            Rim speed less what is expected of a wheel that adheres [m/s].
        spread : number
            Variance of that expectation [m2/s2].
        creep_variance : number
            Variance of the micro-slip [m2/s2].
        friction_torque : number
            Of this wheelset [N m].
        around : Around
            What counts for every wheelset.
        """
        numbers = self.numbers
        near = numbers.rim_noise * numbers.rim_noise + creep_variance
        most = numbers.gate_share * around.slip_speed
        follows = innovation > -(numbers.gate * sqrt(near) + minimum(numbers.gate * sqrt(spread), most))
        differs = minimum(2.0 * sqrt(spread + near), numbers.alike_share * around.slip_speed)
        alike = around.shown * (abs(innovation) < differs) * (wheel.quiet > numbers.idle_time)
        like_sliding = around.others_slide * (friction_torque > numbers.lapse_share * around.usual_torque)
        before = where(like_sliding, 0.0, wheel.rolls)
        return where(found, 1.0, where((alike + before) * follows > _YES, 1.0, 0.0))

    def after(self, wheel: Wheel, rolls: Number, around: Around) -> Wheel:
        """End a release with a hold once the wheel adheres, or without one after too long."""
        numbers = self.numbers
        shows = (wheel.vented > _YES) * (rolls > _YES)
        ended = ((rolls > _YES) + (around.clock > numbers.give_up_time)) > 0
        return wheel._replace(
            rolls=rolls,
            vented=where(ended, 0.0, wheel.vented),
            held=where(shows, numbers.hold_time, maximum(wheel.held - self.sample_time, 0.0)),
        )
