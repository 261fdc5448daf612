"""The whole vehicle about steady running as linear equations from brake torques and track to slips and loads."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from wspd_design.analysis.running import SteadyRunning

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Matrix = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleLinearization:
    """Deviations from steady running: x' = A x + B u, y = C x + D u, with a name for each of them.

    States are the coordinates against the car body and against rolling, then all rates, whose names end with a prime.
    Inputs are ``torque_1`` and on [N m], braking, and ``track_1`` and on, height of the track under an axle [m].
    Outputs are ``speed`` [m/s], ``wheel_speed_1`` and on [rad/s], ``slip_1`` and on [-], means of the two wheels, and
    ``load_1_left``, ``load_1_right`` and on [N].
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    a: "Matrix"
    b: "Matrix"
    c: "Matrix"
    d: "Matrix"

    def state_space(self) -> Any:
        """Return a ``control.StateSpace`` of these equations."""
        import control

        return control.ss(
            self.a,
            self.b,
            self.c,
            self.d,
            states=list(self.states),
            inputs=list(self.inputs),
            outputs=list(self.outputs),
            name="vehicle",
        )


def linearization(running: SteadyRunning) -> VehicleLinearization:
    """Return the equations of small motion of a vehicle about steady running.

    Parameters
    ----------
    running : SteadyRunning
        Rolling, or braked at a slip; its speed counts as fixed in the matrices and is a state as a deviation.
    """
    import numpy as np

    motion, axles = running.motion, len(running.slips)
    n = len(motion.coordinates)
    kept = [k for k, name in enumerate(motion.coordinates) if name not in motion.neutral]
    wheelsets = [k for k, name in enumerate(motion.coordinates) if name in motion.neutral]
    numbers = range(1, axles + 1)

    rates = np.hstack([np.zeros((n, len(kept))), np.eye(n)])
    seen = running.to_outputs[:, [*kept, *range(n, 2 * n)]]
    straight = running.to_outputs[:, 2 * n :]
    means = 0.5 * (np.eye(2 * axles)[::2] + np.eye(2 * axles)[1::2])  # of the two wheels of each axle
    return VehicleLinearization(
        states=motion.states,
        inputs=(*(f"torque_{k}" for k in numbers), *(f"track_{k}" for k in numbers)),
        outputs=(
            "speed",
            *(f"wheel_speed_{k}" for k in numbers),
            *(f"slip_{k}" for k in numbers),
            *(f"load_{k}_{side}" for k in numbers for side in ("left", "right")),
        ),
        a=motion.state_matrix(),
        b=np.vstack([np.zeros((len(kept), 2 * axles)), np.linalg.solve(motion.mass, running.from_inputs)]),
        c=np.vstack([rates[wheelsets], means @ seen[::2], seen[1::2]]),
        d=np.vstack([np.zeros((1 + axles, 2 * axles)), means @ straight[::2], straight[1::2]]),
    )
