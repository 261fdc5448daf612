"""One stop over time: slip, speeds, torque, wheel load and valve command of every wheelset."""

from typing import TYPE_CHECKING

from wspd_design.design.records import Specification
from wspd_design.reporting.figure_style import INK, MUTED, SERIES
from wspd_design.reporting.figures.drawing import KILO, KMH, curve, look, note, thinned
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.description import held_slip
from wspd_design.simulation.law_memory import reference_range, slip_references
from wspd_design.simulation.locked import locked
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.runs import Run

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from wspd_design.simulation.runs import Trace

TRAIN = len(SERIES) - 1
"""Color and line style of the train speed; the wheelsets take the others, front to rear."""

MOST = 900
"""Points of the curve of one wheelset: there are up to 20 in one figure."""

LOCK_BAR = 0.02  # of the height of the slip panel, one for each wheelset, and all of them at most:
LOCK_BARS = 0.16
MOST_NAMED = 8  # wheelsets in a legend and at the rows of valves; of more than these every second or so
IN_FULL = 4  # wheelsets whose names stand in the legend in full


def stop_traces(
    figure: "Figure", trial: Trial, specification: Specification, *, wheel_radius: float, max_torque: float
) -> "Figure":
    """Draw slip, speeds, torque, wheel load and the valve command of a stop over one time axis.

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
    slip, speed, torque, load, valve = figure.subplots(
        5, 1, sharex=True, height_ratios=(3.2, 2.4, 2.2, 1.6, 1.6)
    )
    slip_panel(slip, run, specification, top=_slip_top(trial, specification))
    slip.set_title("Slip", pad=16.0)
    wheelset_legend(slip, run)
    speed_panel(speed, run, wheel_radius)
    speed.set_title("Speed of train and wheel rims")
    torque.axhline(max_torque / KILO, color=INK, linestyle="--", linewidth=0.7)
    note(torque, "limit of the brake", run.time[-1], max_torque / KILO, ha="right")
    torque_panel(torque, run)
    torque.set(title="Braking torque of each wheelset", ylim=(0.0, 1.25 * max_torque / KILO))
    load_panel(load, run)
    load.set_title("Load of one wheel of each wheelset")
    valve_panel(valve, run)
    valve.set(xlabel="time [s]", title="Share of each sample that fills, a row from 0 to 1 for each wheelset")
    valve.set_xlim(0.0, float(run.time[-1]))
    return figure


def slip_panel(axes: "Axes", run: Run, specification: Specification, *, top: float, most: int = MOST) -> None:
    """Draw the slip of all wheelsets with its reference, tolerance band and lock intervals."""
    reference_line(axes, run, specification.slip, specification.slip_tolerance)
    slip_curves(axes, run, top=top, most=most)


def slip_curves(axes: "Axes", run: Run, *, top: float, most: int = MOST) -> None:
    """Draw the slip of all wheelsets; bars at the top edge where they are locked, shade where no slip is judged."""
    wheelsets = run.slip.shape[1]
    bar, stands = min(LOCK_BAR, LOCK_BARS / wheelsets), locked(run)
    for wheelset in range(wheelsets):
        # Bars at the top edge, front wheelset first: visible when the slip itself has left the picture.
        axes.broken_barh(
            intervals(run.time, stands[:, wheelset]),
            (1.0 - bar * (wheelset + 1), 0.8 * bar),
            transform=axes.get_xaxis_transform(),
            color=look(line_of(wheelset))[0],
            linewidth=0,
        )
        curve(
            axes,
            run.time,
            run.slip[:, wheelset],
            line_of(wheelset),
            most=most,
            linewidth=1.0,
            label=_label(run, wheelset),
        )
    below = run.time[run.speed < JUDGING_SPEED]
    if below.size:
        axes.axvspan(below[0], run.time[-1], color=MUTED, alpha=0.12, linewidth=0)
    axes.set(ylim=(0.0, top), ylabel="slip [-]")
    axes.set_xlim(0.0, float(run.time[-1]))


def reference_line(axes: "Axes", run: Run, slip: float | None, tolerance: float = 0.0) -> None:
    """Draw the slip that the law holds with the tolerance about it: its own course, or one slip for the whole stop."""
    import numpy as np

    held = slip_references(run)
    if held is None:
        if slip is not None:
            axes.axhspan(slip - tolerance, slip + tolerance, color=SERIES[2], alpha=0.15, linewidth=0)
            axes.axhline(slip, color=INK, linestyle="--", linewidth=0.8)
        return
    times = np.array([sample.time for sample in run.samples])
    low, high = held.min(axis=1) - tolerance, held.max(axis=1) + tolerance
    axes.fill_between(times, low, high, color=SERIES[2], alpha=0.15, linewidth=0)
    for course in np.unique(held, axis=1).T:  # one line where all wheelsets hold the same
        axes.plot(*thinned(times, course, MOST), color=INK, linestyle="--", linewidth=0.8, label="_reference")


def speed_panel(axes: "Axes", run: Run, wheel_radius: float) -> None:
    """Draw the speed of the train and of each wheel rim."""
    for wheelset in range(run.wheel_speed.shape[1]):
        rim = run.wheel_speed[:, wheelset] * wheel_radius * KMH
        curve(axes, run.time, rim, line_of(wheelset), most=MOST, linewidth=1.0)
    axes.plot(run.time[::20], run.speed[::20] * KMH, color=SERIES[TRAIN], linewidth=1.6, label="train")
    axes.set(ylabel="speed [km/h]", ylim=(0.0, None))
    axes.legend(loc="upper right")


def torque_panel(axes: "Axes", run: Run) -> None:
    """Draw the braking torque of each wheelset."""
    for wheelset in range(run.torque.shape[1]):
        curve(axes, run.time, run.torque[:, wheelset] / KILO, line_of(wheelset), most=MOST, linewidth=1.0)
    axes.set_ylabel("torque [kN m]")


def load_panel(axes: "Axes", run: Run) -> None:
    """Draw the load of one wheel of each wheelset."""
    for wheelset in range(run.wheel_load.shape[1]):
        curve(axes, run.time, run.wheel_load[:, wheelset] / KILO, line_of(wheelset), most=MOST, linewidth=1.0)
    axes.set_ylabel("load [kN]")


def valve_panel(axes: "Axes", run: Run) -> None:
    """Draw the filling share of each sample, one row for each wheelset with the front one on top."""
    wheelsets = len(run.axle_samples)
    for wheelset, samples in enumerate(run.axle_samples):
        floor = 1.25 * (wheelsets - 1 - wheelset)
        if not samples:
            continue  # without a brake
        times = [sample.time for sample in samples] + [float(run.time[-1])]
        fill = [floor + sample.fill for sample in samples]
        axes.stairs(
            fill, times, baseline=floor, fill=True, color=look(line_of(wheelset))[0], alpha=0.7, linewidth=0
        )
    numbered = named(wheelsets)
    axes.set_yticks(
        [1.25 * (wheelsets - 1 - wheelset) + 0.5 for wheelset in numbered],
        [str(wheelset + 1) for wheelset in numbered],
    )
    axes.grid(visible=False, axis="y")
    axes.set(ylabel="fill [-]", ylim=(0.0, 1.25 * wheelsets))


def wheelset_legend(axes: "Axes", run: Run) -> None:
    """Say above the axes which line is which wheelset, if there are several."""
    if run.slip.shape[1] > 1:
        columns = len(named(run.slip.shape[1]))
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=columns, borderaxespad=0.1)


def named(wheelsets: int) -> tuple[int, ...]:
    """Return the wheelsets that a legend names: all, or so many that they fit, with the first and the last."""
    step = -(-(wheelsets - 1) // (MOST_NAMED - 1)) or 1
    return tuple(sorted({*range(0, wheelsets, step)[: MOST_NAMED - 1], wheelsets - 1}))


def line_of(wheelset: int) -> int:
    """Return the place of a wheelset among colors and line styles; none has that of the train."""
    return wheelset if wheelset < TRAIN else wheelset + 1


def _label(run: Run, wheelset: int) -> str:
    """Name in the legend: without the word where there are many; none of a wheelset that is not named."""
    wheelsets, full = run.slip.shape[1], name(run, wheelset)
    if wheelset not in named(wheelsets):
        return f"_{full}"
    return full if wheelsets <= IN_FULL or wheelset == 0 else full.removeprefix("wheelset ")


def name(run: Run, wheelset: int) -> str:
    """Return the name of a wheelset by its place, counted from the front."""
    last = run.slip.shape[1] - 1
    if last == 0:
        return "wheelset"
    return f"wheelset {wheelset + 1}" + {0: " (front)", last: " (rear)"}.get(wheelset, "")


def intervals(time: "Trace", flags: "NDArray[np.bool_]") -> list[tuple[float, float]]:
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
    slips = "; ".join(
        f"{name(run, wheelset)} at most {run.torque[:, wheelset].max() / KILO:.3g} kN m under "
        f"{run.wheel_load[:, wheelset].min() / KILO:.3g} to {run.wheel_load[:, wheelset].max() / KILO:.3g} kN "
        "on a wheel"
        for wheelset in range(run.slip.shape[1])
    )
    return (
        f"Five panels over {figures.stopping_time:.2f} s. Slip: mean {figures.slip_mean:.3f}, largest "
        f"{figures.slip_max:.3f}, rms {figures.slip_rms:.3f} about the reference {held_slip(run, specification.slip)}, "
        f"whose tolerance band of ±{specification.slip_tolerance:g} is shaded. Speed of train and wheel rims "
        f"from {run.initial_speed * KMH:.4g} km/h to standstill; a wheelset is locked for at most "
        f"{figures.lock_time:.2f} s. Braking torque and load: {slips}. Filling share of each of the "
        f"{len(run.samples)} samples; {100.0 * figures.saturated_share:.0f} % of them fill or vent throughout."
    )


def _slip_top(trial: Trial, specification: Specification) -> float:
    """Upper end of the slip axis: what happens above the judging speed fits."""
    _, highest = reference_range(trial.run) or (0.0, specification.slip)
    wanted = max(1.2 * trial.metrics.slip_max, highest + 2.0 * specification.slip_tolerance)
    return min(wanted, 1.1)
