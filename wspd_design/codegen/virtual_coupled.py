"""One integration step of a coupled plant in CasADi; the formulas are those under ``COUPLED`` in ``templates/``."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from wspd_design.codegen.kernels import Kernels
from wspd_design.codegen.virtual_adhering import Stage
from wspd_design.codegen.virtual_layout import Layout
from wspd_design.codegen.virtual_step import BALANCED, Step
from wspd_design.model.number import maximum, where
from wspd_design.plants.protocol import TRACK_CHANNELS


class TrackTable(NamedTuple):
    """Shape of the table of the track."""

    points: int
    again: int  # point that comes after the last one
    spacing: float  # m

    @property
    def numbers(self) -> int:
        """Length of the table: value and slope of each channel at each point."""
        return self.points * 2 * len(TRACK_CHANNELS)


class CoupledStep(Step):
    """The expressions of one step, with one call of the vehicle for each stage."""

    def __init__(
        self,
        kernels: Kernels,
        places: Layout,
        state: Any,
        given: Any,
        *,
        table: Any,
        track: TrackTable | None,
    ) -> None:
        super().__init__(kernels, places, state, given)
        self.table, self.track = table, track

    def _settling(self, slope: Any) -> Any:
        return 0.0 * slope

    def _wheels(self, motion: Any, h: Any, settling: Any) -> "_Classical":  # noqa: ARG002
        return _Classical()

    def _observe(self, state: dict[str, Any]) -> dict[str, Any]:
        import casadi as ca

        names = [name for name in Stage._fields if name in state]

        def worked_out(locked: Any) -> Any:
            stage = self._stage(
                self.motion(state),
                state["time"],
                state["torque"],
                state["level"],
                state["damping"],
                {**state, "locked": locked},
            )
            return ca.vertcat(*(getattr(stage, name) for name in names))

        def split(values: Any) -> dict[str, Any]:
            ends = [0]
            for name in names:
                ends.append(ends[-1] + state[name].size1())
            return {name: values[a:b] for name, a, b in zip(names, ends, ends[1:], strict=False)}

        values = worked_out(state["locked"])
        first = split(values)
        lacks = first["given"] * (1.0 - BALANCED) < first["passed"]
        locked = where(lacks, 0.0, state["locked"])
        released = ca.sum1(state["locked"]) > ca.sum1(locked)
        again = ca.if_else(released, worked_out(locked), values, True)  # worked out where it is needed
        return {**state, **split(again), "locked": locked, "torque": state["torque"]}

    def _stage(
        self, motion: Any, time: Any, torque: Any, level: Any, damping: Any, state: dict[str, Any]
    ) -> Stage:
        import casadi as ca

        given, whole, size = self.given, self.kernels.whole, self.kernels.axle_states * self.axles
        speed, states, rest = motion[0], motion[1 : 1 + size], motion[1 + size : -1]
        wheels = states[: self.axles]
        braked = [
            whole.brakes(self.per_axle("lane_constants", a), states[a :: self.axles], torque[a], level[a])
            for a in range(self.axles)
        ]
        braking, dynamic, warming = (
            ca.reshape(ca.horzcat(*column).T, -1, 1) for column in zip(*braked, strict=True)
        )
        acceleration, rolling, rest_rates, force, slip, damped, passed, load, resistance, further = (
            whole.vehicle(
                *(given["vehicle_constants"], speed, wheels, rest, braking, state["locked"]),
                *(damping, self._track(motion[-1]), time),
            )
        )
        return Stage(
            motion=motion,
            torque=torque,
            rates=ca.vertcat(acceleration, rolling, warming, rest_rates, speed),
            integrands=self._integrands(speed, wheels, passed, damped, force, slip, resistance),
            force=force,
            slip=slip,
            load=load,
            passed=passed,
            given=braking,
            dynamic=dynamic,
            further=further,
        )

    def _track(self, distance: Any) -> Any:
        """Irregularities below the wheelsets: cubic between the points of the table."""
        import casadi as ca

        track, channels = self.track, len(TRACK_CHANNELS)
        if track is None:
            return ca.DM.zeros(channels * self.axles)
        h, points, again = track.spacing, track.points, track.again
        place = maximum((distance - self.given["offset"]) / h, 0.0)
        point = ca.floor(place)
        x, y = place - point, 1.0 - (place - point)
        point = where(point >= points, again + ca.fmod(point - again, points - again), point)
        following = where(point + 1.0 < points, point + 1.0, again)
        rows = []
        for channel in range(channels):
            low, low_slope, high, high_slope = (
                self.table.nz[at * (2 * channels) + 2 * channel + place]
                for at in (point, following)
                for place in (0, 1)
            )
            rows.append(
                y * y * ((1.0 + 2.0 * x) * low + h * x * low_slope)
                + x * x * ((1.0 + 2.0 * y) * high - h * y * high_slope)
            )
        return ca.vertcat(*rows)


class _Classical:
    """All wheels take the classical stages."""

    def moved(self, stages: Sequence[Stage]) -> None:
        """Nothing moves in another way."""

    def placed(self, motion: Any, moved: None) -> Any:  # noqa: ARG002
        return motion

    def ended(self, stages: Sequence[Stage], reached: Any) -> Any:  # noqa: ARG002
        return reached
