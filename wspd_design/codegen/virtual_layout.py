"""Places of state and inputs in the vectors of a step in CasADi's virtual machine."""

from dataclasses import dataclass
from itertools import accumulate

from wspd_design.codegen.kernels import Kernels

INTEGRATED = 8  # totals of a lane that are integrals; those of locks and the largest slip follow


def _places(sizes: dict[str, int]) -> dict[str, slice]:
    ends = list(accumulate(sizes.values()))
    return {name: slice(end - size, end) for (name, size), end in zip(sizes.items(), ends, strict=True)}


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """Places of everything in the vectors of a step."""

    axles: int
    axle_states: int
    further: int  # numbers of the further traces
    state: dict[str, slice]
    given: dict[str, slice]  # what a step needs beside the state

    @property
    def states(self) -> int:
        """Length of the state."""
        return int(self.state["stop"].stop)

    @property
    def inputs(self) -> int:
        """Length of what a step needs beside the state."""
        return int(self.given["hold"].stop)

    @property
    def row(self) -> int:
        """Length of a row of the trace.

        After it come whether the step was made, the share of it before its first event, and the angles that the wheels
        have turned.
        """
        return 3 + (5 + self.axle_states) * self.axles + self.further


def layout(kernels: Kernels) -> Layout:
    """Lay out the vectors for the numbers of axles and states of a plant."""
    axles = kernels.axles
    constants = {
        name: getattr(kernels, name).size1_out(0)
        for name in ("lane_constants", "stop_constants", "window_constants")
    }
    constants["vehicle_constants"] = kernels.whole.vehicle_constants.size1_out(0) if kernels.coupled else 0
    further = kernels.whole.further if kernels.coupled else 0
    return Layout(
        axles=axles,
        axle_states=kernels.axle_states,
        further=further,
        state=_places(
            {
                "speed": 1,
                "axle": kernels.axle_states * axles,  # first the wheel speeds
                "rest": kernels.rest_states,
                "distance": 1,
                "locked": axles,
                "held": axles,
                "lock_length": axles,
                "pressure": axles,
                "torque": axles,
                "level": axles,
                "filled": axles,
                "damping": axles,
                "time": 1,
                "rates": 2 + kernels.axle_states * axles + kernels.rest_states,  # the present stage
                "integrands": INTEGRATED * axles + 2,
                "force": axles,
                "slip": axles,
                "load": axles,
                "passed": axles,
                "given": axles,
                "dynamic": axles,
                "further": further,
                "contact": 2 * axles,
                "lane": (INTEGRATED + 4) * axles,
                "stop": 5,  # distance, impulse and work of the resistance, judged time, time
            }
        ),
        given=_places(
            {
                "lane_constants": constants["lane_constants"] * axles,
                "stop_constants": constants["stop_constants"],
                "vehicle_constants": constants["vehicle_constants"],
                "window_constants": constants["window_constants"] * axles,
                "radius": axles,
                "offset": axles,
                "inertia": axles,
                "mass": 1,
                "until": 1,
                "scale": 1,  # share of a step up to its first event
                "last_cut": 1,
                "soonest": 1,  # time to the next change of rail or loads
                "longest_step": 1,
                "creep_rate": 1,
                "slope_limit": 1,
                "regularization_speed": 1,
                "stop_speed": 1,
                "judging_speed": 1,
                "load_factors": 1
                + 2 * axles,  # a place, relative loads there, and their slopes over distance
                # First point, spacing and place of the table; slip there and beside it.
                "hold": 3 + 4 * axles,
            }
        ),
    )
