"""What the law of a vehicle remembers along a stop, by the names of its memory."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.codegen.loop_numbers import DISTANCE_TOLERANCE, ERROR_SPEED
from wspd_design.controllers.protocol import TRAIN_SPEED, slip_reference_name
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.runs import Run

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from wspd_design.simulation.runs import Trace

_RELEASED = "released_{}"  # 1 while a wheelset is vented so that its speed shows that of the train


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedEstimate:
    """The train speed that a law goes by beside the true one, at its samples."""

    time: "Trace"  # s
    speed: "Trace"  # m/s, that the law goes by
    true_speed: "Trace"  # m/s
    distance_error: "Trace"  # m, distance from the speed of the law, less the true one
    allowed: "Trace"  # m, by which that distance may be wrong

    @property
    def error(self) -> "Trace":
        """Relative error of the speed where it is judged, NaN below [-]."""
        import numpy as np

        judged = self.true_speed > ERROR_SPEED
        found: Trace = np.where(judged, self.speed / np.where(judged, self.true_speed, 1.0) - 1.0, np.nan)
        return found


def speed_estimate(run: Run) -> SpeedEstimate | None:
    """Return the train speed that a law estimates; None for a law that is told it."""
    import numpy as np

    speed = remembered(run, TRAIN_SPEED)
    if speed is None or not speed.size:
        return None
    time = _times(run)
    run_so_far = np.interp(time, run.time, run.distance)
    steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(time)
    base, share = DISTANCE_TOLERANCE
    return SpeedEstimate(
        time=time,
        speed=speed,
        true_speed=np.interp(time, run.time, run.speed),
        distance_error=run_so_far[0] + np.concatenate([[0.0], np.cumsum(steps)]) - run_so_far,
        allowed=base + share * run_so_far,
    )


def slip_references(run: Run) -> "Trace | None":
    """Return the slip that a law holds at its samples, a column for each wheelset; None where it names none."""
    return _by_wheelset(run, slip_reference_name)


def released(run: Run) -> "NDArray[np.bool_] | None":
    """Return at which samples a law had released a wheelset to look; None for a law that never does."""
    found = _by_wheelset(run, _RELEASED.format)
    return None if found is None else found > 0.5


def releases(run: Run) -> int | None:
    """Return how often a law released a wheelset to look; None for a law that never does."""
    import numpy as np

    found = released(run)
    return None if found is None else int((np.diff(found, axis=0, prepend=False) & found).sum())


def reference_range(run: Run) -> tuple[float, float] | None:
    """Return the least and the largest slip that a law held above the judging speed [-]; None as above."""
    found = slip_references(run)
    if found is None:
        return None
    judged = found[_judged(run)]
    return (float(judged.min()), float(judged.max())) if judged.size else None


def rms_about_references(run: Run) -> float | None:
    """Root mean square of slip less reference over the samples above the judging speed [-]; None as above."""
    import numpy as np

    held = slip_references(run)
    if held is None or not _judged(run).any():
        return None
    judged, time = _judged(run), _times(run)
    braked = [axle for axle, samples in enumerate(run.axle_samples) if samples]
    off = np.array([np.interp(time, run.time, run.slip[:, axle]) - held[:, axle] for axle in braked])
    return float(np.sqrt(np.mean(off[:, judged] ** 2)))


def remembered(run: Run, name: str) -> "Trace | None":
    """Return one element of the memory of a law at its samples; None where it has no such name."""
    import numpy as np

    if name not in run.memory:
        return None
    place = run.memory.index(name)
    return np.array([sample.state[place] for sample in run.samples])


def _by_wheelset(run: Run, name: "Callable[[int], str]") -> "Trace | None":
    import numpy as np

    columns = [remembered(run, name(axle + 1)) for axle in range(run.slip.shape[1])]
    known = [each for each in columns if each is not None]
    return np.array(known).T if known and len(known) == len(columns) else None


def _times(run: Run) -> "Trace":
    import numpy as np

    return np.array([sample.time for sample in run.samples])


def _judged(run: Run) -> "NDArray[np.bool_]":
    import numpy as np

    found: NDArray[np.bool_] = np.interp(_times(run), run.time, run.speed) > JUDGING_SPEED
    return found
