"""A multibody vehicle, drawn from its data: bodies, springs, rods, gears and brakes.

Bodies are the homogeneous boxes, and rotors the disks, that have their mass and their moments of inertia.
"""

import math
from typing import TYPE_CHECKING, Any, TypeAlias

from wspd_design.plants.multibody.records import Body, BumpStop, CaliperBrake, Gear, Multibody, Rod, Spring
from wspd_design.reporting.figure_style import INK, MUTED, SERIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIDE, TOP = 2, 1  # axis of space that points up in a view
FACE = 0.16  # opacity of a body
COIL, TURNS, WIDTH = 0.26, 4, 0.045  # m, -, m, of a spring that carries, seen from the side and near
NEAR = 0.4  # of the distance from the first to the last wheelset that the enlarged part shows
MARGIN = 0.35  # m about it
MARKERS = ("s", "o", "D", "^", "P", "X", "v", "<", ">", "*")

Point: TypeAlias = tuple[float, float]


def multibody(figure: "Figure", model: Multibody) -> "Figure":
    """Draw a vehicle at rest: from its side, from above, and its front end from the side, enlarged.

    Parameters
    ----------
    figure : Figure
        Empty figure.
    model : Multibody
        The vehicle, with numbers.
    """
    side, top, near = figure.subplots(3, 1, height_ratios=(1.45, 1.0, 1.9))
    for axes, up in ((side, SIDE), (top, TOP), (near, SIDE)):
        for body in model.bodies:
            _body(axes, model, body, up)
        _elements(axes, model, up, coils=axes is near)
        axes.set_aspect("equal")
        axes.grid(visible=False)
        axes.set_ylabel("up [m]" if up == SIDE else "left [m]")
    for axes in (side, near):
        axes.axhline(0.0, color=INK, linewidth=1.0)
    side.set_title("From the left; the vehicle runs to the right")
    top.set_title("From above")
    near.set_title("Its front end from the left", pad=22.0)
    near.set_xlabel("forward of the middle [m]")
    _enlarge(near, model)
    lines, labels = side.get_legend_handles_labels()
    unique = dict(zip(labels, lines, strict=True))
    figure.legend(unique.values(), unique.keys(), loc="outside lower center", ncols=5)
    return figure


def multibody_alt(model: Multibody) -> str:
    """Say in words what the figure shows."""
    bodies = [body.kind for body in model.bodies]
    counted = (f"{bodies.count(kind)} {_words(kind)}" for kind in dict.fromkeys(bodies))
    return (
        f"{model.title}: {len(model.bodies)} bodies ({', '.join(counted)}), {len(model.springs)} springs, "
        f"{len(model.rods)} rods, {len(model.gears)} gears and {len(model.brakes)} brakes at their places."
    )


def box(model: Multibody, body: Body) -> tuple[float, float, float]:
    """Return the lengths of the homogeneous box with the mass and the moments of inertia of a body [m].

    A side is 0 where no box has such moments.
    """
    mass = float(model.mass(body))
    x, y, z = (float(each) for each in model.inertia(body))
    squares = (6.0 * part / mass for part in (y + z - x, z + x - y, x + y - z))
    length, width, height = (math.sqrt(max(each, 0.0)) for each in squares)
    return length, width, height


def _body(axes: "Axes", model: Multibody, body: Body, up: int) -> None:
    from matplotlib.patches import Circle, Rectangle

    x, y = center = _flat(model.place(body.at), up)
    look: dict[str, Any] = {"facecolor": SERIES[0], "edgecolor": INK, "linewidth": 0.6, "alpha": FACE}
    if body.joint == "wheelset":
        radius = float(model.numbers["wheel_radius"])
        if up == SIDE:
            axes.add_patch(Circle(center, radius, **look))
            axes.plot(x, y, marker="+", color=INK, markersize=4)
            return
        half = float(model.numbers["wheel_half_spacing"])
        axes.plot([x, x], [-half, half], color=INK, linestyle="-", linewidth=1.4)
        for wheel in (-half, half):
            axes.plot([x - radius, x + radius], [wheel, wheel], color=INK, linestyle="-", linewidth=2.2)
        return
    lengths = box(model, body)
    if body.joint == "rotor" and up == SIDE:
        axes.add_patch(
            Circle(center, math.sqrt(2.0 * float(model.inertia(body)[1]) / float(model.mass(body))), **look)
        )
        return
    size = (lengths[0], lengths[up])
    axes.add_patch(Rectangle((x - 0.5 * size[0], y - 0.5 * size[1]), *size, **look))


