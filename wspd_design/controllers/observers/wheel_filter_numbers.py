"""The numbers of the filter on the wheels, with the rules that they follow."""

from dataclasses import dataclass

from wspd_design.controllers.observers.sensors import Sensors


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelFilterNumbers:
    """What the filter trusts, when it looks, and how it recognizes a wheel that adheres."""

    # what it trusts
    rim_noise: float = 0.05  # m/s rms of a rim speed: 100 pulses a turn, timed, or a worse sensor
    scale_deviation: float = 0.2  # -, of the torque scale: pads within 25 %, mass within 20 %, evenly spread
    scale_walk: float = 0.02  # 1/sqrt(s), by which that scale changes
    torque_noise: float = 0.02  # sqrt(s), share of the deceleration by the torques that they do not explain
    force_noise: float = 0.03  # m/s2 sqrt(s), what they do not explain while there are none
    acceleration_noise: float = 0.15  # m/s2 rms of the accelerometer
    bias_deviation: float = 0.03  # m/s2, of its bias: within .05, evenly spread
    bias_walk: float = 0.003  # m/s2/sqrt(s), by which bias and grade change
    grade_deviation: float = 0.03  # m/s2, of gravity along the track: within 5 per mille, evenly spread
    creep_factor: float = 0.6  # -, kA + kS of the micro-slip: that of a wet rail and a half more
    creep_deviation: float = 0.5  # -, share of the micro-slip that is not known
    unknown_creep: float = (
        0.002  # -, further slip of a braked wheel near the limit of a rail that is not known
    )
    creep_time: float = 2.0  # s, for which its error stays the same
    # when it looks
    release_share: float = (
        0.4  # of the slip speed, deviation of the train speed beyond which a wheelset is released
    )
    lost_share: float = 0.4  # of its usual value, friction torque below which the brake is lost
    usual_time: float = 1.0  # s, over which a friction torque is usual
    pause: float = 0.3  # s between two releases
    give_up_time: float = 4.0  # s, after which another wheelset has to show the speed
    least_speed: float = 3.0  # m/s, below it no wheelset is released: the stop is over before it has rolled
    hold_time: float = 0.06  # s, for which a wheelset that was found to adhere shows the speed
    # how it recognizes a wheel that adheres
    rim_rate: float = 15.0  # 1/s, of the tracking of the rims
    quiet_share: float = 0.2  # of the acceleration with which a free wheel spins up: quiet below it
    least_quiet: float = 0.3  # m/s2, at least, since noise is not quieter
    largest_quiet: float = 1.2  # m/s2, at most
    quiet_time: float = 0.06  # s, for which it is quiet after it spun up
    rise_share: float = 0.35  # of the slip speed, by which it spun up
    light_share: float = 0.7  # of its friction torque when it was released, below which a wheel is light
    light_time: float = 0.2  # s, for which it is quiet and light
    surprise_gate: float = (
        5.0  # deviations below the expected speed, beyond which it has not reached the train
    )
    torque_time: float = 0.15  # s, over which the noise of a friction torque averages out
    idle_adhesion: float = 0.008  # -, below that which every rail gives: no wheel slides on less
    idle_time: float = 0.5  # s, for which a wheel is idle or quiet before that alone says that it adheres
    # how it sees that a wheel slides
    gate: float = 3.0  # deviations of a rim speed below the expected one
    gate_share: float = 0.1  # of the slip speed, most that an uncertain train speed adds to them
    lapse_share: float = 0.5  # of the usual friction torque: above it a wheel slides if others do
    doubt_share: float = (
        0.25  # of the square of what it is slower, variance that the train speed gets from it
    )
    bound_gate: float = 2.0  # deviations of a rim speed above the train speed
    alike_share: float = 0.3  # of the slip speed, by which a wheel that adheres differs at most


def numbers_for(sample_time: float, sensors: Sensors) -> WheelFilterNumbers:
    """Return the numbers for a sample time and sensors.

    Parameters
    ----------
    sample_time : float
        Of the protection [s].
    sensors : Sensors
        What the vehicle has.
    """
    slow = sample_time > 0.05  # few samples: steadier tracking, longer looks
    # An accelerometer leaves fewer looks to pay for.
    quick, late = (0.3, 0.35) if sensors.accelerometer else (0.55, 0.5)
    # Without one the scale of the torques decides, which only wheels can teach: they have to be trusted more, and until
    # a look has confirmed what they say, the scale less.
    alone = not sensors.accelerometer
    return WheelFilterNumbers(
        release_share=late if slow else quick,
        scale_deviation=0.3 if alone else 0.2,
        unknown_creep=0.0005 if alone else 0.002,
        doubt_share=0.5 if alone else 0.0,
        rim_rate=12.0 if slow else 15.0,
        largest_quiet=1.0 if slow else 1.2,
        hold_time=0.1 if slow else 0.06,
        light_time=max(0.2, 3.0 * sample_time),  # noise of the friction torque alone does not last so long
        scale_walk=0.03 if sensors.pressures else 0.05,  # a model of the valve is wrong by more than a scale
    )
