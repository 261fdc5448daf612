"""Whether the law that is followed from rolling is the one that runs: both at the same points, in doubles."""

from wspd_design.certificates.kernel.checker import PRIME, element
from wspd_design.certificates.records import Problem
from wspd_design.controllers.observers.protocol import TRAIN_ACCELERATION
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.protocol import TRAIN_SPEED, VehicleMeasurement

POINTS, DIGITS = 96, 1e-9


def unlike(problem: Problem, law: Protection) -> str:
    """Say where the law that runs computes what the followed one does not enclose; empty if it does so nowhere.

    Parameters
    ----------
    problem : Problem
        Highest speed, slip and plant, with the range of the radius.
    law : Protection
        The law that runs.
    """
    import numpy as np

    from wspd_design.certificates.kernel.affine import Affine
    from wspd_design.certificates.theorems.slip_band.followed_law import decide
    from wspd_design.certificates.theorems.slip_band.followed_plant import NUMBERS, State, plant_of

    def shares(name: str) -> "np.ndarray[tuple[int], np.dtype[np.float64]]":
        return np.array([element("way in", name, k) / PRIME for k in range(POINTS)])

    full, pressure = law.valve.brake.max_torque, law.valve.brake.max_pressure
    speed = problem.speeds[1] * (0.5 + 0.5 * shares("speed"))
    supply = 0.3 + 0.7 * shares("supply")
    torque = supply * full * (0.1 + 0.8 * shares("torque"))
    innovation, change = 0.02 * (shares("innovation") - 0.5), -0.05 * shares("change")
    acceleration = -3.0 * shares("acceleration")
    # From far below to far above reference and torque, most of them close: pulses of all lengths fill and vent.
    sliding = speed * problem.slip * (1.0 + (2.0 * shares("sliding") - 1.0) ** 5)
    friction = torque * (1.0 + 0.4 * (2.0 * shares("friction") - 1.0) ** 3)
    friction += law.wheelset_inertia / law.wheel_radius * acceleration

    def form(values: "np.ndarray[tuple[int], np.dtype[np.float64]]") -> Affine:
        return Affine(values, np.zeros((POINTS, 32)), np.zeros(POINTS))

    state = State(*map(form, (speed, sliding, innovation, friction, torque, acceleration, change, supply)))
    low, high = problem.span("wheel radius")
    radii = low + (high - low) * shares("radius")
    numbers = {name: form(np.full(POINTS, problem.nominal(name))) for name in NUMBERS}
    numbers["wheel radius"] = form(radii)
    plant = plant_of(problem.vehicle, problem.rail, full, numbers, 16)
    decided = decide(law, plant, state, lambda each: each)
    for k in range(POINTS):
        radius = float(radii[k])
        scale = law.wheel_radius / radius  # of the train speed, that the law takes from rolling wheels
        wheel = (speed[k] - sliding[k]) / radius
        expected = wheel - innovation[k] / radius
        measured = VehicleMeasurement(
            speed=float(speed[k]),
            wheel_speeds=(float(wheel),) * law.wheelsets,
            torques=(float(torque[k]),) * law.wheelsets,
            healthy=(1.0,) * law.wheelsets,
            pressures=(float(torque[k] / full * pressure),) * law.wheelsets,
            acceleration=0.0,
            demand=float(supply[k]),
            reservoir=pressure,
        )
        rolling = measured._replace(wheel_speeds=(float(speed[k] / radius),) * law.wheelsets, demand=0.0)
        known = dict(zip(law.memory, law.start(rolling), strict=True))
        if abs(known["speed_scale"] - scale) > DIGITS:
            return (
                f"the law does not take the scale of the train speed from wheels of {radius:.6g} m that roll"
            )
        known |= {
            TRAIN_SPEED: float(speed[k] - change[k]) * scale,
            TRAIN_ACCELERATION: float(acceleration[k]) * scale,
        }
        for axle in range(1, law.wheelsets + 1):
            known[f"observed_speed_{axle}"] = float(expected)
            known[f"friction_torque_{axle}"] = known[f"mean_torque_{axle}"] = float(friction[k])
        after, commands = law.step(tuple(known.values()), measured)
        after_named = dict(zip(law.memory, after, strict=True))
        next_expected = after_named["observed_speed_1"] + law.sample_time / law.wheelset_inertia * (
            after_named["friction_torque_1"] - after_named["mean_torque_1"]
        )
        computed = {
            "share that fills": (decided.fill, commands[0].fill),
            "share that vents": (decided.vent, commands[0].vent),
            "observed friction": (decided.friction, after_named["friction_torque_1"]),
            "acceleration": (decided.acceleration, after_named[TRAIN_ACCELERATION] / scale),
            "innovation": (decided.innovation, -radius * next_expected),
        }
        for name, (enclosure, value) in computed.items():
            slack = DIGITS * (1.0 + abs(value))
            low, high = float(enclosure.low[k]), float(enclosure.high[k])
            if not low - slack <= value <= high + slack:
                found = f"{low:.9g} to {high:.9g}, not {value:.9g}"
                return f"the law that is followed computes another {name} than the one that runs: {found}"
    return ""
