"""What a rail gives: adhesion over slip, friction over sliding speed."""

from typing import TYPE_CHECKING

from wspd_design.model import adhesion
from wspd_design.model.generated.adhesion import friction_coefficient
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.taken import check_vehicle
from wspd_design.parameters.units import KMH
from wspd_design.plotting.axes import on_axes
from wspd_design.reporting.figures.drawing import curve

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_POINTS = 400
_LARGEST_SLIP = 0.4
_FASTEST = 20.0  # m/s, of the sliding


def plot_adhesion(
    rail: Rail, vehicle: Vehicle, *, speeds_kmh: tuple[float, ...], ax: "Axes | None" = None
) -> "Axes":
    """Plot adhesion over slip; parameters as of :meth:`wspd_design.Rail.plot`."""
    check_vehicle(vehicle, by="Rail.plot", whole=False)
    if not speeds_kmh or min(speeds_kmh) <= 0.0:
        raise UserError(f"speeds_kmh = {speeds_kmh} must be one or more speeds above 0")

    def draw(axes: "Axes") -> None:
        import numpy as np

        load = float(static_wheel_load(vehicle))
        stiffness = adhesion.contact_stiffness(vehicle.contact, load)
        slips = np.linspace(0.0, _LARGEST_SLIP, _POINTS + 1)[1:]
        for place, speed in enumerate(speeds_kmh):
            force = adhesion.creep_force(slips, slips * speed / KMH, load, rail, stiffness)
            curve(axes, slips, force / load, place, label=f"{speed:g} km/h")
        axes.set(
            xlabel="slip [-]",
            ylabel="adhesion, creep force over wheel load [-]",
            title=f"{rail.name} under {vehicle.name}",
            xlim=(0.0, _LARGEST_SLIP),
            ylim=(0.0, None),
        )
        axes.legend()

    return on_axes(ax, draw)


def friction_panel(figure: "Figure", rail: Rail) -> "Figure":
    """Draw the friction over the sliding speed on an empty figure."""
    import numpy as np

    axes, sliding = figure.subplots(), np.linspace(0.0, _FASTEST, _POINTS)
    friction = friction_coefficient(sliding, rail.mu0, rail.friction_ratio, rail.friction_decay)
    curve(axes, sliding, friction, 0)
    axes.set(xlabel="sliding speed [m/s]", ylabel="friction [-]", xlim=(0.0, _FASTEST), ylim=(0.0, None))
    return figure
