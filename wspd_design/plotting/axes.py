"""Axes to draw on: those that are given, or new ones in the style of the reports on white."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.taken import described
from wspd_design.reporting.figure_style import TEXT_WIDTH, parameters

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ON_WHITE = {"figure.facecolor": "white", "axes.facecolor": "white", "savefig.facecolor": "white"}


def on_axes(ax: "Axes | None", draw: "Callable[[Axes], object]", *, height: float = 3.0) -> "Axes":
    """Draw on axes and return them.

    Parameters
    ----------
    ax : Axes or None
        Where to draw; None for new axes, which a notebook shows below the cell.
    draw : callable
        Draws on axes and sets their labels.
    height : float
        Of a new figure [in].

    Raises
    ------
    UserError
        If ``ax`` is something else, such as a figure or an array of axes.
    """
    if ax is not None:
        if not hasattr(ax, "plot"):
            raise UserError(
                f"ax takes one Axes of Matplotlib, not {described(ax)}; give fig.add_subplot() or one of an array"
            )
        draw(ax)
        given: Axes = ax
        return given
    import matplotlib
    from matplotlib import pyplot

    # A notebook's backend switches interaction on when it is first used; within the context that would be undone at its
    # end, and no later plot would show.
    pyplot.draw_if_interactive()
    with matplotlib.rc_context({**parameters(), **_ON_WHITE}):
        made: Axes
        _, made = pyplot.subplots(figsize=(TEXT_WIDTH, height), layout="constrained")
        draw(made)
    return made
