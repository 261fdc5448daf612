"""What a vehicle has sensors for, beside those of its wheel speeds."""

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from wspd_design.parameters.errors import UserError

SpeedKind: TypeAlias = Literal["told", "fastest-axle", "wheels"]
"""Where the train speed comes from: a source of its own, the fastest axle, or a filter on all wheels and torques."""

SPEED_KINDS: tuple[SpeedKind, ...] = get_args(SpeedKind)


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensors:
    """What a wheel slide protection can go by."""

    speed: SpeedKind = "told"
    accelerometer: bool = False  # along the track
    pressures: bool = True  # of the brake cylinders; without them the law goes by its model of the valves
    grade: bool = False  # the filter on the wheels allows for a grade

    def __post_init__(self) -> None:
        """Refuse an unknown source, and what only the filter on the wheels has a use for."""
        if self.speed not in SPEED_KINDS:
            allowed = ", ".join(f'"{kind}"' for kind in SPEED_KINDS)
            raise UserError(f'sensors: speed = "{self.speed}" must be one of {allowed}')
        for name in ("accelerometer", "grade"):
            if getattr(self, name) and self.speed != "wheels":
                raise UserError(
                    f'sensors: {name} = true goes with speed = "wheels", not with "{self.speed}"; leave it out or '
                    'write speed = "wheels"'
                )


TOLD = Sensors()
"""A told train speed and pressure sensors: what the paper assumes."""
