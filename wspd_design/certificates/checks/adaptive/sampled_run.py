"""What a run says about a function that must not rise, in numbers."""

from typing import TYPE_CHECKING

from wspd_design.certificates.checks.ideal_run import ProofRun, largest_rise

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from wspd_design.certificates.checks.ideal_run import Array


def in_run(run: ProofRun, values: "Array") -> dict[str, float]:
    """Return the numbers of ``lyapunov_adaptive.RUN``.

    Parameters
    ----------
    run : ProofRun
        The run.
    values : ndarray
        Of the function along it.
    """
    rise, start, end = largest_rise(values)
    return {
        "rise": rise / float(values.max()),
        "first": float(values[0]),
        "last": float(values[-1]),
        "before": float(values[start]),
        "after": float(values[end]),
        "since": float(run.time[start]),
        "until": float(run.time[end]),
        "slip": float(run.slip[-1]),
        "instants": float(len(run.time)),
        "cut short": float(bool(run.cut)),
    }


def inside(run: ProofRun, order: "NDArray[np.intp]", speeds: tuple[float, float]) -> list[int]:
    """Return the instants of an order at which speed [m/s] and slip are ones that a claim speaks about."""
    return [k for k in order.tolist() if 0.0 <= run.slip[k] <= 1.0 and speeds[0] <= run.speed[k] <= speeds[1]]
