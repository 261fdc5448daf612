"""One stop over time: slip, speeds, torque and valve command."""

from typing import TYPE_CHECKING

from wspd_design.design.records import Specification
from wspd_design.reporting.figure_style import INK, MUTED, SERIES
from wspd_design.reporting.figures.drawing import KILO, KMH, curve, note
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.records import Run
from wspd_design.simulation.stop import JUDGING_SPEED

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from wspd_design.simulation.records import Trace


def stop_traces(
    figure: "Figure", trial: Trial, specification: Specification, *, wheel_radius: float, max_torque: float
) -> "Figure":
    """Draw slip, speeds, torque and the valve command of a stop over one time axis.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    trial : Trial
        The stop.
    specification : Specification
        Slip reference and tolerance.
    wheel_radius : float
        For the speed of the wheel rim [m].
    max_torque : float
        Of the brake, per wheelset [N m].
    """
    run = trial.run
    slip, speed, torque, valve = figure.subplots(4, 1, sharex=True, height_ratios=(3.2, 2.2, 2.2, 1.0))
    slip_panel(slip, run, specification, top=_slip_top(trial, specification))
    slip.set_title("Slip")
    curve(speed, run.time, run.speed * KMH, 0, label="train")
    for wheelset in range(run.wheel_speed.shape[1]):
        rim = run.wheel_speed[:, wheelset] * wheel_radius * KMH
        curve(speed, run.time, rim, 1 + wheelset, linewidth=1.0, label=_wheelset("wheel rim", run, wheelset))
    speed.set(ylabel="speed [km/h]", title="Speed of train and wheel rim", ylim=(0.0, None))
    speed.legend(loc="upper right")
    torque.axhline(max_torque / KILO, color=INK, linestyle="--", linewidth=0.7)
    note(torque, "limit of the brake", run.time[-1], max_torque / KILO, ha="right")
    for wheelset in range(run.torque.shape[1]):
        name = _wheelset("torque", run, wheelset)
        curve(torque, run.time, run.torque[:, wheelset] / KILO, wheelset, label=name)
    torque.set(
        ylabel="torque [kN m]", title="Braking torque per wheelset", ylim=(0.0, 1.25 * max_torque / KILO)
    )
    times = [sample.time for sample in run.samples] + [float(run.time[-1])]
    fill = [sample.fill for sample in run.samples]
    valve.stairs(fill, times, fill=True, color=SERIES[0], alpha=0.6, linewidth=0)
    valve.set(
        xlabel="time [s]",
        ylabel="fill [-]",
        title="Share of each sample that fills",
        ylim=(0.0, 1.05),
        yticks=(0, 1),
    )
    valve.set_xlim(0.0, float(run.time[-1]))
    return figure


def slip_panel(axes: "Axes", run: Run, specification: Specification, *, top: float) -> None:
    """Draw the slip of all wheelsets with its reference, tolerance band and lock intervals."""
    reference, tolerance = specification.slip, specification.slip_tolerance
    band = (reference - tolerance, reference + tolerance)
    axes.axhspan(*band, color=SERIES[2], alpha=0.15, linewidth=0)
    axes.axhline(reference, color=INK, linestyle="--", linewidth=0.8)
    for wheelset in range(run.slip.shape[1]):
        locked = run.wheel_speed[:, wheelset] <= 0.0
        # A bar at the top edge: it stays visible when the slip itself has left the picture.
        axes.broken_barh(
            _intervals(run.time, locked), (0.96, 0.04), transform=axes.get_xaxis_transform(), color=SERIES[1]
        )
        curve(axes, run.time, run.slip[:, wheelset], wheelset)
    below = run.time[run.speed < JUDGING_SPEED]
    if below.size:
        axes.axvspan(below[0], run.time[-1], color=MUTED, alpha=0.12, linewidth=0)
    axes.set(ylim=(0.0, top), ylabel="slip [-]")
    axes.set_xlim(0.0, float(run.time[-1]))


def _intervals(time: "Trace", flags: "NDArray[np.bool_]") -> list[tuple[float, float]]:
    """Return start and length of each stretch of time with a flag."""
    import numpy as np

    edges = np.flatnonzero(np.diff(flags.astype(int), prepend=0, append=0))
    return [
        (float(time[start]), float(time[end - 1] - time[start]))
        for start, end in zip(edges[::2], edges[1::2], strict=True)
    ]


def stop_alt(trial: Trial, specification: Specification) -> str:
    """Say in words what the traces of a stop show."""
    run, figures = trial.run, trial.metrics
    return (
        f"Four panels over {figures.stopping_time:.2f} s. Slip: mean {figures.slip_mean:.3f}, largest "
        f"{figures.slip_max:.3f}, rms {figures.slip_rms:.3f} about the reference {specification.slip:g}, "
        f"whose tolerance band of ±{specification.slip_tolerance:g} is shaded. Speed of train and wheel rim "
        f"from {run.initial_speed * KMH:.4g} km/h to standstill; the wheels are locked for "
        f"{figures.lock_time:.2f} s. Braking torque per wheelset, at most {run.torque.max() / KILO:.3g} kN "
        f"m. Filling share of each of the {len(run.samples)} samples; {100.0 * figures.saturated_share:.0f} "
        "% of them fill or vent throughout."
    )


def _slip_top(trial: Trial, specification: Specification) -> float:
    """Upper end of the slip axis: what happens above the judging speed fits."""
    wanted = max(1.15 * trial.metrics.slip_max, specification.slip + 2.0 * specification.slip_tolerance)
    return min(wanted, 1.05)


def _wheelset(name: str, run: Run, index: int) -> str:
    return name if run.slip.shape[1] == 1 else f"{name} {index + 1}"
