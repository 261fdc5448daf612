"""The options that disturb a stop, for every command that stops."""

from dataclasses import dataclass
from typing import Annotated, Any

import typer

from wspd_design.simulation.records import FAULT_KINDS

PANEL = "Disturbances, all off by default"


def _described(flag: str, metavar: str | None, meaning: str, *, least: int | None = None) -> Any:
    return typer.Option(
        flag, metavar=metavar, help=meaning, min=least, show_default=False, rich_help_panel=PANEL
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class StopOptions:
    """What the user wrote about the disturbances of a stop; None where nothing was written."""

    axle_rails: Annotated[
        str | None,
        _described(
            "--axle-rails",
            "R1,R2,R3,R4",
            "Rail below each axle, front first; --rail stays the one that controllers are designed for.",
        ),
    ] = None
    patch: Annotated[
        list[str] | None,
        _described(
            "--patch", '"START RAIL"', 'From START on another rail: "50 m polach-wet". Repeat it for several.'
        ),
    ] = None
    grade: Annotated[
        str | None, _described("--grade", "GRADE", 'Positive uphill: "5 permille" or "-0.5 %".')
    ] = None
    pad_vibration: Annotated[
        bool,
        _described("--pad-vibration", None, "Vibration of the brake pads, T_d in Section 7 of the paper."),
    ] = False
    load_spread: Annotated[
        str | None,
        _described(
            "--load-spread",
            "SHARE",
            'Wheel loads vary along a track (ERRI B 176) that the seed draws; standard deviation: "4 %".',
        ),
    ] = None
    irregularities: Annotated[
        str | None,
        _described(
            "--irregularities",
            "LEVEL",
            "The locomotive rolls over a track (ERRI B 176) that the seed draws: high or low.",
        ),
    ] = None
    speed_noise: Annotated[
        str | None, _described("--speed-noise", "SPEED", 'Of the measured rim speed, rms: "0.05 m/s".')
    ] = None
    pulses: Annotated[
        int | None,
        _described(
            "--pulses",
            "NUMBER",
            "Pulses per turn of the wheel that measures the speed, such as 80; they are counted over a sample.",
            least=1,
        ),
    ] = None
    period_timing: Annotated[
        bool,
        _described("--period-timing", None, "Time the periods between the pulses in place of counting them."),
    ] = False
    reference_error: Annotated[
        str | None,
        _described("--reference-error", "SHARE", 'Of the train speed that the controller knows: "2 %".'),
    ] = None
    reference_drift: Annotated[
        str | None,
        _described("--reference-drift", "RATE", 'Of that train speed away from the true one: "-0.05 m/s2".'),
    ] = None
    reference_noise: Annotated[
        str | None, _described("--reference-noise", "SPEED", 'Of that train speed, rms: "0.1 m/s".')
    ] = None
    torque_error: Annotated[
        str | None,
        _described("--torque-error", "SHARE", 'Of the torque that it computes from the pressure: "-10 %".'),
    ] = None
    accelerometer_bias: Annotated[
        str | None,
        _described("--accelerometer-bias", "RATE", 'Of the accelerometer of the vehicle: "0.05 m/s2".'),
    ] = None
    accelerometer_noise: Annotated[
        str | None, _described("--accelerometer-noise", "RATE", 'Of the accelerometer, rms: "0.1 m/s2".')
    ] = None
    radius_errors: Annotated[
        str | None,
        _described(
            "--radius-errors",
            "E1,E2,E3,E4",
            'Of the wheel radii behind the measured speeds, front first: "0.5 %,-0.5 %,0 %,0 %".',
        ),
    ] = None
    dead_time: Annotated[
        str | None,
        _described("--dead-time", "TIME", 'From command to valve, in place of that of the vehicle: "60 ms".'),
    ] = None
    shortest_pulse: Annotated[
        str | None,
        _described(
            "--shortest-pulse",
            "TIME",
            'Shorter ones do not open a valve, in place of those of the vehicle: "10 ms".',
        ),
    ] = None
    fault: Annotated[
        list[str] | None,
        _described(
            "--fault",
            '"axle N: KIND"',
            f"KIND is {' or '.join(FAULT_KINDS)}, with a time if not from the start: "
            '"axle 2: valve-holds from 3 s". Repeat it for several.',
        ),
    ] = None