def _elements(axes: "Axes", model: Multibody, up: int, *, coils: bool) -> None:
    looks: dict[str, dict[str, Any]] = {
        kind: {
            "color": SERIES[1 + place % (len(SERIES) - 2)],
            "marker": MARKERS[place % len(MARKERS)],
            "markersize": 3.6,
            "label": _words(kind),
        }
        for place, kind in enumerate(_kinds(model))
    }
    points: tuple[Spring | BumpStop, ...] = (*model.springs, *model.stops)
    for element in points:
        x, y = _flat(model.place(element.at), up)
        look = looks[element.kind]
        axes.plot(x, y, linestyle="none", **look)
        if coils and isinstance(element, Spring) and element.carries:
            turns = range(2 * TURNS + 1)
            axes.plot(
                [x + WIDTH * (0.0 if k in (0, 2 * TURNS) else (-1.0) ** k) for k in turns],
                [y + COIL * (k / (2.0 * TURNS) - 0.5) for k in turns],
                linestyle="-",
                linewidth=0.8,
                color=look["color"],
            )
    for rod in model.rods:
        ends = [_flat(model.place(end), up) for end in rod.ends]
        axes.plot(*zip(*ends, strict=True), linestyle="-", linewidth=1.6, **looks[rod.kind])
    for gear in model.gears:
        axle = model.body(model.body(gear.housing).on)
        ends = [_flat(model.place(body.at), up) for body in (model.body(gear.rotor), axle)]
        axes.plot(*zip(*ends, strict=True), linestyle=":", linewidth=1.2, **looks[gear.kind])
    for brake in model.brakes:
        axle_x, *others = model.place(model.body(brake.wheelset).at)
        for lever in brake.levers:
            place = _flat((axle_x + model.length(lever), *others), up)
            axes.plot(*place, linestyle="none", **looks[brake.kind])


def _enlarge(axes: "Axes", model: Multibody) -> None:
    """Show the first wheelsets that stand together, and name the bodies there above them."""
    places = [float(model.place(model.body(name).at)[0]) for name in model.wheelset_names]
    near = [place for place in places if places[0] - place <= NEAR * (places[0] - places[-1])]
    radius = float(model.numbers["wheel_radius"])
    low, high = near[-1] - radius - MARGIN, near[0] + radius + MARGIN
    top = 2.0 * radius + 0.5 * MARGIN
    axes.set(xlim=(low, high), ylim=(-0.1, top))
    first: dict[str, Point] = {}
    for body in model.bodies:
        x, y = _flat(model.place(body.at), SIDE)
        if low <= x <= high and y < top:
            first.setdefault(body.kind, (x, y))
    named = sorted(first.items(), key=lambda pair: pair[1])
    for number, (kind, place) in enumerate(named):
        where = (low + (number + 0.5) / len(named) * (high - low), top + 0.08)
        axes.annotate(
            _words(kind),
            place,
            xytext=where,
            ha="center",
            va="bottom",
            annotation_clip=False,
            fontsize=7.5,
            gid="note-0",
            arrowprops={"arrowstyle": "-", "color": MUTED, "linewidth": 0.6},
        )


def _kinds(model: Multibody) -> tuple[str, ...]:
    elements: tuple[Spring | BumpStop | Rod | Gear | CaliperBrake, ...] = (
        *model.springs,
        *model.stops,
        *model.rods,
        *model.gears,
        *model.brakes,
    )
    return tuple(dict.fromkeys(each.kind for each in elements))


def _flat(place: tuple[object, object, object], up: int) -> Point:
    """Return forward and upward coordinates of a point in a view."""
    return float(place[0]), float(place[up])  # type: ignore[arg-type]  # numbers, not symbols


def _words(kind: str) -> str:
    return kind.replace("_", " ")
