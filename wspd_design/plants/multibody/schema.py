"""What a file of a multibody vehicle holds: keys of its tables, and the numbers that its topology asks for."""

from collections.abc import Iterator
from typing import Final, TypeAlias, get_args

from wspd_design.parameters.schema import Quantity
from wspd_design.parameters.units import Dimension
from wspd_design.plants.multibody.records import Body, Joint, Length, Multibody

Wanted: TypeAlias = dict[str, Quantity]

JOINTS: Final[tuple[Joint, ...]] = get_args(Joint)

ITEM_KEYS: Final[dict[str, tuple[tuple[str, ...], tuple[str, ...]]]] = {
    "bodies": (("joint", "at"), ("each", "on", "axis")),
    "springs": (("between", "at"), ("each", "carries")),
    "rods": (("between", "from", "to"), ("each",)),
    "bump_stops": (("between", "at", "axis"), ("each",)),
    "gears": (("housing", "rotor"), ("each",)),
    "brakes": (("frame", "wheelset", "levers"), ("each",)),
}
"""Keys of the table of a body or an element: what it must have, and what it may have."""

FILE_KEYS: Final = ("title", "remainder", "instances", *ITEM_KEYS, "numbers")

EXAMPLES: Final = {
    "joint": '"free"',
    "at": '["0.5 wheelbase", 0, "wheel_radius"]',
    "between": '["car_body", "bogie_{bogie}"]',
    "from": '["0.5 bogie_spacing", 0, "rod.height"]',
    "to": '["0.5 bogie_spacing - rod.length", 0, "rod.height"]',
    "axis": '"y"',
    "wheelset": '"wheelset_{axle}"',
    "housing": '"gearbox_{axle}"',
    "rotor": '"rotor_{axle}"',
    "frame": '"bogie_{bogie}"',
    "levers": '["brake.lever"]',
}


def _above(dimension: Dimension) -> Quantity:
    return Quantity(dimension=dimension, low=0.0, low_is_allowed=False)


def _optional(dimension: Dimension) -> Quantity:
    return Quantity(dimension=dimension, low=0.0, optional=True)


_VEHICLE: Final[Wanted] = {
    "mass": Quantity(dimension="mass", low=0.0, low_is_allowed=False, plausible=(2e3, 1e6)),
    "wheel_radius": Quantity(dimension="length", low=0.0, low_is_allowed=False, plausible=(0.1, 1.5)),
    "wheel_half_spacing": Quantity(dimension="length", low=0.0, low_is_allowed=False, plausible=(0.3, 1.0)),
    "conicity": Quantity(dimension="ratio", low=0.0, high=1.0),
    "flange_clearance": Quantity(dimension="length", low=0.0, low_is_allowed=False, plausible=(1e-3, 0.05)),
}
_AXES = ("x", "y", "z")
_TURNS = ("roll", "pitch", "yaw")


def spring_keys() -> Iterator[tuple[str, Dimension]]:
    """Yield what the components of a spring may be called."""
    for axis in _AXES:
        yield f"stiffness_{axis}", "stiffness"
        yield f"damping_{axis}", "linear resistance"
    for turn in _TURNS:
        yield f"stiffness_{turn}", "rotational stiffness"
        yield f"damping_{turn}", "rotational damping"


def quantities_of(model: Multibody) -> Wanted:
    """Return what is expected of every number, by its name, in the order of the parts."""
    wanted, lengths = dict(_VEHICLE), list[Length]()
    for body in model.bodies:
        if body.name != model.remainder:
            wanted[f"{body.kind}.mass"] = _above("mass")
        wanted |= {f"{body.kind}.{key}": quantity for key, quantity in _inertia(body)}
        lengths += [*body.at, *(body.axis or ())]
    for spring in model.springs:
        wanted |= {f"{spring.kind}.{key}": _optional(dimension) for key, dimension in spring_keys()}
        lengths += spring.at
    for rod in model.rods:
        wanted[f"{rod.kind}.stiffness"] = _above("stiffness")
        wanted[f"{rod.kind}.damping"] = _optional("linear resistance")
        lengths += [*rod.ends[0], *rod.ends[1]]
    for stop in model.stops:
        wanted[f"{stop.kind}.travel"] = Quantity(dimension="length", shape="vector", low=0.0)
        wanted[f"{stop.kind}.force"] = Quantity(dimension="force", shape="vector", low=0.0)
        lengths += stop.at
    for gear in model.gears:
        wanted[f"{gear.kind}.ratio"] = _above("ratio")
        wanted[f"{gear.kind}.pinion_inertia"] = Quantity(dimension="inertia", low=0.0)
        wanted[f"{gear.kind}.stiffness"] = _above("rotational stiffness")
        wanted[f"{gear.kind}.damping"] = Quantity(dimension="rotational damping", low=0.0)
    for brake in model.brakes:
        lengths += brake.levers
    for terms in lengths:
        for term in terms:
            wanted.setdefault(term.number, Quantity(dimension="length"))
    return wanted


def _inertia(body: Body) -> Iterator[tuple[str, Quantity]]:
    """Moments of inertia of a body; in their place it may have radii of gyration."""
    if body.joint in ("wheelset", "rotor"):
        yield from ((f"inertia_{which}", _above("inertia")) for which in ("transverse", "axial"))
        return
    for axis in _AXES:
        yield f"inertia_{axis}", Quantity(dimension="inertia", low=0.0, low_is_allowed=False, optional=True)
        yield f"gyration_{axis}", Quantity(dimension="length", low=0.0, low_is_allowed=False, optional=True)
