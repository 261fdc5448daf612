"""When the wheelsets of a stop are locked, from its traces."""

from typing import TYPE_CHECKING

from wspd_design.simulation.runs import Run

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

FOLLOWING = 0.98  # -, slip from which on a wheelset that follows the pads in a moving frame counts as locked


def locked(run: Run) -> "NDArray[np.bool_]":
    """Tell for each time and wheelset whether the wheels stand.

    On a coupled plant the disc of a locked wheelset stands still between pads that move with the frame, so that it
    turns a little to and fro.
    """
    import numpy as np

    stands = run.wheel_speed <= 0.0
    return np.asarray(stands | (run.slip >= FOLLOWING) if run.further else stands)
