"""The stop of this design: traces and phase planes."""

from functools import partial

from wspd_design.codegen.loop_numbers import DISTANCE_TOLERANCE, ERROR_SPEED
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Figure, Heading, Paragraph
from wspd_design.reporting.figures.drawing import KMH, picture
from wspd_design.reporting.figures.estimate import estimate_alt, estimate_panels
from wspd_design.reporting.figures.further_brakes import further_brakes, height, panels
from wspd_design.reporting.figures.phase import phase_alt, phase_planes
from wspd_design.reporting.figures.stop import name, stop_alt, stop_traces
from wspd_design.reporting.running_gear import axle_shares
from wspd_design.reporting.spreads import distance_of_stop
from wspd_design.reporting.text import Link, escape, rich
from wspd_design.reporting.yardsticks import ideal_sentence
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.description import held_slip, rails_of
from wspd_design.simulation.law_memory import reference_range, releases, speed_estimate
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.runs import Run
from wspd_design.simulation.traces import trace_name
from wspd_design.studies.dossier import Dossier

EXACT = 1e-4  # relative error of a speed that is told, below which none is


def stop(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about the simulated stop."""
    own, specification = dossier.trials[0], dossier.specification
    run, figures = own.run, own.metrics
    radius = dossier.vehicle.number("wheel_radius")
    limit = dossier.vehicle.number("brake.max_torque") * max(axle_shares(dossier.vehicle))
    draw = partial(stop_traces, trial=own, specification=specification, wheel_radius=radius, max_torque=limit)
    start, wheelset = numbers.significant(run.initial_speed * KMH), name(run, run.first_braked)
    judged = numbers.significant(JUDGING_SPEED * KMH)
    return (
        Heading(text="The stop", anchor="stop"),
        Paragraph(
            text=rich(
                f"The stop of {escape(run.train)} from {start} km/h on {escape(rails_of(dossier.scenario))}, sampled "
                f"every {run.sample_time * 1e3:g} ms: {run.ending.value}, after {distance_of_stop(dossier)} m and "
                f"{numbers.decimals(figures.stopping_time, 2)} s. {ideal_sentence(figures)} Above "
                f"{judged} km/h the mean slip is {numbers.decimals(figures.slip_mean, 3)} and the largest "
                f"{numbers.decimals(figures.slip_max, 3)}; a wheelset is locked for at most "
                f"{numbers.decimals(figures.lock_time, 2)} s of the whole stop, and its valve changes its state "
                f"{figures.valve_switches} times. In {numbers.decimals(100.0 * figures.saturated_share, 0)} % of "
                "the samples it fills or vents throughout; a relay would do so in all. "
                "[](#stop-traces) shows the stop over time, [](#phase-plane) its path in the planes of slip and torque."
            )
        ),
        Figure(
            svg=picture(draw, height=8.6),
            caption=f"The stop over time, {run.train}. Green: tolerance about the reference, "
            f"{held_slip(run, specification.slip)} (dashed). Gray: below {judged} km/h, where the slip is not judged. "
            "Bars at the upper edge of the slip mark locked wheels, the front wheelset on top.",
            alt=stop_alt(own, specification),
            anchor="stop-traces",
            data=trace_name(0, run.controller),
        ),
        *_estimate(own, None if dossier.law.own else specification.sensors, told=dossier.law.told_speed),
        *_further_brakes(run),
        Figure(
            svg=picture(
                partial(phase_planes, run=run, plane=dossier.phase_plane, specification=specification),
                height=3.0,
            ),
            caption=f"Phase planes of the {wheelset} above {judged} km/h. Left: what the law steers, at its "
            "samples; on the dashed surface the error would decay, and the band is the boundary layer. "
            "Right: slip and torque of the wheel; closed loops are a limit cycle of slip and valve."
            if dossier.phase_plane
            else f"Slip and torque of the {wheelset} above {judged} km/h; closed loops are a limit cycle of "
            "slip and valve." + ("" if reference_range(run) else " Dashed: the reference."),
            alt=phase_alt(run, dossier.phase_plane),
            anchor="phase-plane",
        ),
    )


def _estimate(own: Trial, sensors: Sensors | None, *, told: bool) -> tuple[Block, ...]:
    """Say where the law has the train speed from, and show an estimate beside the true one."""
    run, figures = own.run, own.metrics
    estimate = speed_estimate(run)
    if estimate is None:
        return (
            Paragraph(
                text="The law is told the train speed and estimates none; a vehicle that has no radar must work it out "
                "from its wheels, whose slides then go into it."
                if told
                else "The law does not go by the train speed that it is told, and tells of none that it estimates."
            ),
        )
    base, share = DISTANCE_TOLERANCE
    fast, allowed = numbers.significant(ERROR_SPEED * KMH), f"{base:g} m + {100.0 * share:g} %"
    inside = "inside" if figures.distance_error <= 1.0 else "outside"
    looks = releases(run)
    looked = (
        ""
        if not looks
        else f" It released a wheelset {numbers.count(looks, 'time')} to see the speed of the train."
    )
    if sensors is not None and sensors.speed == "told" and figures.speed_error < EXACT:
        return (Paragraph(text=f"{_source(sensors)} In this stop it is told it without an error."),)
    said = (
        f"{_source(sensors)} Above {fast} km/h that speed is wrong by at most "
        f"{numbers.significant(100.0 * figures.speed_error, 2)} %; the distance that follows from it by at most "
        f"{numbers.significant(figures.distance_error, 2)} of {allowed}, {inside} what the odometry of train "
        f"control allows.{looked}"
    )
    if sensors is not None and sensors.speed == "told":
        return (Paragraph(text=said),)
    return (
        Paragraph(text=(said, " ", Link(anchor="stop-estimate"), " shows both over the stop.")),
        Figure(
            svg=picture(partial(estimate_panels, run=run, estimate=estimate), height=5.4),
            caption="The train speed as the law has it (dashed) beside the true one, the relative error of the speed, "
            f"which counts above {fast} km/h, and the error of the distance with the {allowed} of ETCS (green). Bars "
            "at the upper edge: wheelsets that the law releases to see the speed, the front one on top.",
            alt=estimate_alt(run, estimate),
            anchor="stop-estimate",
        ),
    )


def _source(sensors: Sensors | None) -> str:
    """Say where a law has the train speed from."""
    if sensors is None:
        return "The law goes by a train speed of its own."
    match sensors.speed:
        case "told":
            return "The law is told the train speed, and scales it so that wheels that roll have no slip."
        case "fastest-axle":
            return (
                "The law takes the fastest wheelset for the train, and bounds how fast that speed may fall."
            )
        case "wheels":
            beside = " and an accelerometer" if sensors.accelerometer else ""
            return f"The law estimates the train speed from its wheels{beside}."


def _further_brakes(run: Run) -> tuple[Block, ...]:
    shown = panels(run)
    if not shown:
        return ()
    return (
        Paragraph(text=(Link(anchor="stop-further-brakes"), " shows what else acts in the same stop.")),
        Figure(
            svg=picture(partial(further_brakes, run=run), height=height(run)),
            caption="The same stop: what acts beside the friction brake, and how warm its pads get. Lines as in the "
            "figure before.",
            alt=" ".join(
                (f"{len(shown)} panels over {run.time[-1]:.2f} s.", *(panel.words for panel in shown))
            ),
            anchor="stop-further-brakes",
            data=trace_name(0, run.controller),
        ),
    )
