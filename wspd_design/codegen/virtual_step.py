"""One integration step of the closed loop in CasADi.

The formulas are those of ``motion.c``, ``adhering.c``, ``steps.c`` and ``events.c`` in ``templates/``. Steps beyond
the goal, and one that would go across an event, leave the state as it is, so that a call may hold more steps than are
needed.
"""

from typing import Any

from wspd_design.codegen.kernels import Kernels
from wspd_design.codegen.plant_numbers import PARAMETERS
from wspd_design.codegen.virtual_adhering import STEADY, Adhering, Stage, settling_rates, weighted_sum
from wspd_design.codegen.virtual_layout import INTEGRATED, Layout
from wspd_design.model.number import maximum, minimum, where

RADIUS = PARAMETERS.index(("vehicle", "wheel_radius"))
INERTIA = PARAMETERS.index(("vehicle", "wheelset_inertia"))
MASS = PARAMETERS.index(("vehicle", "mass"))
BALANCED = 1e-10  # relative: torques that differ by less are equal
SPEED_SHARE = 0.1  # of the speed, that a step may take from it where the slope limit is one
EVENT_SHARE = 1e-4  # of a step: none is cut shorter at an event of a wheel


class Step:
    """The expressions of one step of a plant that splits."""

    def __init__(
        self, kernels: Kernels, places: Layout, state: Any, given: Any, *, holding: bool = False
    ) -> None:
        self.kernels, self.holding, self.axles = kernels, holding, places.axles
        self.whole, self.places = state, places
        self.state = {name: state[place] for name, place in places.state.items()}
        self.given = {name: given[place] for name, place in places.given.items()}

    def per_axle(self, name: str, axle: int) -> Any:
        """Constants of one axle."""
        values = self.given[name]
        size = values.size1() // self.axles
        return values[axle * size : (axle + 1) * size]

    def motion(self, state: dict[str, Any]) -> Any:
        """Put together what is integrated with stages."""
        import casadi as ca

        return ca.vertcat(*(state[name] for name in ("speed", "axle", "rest", "distance")))

    def observed(self) -> Any:
        """The state with the present stage worked out anew."""
        import casadi as ca

        return ca.vertcat(*self._observe(dict(self.state)).values())

    def outputs(self) -> list[Any]:
        """The state after the step, and a row with what follows it."""
        import casadi as ca

        now, given, axles = self.state, self.given, self.axles
        integrated = INTEGRATED * axles
        h, following, settling = self._length()
        middle = now["time"] + 0.5 * h
        pressure, torque, filled, damping, level = self._actuators(middle, following)
        motion = self.motion(now)
        present = Stage(
            motion,
            now["torque"],
            *(now[name] for name in Stage._fields[2:]),
        )
        stages = [present]
        wheels = self._wheels(motion, h, settling)
        for share, column, time in ((0.5, 0, middle), (0.5, 0, middle), (1.0, 1, following)):
            at = wheels.placed(motion + share * h * stages[-1].rates, wheels.moved(stages))
            stages.append(self._stage(at, time, torque[column], level[column], damping[column], now))
        reached, totals = (
            h / 6.0 * weighted_sum(parts)
            for parts in ([stage.rates for stage in stages], [stage.integrands for stage in stages])
        )
        reached += motion
        reached = wheels.ended(stages, reached)
        share = self._before_event(stages, reached)
        lane, stop = totals[:integrated], totals[integrated:]
        judged = where(now["speed"] > given["judging_speed"], 1.0, 0.0)
        speed, wheel = reached[0], reached[1 : 1 + axles]
        wheel, locked, held, lost = self._settled(speed, wheel)
        lock_time, most, judged_lock, longest = ca.vertsplit(now["lane"][integrated:], axles)
        locked_for = judged * now["locked"] * h
        length = where(now["locked"], now["lock_length"] + locked_for, 0.0)
        after = dict(now)
        after |= {
            "speed": speed,
            "axle": ca.vertcat(wheel, reached[1 + axles : 1 + now["axle"].size1()]),
            "rest": reached[1 + now["axle"].size1() : -1],
            "distance": reached[-1],
            "locked": locked,
            "held": held,
            "lock_length": length,
            "pressure": pressure,
            "torque": torque[1],
            "level": level[1],
            "filled": filled,
            "damping": damping[1],
            "time": following,
        }
        after = self._observe(after)
        after["lane"] = ca.vertcat(
            now["lane"][:axles] + lane[:axles] + lost,
            now["lane"][axles : 5 * axles] + lane[axles : 5 * axles],
            now["lane"][5 * axles : 7 * axles] + judged * lane[5 * axles : 7 * axles],
            now["lane"][7 * axles : integrated] + lane[7 * axles :],
            lock_time + now["locked"] * h,
            where(speed > given["judging_speed"], maximum(most, after["slip"]), most),
            judged_lock + locked_for,
            maximum(longest, length),
        )
        after["stop"] = ca.vertcat(reached[-1], now["stop"][1:] + ca.vertcat(stop, judged * h, h))
        made = where(given["last_cut"], 1.0, where(following > now["time"], share >= 1.0, 0.0))
        made = where(now["speed"] > given["stop_speed"] * (1.0 + 1e-6), made, 0.0)
        row = ca.vertcat(
            *(
                after["stop"][4],
                speed,
                after["stop"][0],
                wheel,
                after["slip"],
                after["passed"],
                after["load"],
            ),
            *(after["given"], after["dynamic"], after["axle"][axles:], after["further"]),
            *(made, share, after["lane"][(INTEGRATED - 1) * axles : integrated]),
        )
        return [where(made, ca.vertcat(*after.values()), self.whole), row]

    def _length(self) -> tuple[Any, Any, Any]:
        """Length of the step, the time after it, and the rates of wheels that may take it exponentially."""
        import casadi as ca

        given, time = self.given, self.state["time"]
        span = given["until"] - time
        allowed, settling = self._allowed(span)
        count = ca.ceil(span / minimum(allowed, given["longest_step"]) * (1.0 - 1e-12))
        h = minimum(where(count > 1.0, span / maximum(count, 1.0), span), given["soonest"])
        last = time + h > given["until"] - 1e-12
        h = where(last, span, h) * given["scale"]
        return h, where(last, where(given["scale"] < 1.0, time + h, given["until"]), time + h), settling

    def _wheels(self, motion: Any, h: Any, settling: Any) -> Any:
        """What becomes of wheels that adhere within the step."""
        return Adhering(motion, h, settling, self.given)

    def _allowed(self, span: Any) -> tuple[Any, Any]:
        """Step that the slopes of the creep curves allow, now and where the wheels would be after a step.

        And the rates of settling of the wheels that adhere, zero for the others.
        """
        now, given, axles = self.state, self.given, self.axles
        speed, wheels, acceleration = now["speed"], now["axle"][:axles], now["rates"][0]
        slowest = maximum(speed, given["regularization_speed"])
        allowed = slowest * (given["slope_limit"] / given["creep_rate"])
        later = maximum(speed + given["longest_step"] * acceleration, given["regularization_speed"])
        rolling = later / given["radius"]
        slope = self._slopes(speed, now["axle"])
        bound = allowed < minimum(span, given["longest_step"])
        settling = where(bound, self._settling(slope), 0.0)
        steep = abs(slope)
        moved = wheels + self._limited(steep) * now["rates"][1 : 1 + axles]
        side = where(speed > given["radius"] * wheels, 1.0, -1.0)
        states = now["axle"] + 0.0
        moved = where(side * (rolling - moved) > 0.0, moved, rolling)
        states[:axles] = where(settling < 0.0, wheels * (later / speed), moved)
        ahead = abs(self._slopes(later, states))
        settling = where(abs(ahead - steep) < STEADY * steep, settling, 0.0)
        free = where(now["locked"] + now["held"] + (settling < 0.0), 0.0, 1.0)
        limits = self._limited(free * maximum(steep, ahead))
        most, braking = SPEED_SHARE * given["slope_limit"] * speed, abs(acceleration)
        braked = given["longest_step"] * braking > most
        least = where(braked, most / where(braked, braking, 1.0), given["longest_step"])
        for axle in range(axles):
            least = minimum(least, limits[axle])
        return where(bound, maximum(least, allowed), allowed), settling

    def _settling(self, slope: Any) -> Any:
        return settling_rates(self.state, self.given, slope)

    def _limited(self, steep: Any) -> Any:
        limit, longest = self.given["slope_limit"], self.given["longest_step"]
        bound = longest * steep > limit
        return where(bound, limit / where(bound, steep, 1.0), longest)

    def _slopes(self, speed: Any, states: Any) -> Any:
        """Slopes of the wheels' accelerations over their speeds under the present loads."""
        import casadi as ca

        now = self.state
        return ca.vertcat(
            *(
                self.kernels.slope(
                    self.per_axle("lane_constants", a),
                    speed,
                    states[a :: self.axles],
                    now["load"][a],
                    now["contact"][a :: self.axles],
                    now["damping"][a],
                )
                for a in range(self.axles)
            )
        )

    def _actuators(self, middle: Any, end: Any) -> tuple[Any, Any, Any, Any, Any]:
        """Pressure at the end, torque at both times, pressure without venting at the end, damping and level at both."""
        import casadi as ca

        half, full = (
            [
                ca.vertcat(*column)
                for column in zip(
                    *(
                        self.kernels.actuator(self.per_axle("window_constants", axle), time)
                        for axle in range(self.axles)
                    ),
                    strict=True,
                )
            ]
            for time in (middle, end)
        )
        return full[0], (half[1], full[1]), full[2], (half[3], full[3]), (half[4], full[4])

    def _loads(self, motion: Any) -> Any:
        """Wheel loads of the axles: those of the plant times the table, which is straight up to its next point."""
        first = 1 + self.kernels.axle_states * self.axles
        table = self.given["load_factors"]
        here, rise = table[1 : 1 + self.axles], table[1 + self.axles :]
        loads = self.kernels.split.loads(self.given["stop_constants"], motion[first:-1])
        return loads * (here + rise * (motion[-1] - table[0]))

    def _observe(self, state: dict[str, Any]) -> dict[str, Any]:
        """Work out the present stage; wheels whose brake gives less than rail or slip take are let go."""
        import casadi as ca

        motion, torque = self.motion(state), state["torque"]
        load = self._loads(motion)
        begins = [
            self.kernels.split.contact(self.per_axle("lane_constants", a), load[a]) for a in range(self.axles)
        ]
        state = {**state, "contact": ca.reshape(ca.horzcat(*begins).T, -1, 1)}
        for _ in range(2):
            stage = self._stage(motion, state["time"], torque, state["level"], state["damping"], state)
            lacks = stage.given * (1.0 - BALANCED) < stage.passed
            state |= {name: where(lacks, 0.0, state[name]) for name in ("locked", "held")}
        return {
            **state,
            **{name: getattr(stage, name) for name in Stage._fields if name in state},
            "torque": torque,
        }

    def _stage(
        self, motion: Any, time: Any, torque: Any, level: Any, damping: Any, state: dict[str, Any]
    ) -> Stage:
        """Everything at one moment; locks, holds and contact are those of the state."""
        import casadi as ca

        given, size = self.given, self.kernels.axle_states * self.axles
        speed, states, rest = motion[0], motion[1 : 1 + size], motion[1 + size : -1]
        wheel, radius, load = states[: self.axles], given["radius"], self._loads(motion)
        axles = [
            self.kernels.split.axle(
                self.per_axle("lane_constants", a),
                speed,
                states[a :: self.axles],
                load[a],
                torque[a],
                level[a],
                state["locked"][a],
                state["contact"][a :: self.axles],
                damping[a],
            )
            for a in range(self.axles)
        ]
        force, rolling, slip, damped, passed, braking, dynamic = (
            # Element by element, each for all axles, as the state has them.
            ca.reshape(ca.horzcat(*column).T, -1, 1)
            for column in zip(*axles, strict=True)
        )
        rolling, others = rolling[: self.axles], rolling[self.axles :]
        acceleration, resistance, rest_rates = self.kernels.split.train(
            given["stop_constants"], speed, force, rest, time
        )
        if self.holding:
            held_slip, slope = self._held_slip(speed)
            following = acceleration / radius * (1.0 - held_slip - speed * slope)
            taken = 2.0 * (radius * force - damped) - given["inertia"] * following
            rolling = where(state["held"], following, rolling)
            passed = where(state["held"], taken, passed)
        return Stage(
            motion=motion,
            torque=torque,
            rates=ca.vertcat(acceleration, rolling, others, rest_rates, speed),
            integrands=self._integrands(speed, wheel, passed, damped, force, slip, resistance),
            force=force,
            slip=slip,
            load=load,
            passed=passed,
            given=braking,
            dynamic=dynamic,
            further=ca.SX(0, 1),
        )

    def _integrands(
        self, speed: Any, wheel: Any, passed: Any, damped: Any, force: Any, slip: Any, resistance: Any
    ) -> Any:
        """What the totals of wheelsets and stop are integrals of."""
        import casadi as ca

        return ca.vertcat(
            passed,
            2.0 * damped,
            passed * wheel,
            2.0 * force * (speed - self.given["radius"] * wheel),
            2.0 * damped * wheel,
            slip,
            slip * slip,
            wheel,
            resistance,
            resistance * speed,
        )

    def _held_slip(self, speed: Any) -> tuple[Any, Any]:
        """The slip to be held at a speed, and its slope over speed."""
        import casadi as ca

        first, spacing, k = (self.given["hold"][i] for i in range(3))
        further, below, here, above = (
            self.given["hold"][3 + i * self.axles : 3 + (i + 1) * self.axles] for i in range(4)
        )
        beyond = (ca.log(speed) - first) / spacing - k
        far = beyond < -1.0
        rise = where(beyond >= 0.0, above - here, where(far, below - further, here - below))
        return where(far, below + (beyond + 1.0) * rise, here + beyond * rise), rise / (spacing * speed)

    def _rolling(self, speed: Any) -> Any:
        """Wheel speeds below which wheels are caught: locked, or held at a slip."""
        if not self.holding:
            return 0.0 * self.given["radius"]
        return speed * (1.0 - self._held_slip(speed)[0]) / self.given["radius"]

    def _before_event(self, stages: list[Stage], reached: Any) -> Any:
        """Share of the step up to its first event."""
        import casadi as ca

        now, given, axles = self.state, self.given, self.axles
        judging = given["judging_speed"]
        target = where(now["speed"] > judging, judging, given["stop_speed"])
        ends = (stages[0].motion, stages[2].motion, reached)
        values = [
            ca.vertcat(
                motion[0] - target,
                where(
                    now["locked"] + now["held"],
                    stage.given - stage.passed,
                    motion[1 : 1 + axles] - self._rolling(motion[0]),
                ),
            )
            for motion, stage in zip(ends, (stages[0], stages[2], stages[3]), strict=True)
        ]
        first: Any = 1.0
        for event in range(1 + axles):
            begin, middle, end = (value[event] for value in values)
            crosses = where(begin > 0.0, minimum(middle, end) < 0.0, 0.0)
            share = maximum(_crossing(where(crosses, begin, 1.0), middle, end), EVENT_SHARE if event else 0.0)
            first = where(crosses, minimum(first, share), first)
        return where(first < 1.0 - 1e-6, first, 1.0)

    def _settled(self, speed: Any, wheel: Any) -> tuple[Any, Any, Any, Any]:
        """Wheel speeds, locks and holds after the step, and the impulse that the brake could not pass on."""
        inertia, held = self.given["inertia"], self.state["held"]
        below = where(self.state["locked"], 0.0, minimum(wheel, 0.0))  # a locked wheel may follow its pads
        locked = where(below < 0.0, 1.0, self.state["locked"])
        wheel, lost = wheel - below, inertia * below
        if not self.holding:
            return wheel, locked, held, lost
        rolling = self._rolling(speed)
        on_it = where(held, 1.0, where(locked, 0.0, wheel <= rolling))  # a held wheel is put back on its slip
        lost += where(on_it, inertia * (wheel - rolling), 0.0)
        return where(on_it, rolling, wheel), where(on_it, 0.0, locked), on_it, lost


def _crossing(begin: Any, middle: Any, end: Any) -> Any:
    """Share of a step after which a positive quantity gets below zero, from three of its values."""
    import casadi as ca

    bend, fall = 2.0 * (begin - 2.0 * middle + end), 3.0 * begin - 4.0 * middle + end
    return 2.0 * begin / (fall + ca.sqrt(maximum(fall * fall - 4.0 * bend * begin, 0.0))) + 1e-9
