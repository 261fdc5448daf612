"""The options of what a law sees and holds, for every command that makes one."""

from dataclasses import dataclass
from typing import Annotated, Any

import typer

from wspd_design.controllers.observers.sensors import SPEED_KINDS
from wspd_design.controllers.references import REFERENCE_KINDS
from wspd_design.design.case import SensorWords

PANEL = "Sensors and reference of laws of a vehicle; a design file has its own"


def _described(flags: str, metavar: str | None, meaning: str) -> Any:
    return typer.Option(flags, metavar=metavar, help=meaning, show_default=False, rich_help_panel=PANEL)


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorOptions:
    """What the user wrote about sensors and reference; None where nothing was written."""

    speed_source: Annotated[
        str | None,
        _described("--speed-source", "NAME", f"Where the train speed comes from: {', '.join(SPEED_KINDS)}."),
    ] = None
    accelerometer: Annotated[
        bool | None,
        _described(
            "--accelerometer/--no-accelerometer", None, "The speed from the wheels uses one along the track."
        ),
    ] = None
    pressure_sensors: Annotated[
        bool | None,
        _described(
            "--pressure-sensors/--no-pressure-sensors", None, "The law knows the pressure of the cylinders."
        ),
    ] = None
    estimate_grade: Annotated[
        bool | None,
        _described(
            "--estimate-grade/--no-estimate-grade", None, "The speed from the wheels allows for a grade."
        ),
    ] = None
    reference: Annotated[
        str | None, _described("--reference", "NAME", f"Of the slip: {', '.join(REFERENCE_KINDS)}.")
    ] = None

    @property
    def written(self) -> dict[str, str | bool | None]:
        """Return what was written by the name of the option."""
        return {
            "--speed-source": self.speed_source,
            "--accelerometer": self.accelerometer,
            "--pressure-sensors": self.pressure_sensors,
            "--estimate-grade": self.estimate_grade,
            "--reference": self.reference,
        }

    @property
    def words(self) -> SensorWords:
        """Return them as cases take them."""
        return SensorWords(
            speed=self.speed_source,
            accelerometer=self.accelerometer,
            pressures=self.pressure_sensors,
            grade=self.estimate_grade,
            reference=self.reference,
        )
