"""What a multibody vehicle must not contradict: bodies that exist, joints that fit, mass that is left."""

from collections.abc import Iterator

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.words import did_you_mean
from wspd_design.plants.multibody.records import Body, Multibody
from wspd_design.plants.multibody.schema import spring_keys

_SAME_PLACE = 1e-9  # m


def check_topology(model: Multibody, where: str) -> None:
    """Refuse bodies and elements that do not fit together.

    Raises
    ------
    UserError
        With the first contradiction that is found.
    """
    _check_bodies(model, where)
    for body in model.bodies:
        _check_joint(model, body, where)
    for what, name, joints in _references(model):
        body = _body(model, name, f"{what} in {where}")
        if body.joint not in joints:
            raise UserError(
                f'{what} in {where} names {name}, whose joint is "{body.joint}"; it must be {" or ".join(joints)}.'
            )
    braked = [brake.wheelset for brake in model.brakes]
    twice = next((name for name in braked if braked.count(name) > 1), "")
    if twice:
        raise UserError(f"{twice} in {where} has two brakes; give one brake all of their levers.")


def check_numbers(model: Multibody, where: str) -> None:
    """Refuse numbers with which the vehicle contradicts itself.

    Raises
    ------
    UserError
        With the first contradiction that is found.
    """
    rest = model.mass(model.body(model.remainder))
    if rest <= 0.0:
        raise UserError(
            f"mass = {model.numbers['mass']:g} kg in {where} leaves {rest:g} kg for {model.remainder}; it must exceed "
            "the sum of all other bodies."
        )
    for body in model.bodies:
        _check_inertia(model, body, where)
        _check_rotor(model, body, where)
    for spring in model.springs:
        stiffness = f"{spring.kind}.stiffness_z"
        if not any(f"{spring.kind}.{key}" in model.numbers for key, _ in spring_keys()):
            raise UserError(
                f"[springs.{spring.kind}] in {where} has neither stiffness nor damping; add [numbers.{stiffness}] "
                "or another component."
            )
        if spring.carries and stiffness not in model.numbers:
            raise UserError(
                f"[springs.{spring.kind}] in {where} carries weight without a vertical stiffness; add "
                f"[numbers.{stiffness}], or leave out carries."
            )
    for brake in model.brakes:
        if any(model.length(lever) == 0.0 for lever in brake.levers):
            raise UserError(
                f"[brakes.{brake.kind}] in {where} has a lever of zero length, and no force on it brakes; correct it."
            )


def _check_bodies(model: Multibody, where: str) -> None:
    names = [body.name for body in model.bodies]
    if not names or not model.wheelsets:
        raise UserError(
            f'{where} has no wheelset; add [bodies.wheelset] with joint = "wheelset", and each = the axles.'
        )
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise UserError(f"{where} has two bodies of the name {twice}; rename one of them.")
    if model.bodies[0].joint != "free":
        raise UserError(
            f"the first body of {where} is {names[0]}, which is not free; begin with the body whose speed is that of "
            "the vehicle."
        )
    if model.remainder not in names:
        raise UserError(
            f'remainder = "{model.remainder}" in {where} is no body{did_you_mean(model.remainder, names)}; name the '
            "body whose mass is that of the vehicle less all others."
        )


def _body(model: Multibody, name: str, what: str) -> Body:
    names = [body.name for body in model.bodies]
    if name not in names:
        raise UserError(f'{what} names the unknown body "{name}"{did_you_mean(name, names)}; correct it.')
    return model.body(name)


def _check_joint(model: Multibody, body: Body, where: str) -> None:
    what = f"[bodies.{body.kind}] in {where}"
    if not body.on:
        if body.axis is not None:
            raise UserError(f'axis of {what} means nothing with the joint "{body.joint}"; leave it out.')
        return
    parent = _body(model, body.on, f"on of {what}")
    allowed = ("free",) if body.joint == "rotor" else ("free", "wheelset")
    if parent.joint not in allowed:
        raise UserError(
            f'{body.name} of {what} turns on {parent.name}, whose joint is "{parent.joint}"; a {body.joint} turns on '
            f"a body whose joint is {' or '.join(allowed)}."
        )


def _check_rotor(model: Multibody, body: Body, where: str) -> None:
    if body.joint != "rotor":
        return
    other = model.body(body.on)
    axis = other.at if body.axis is None else body.axis
    if max(abs(each) for each in model.offset(body.at, axis)) > _SAME_PLACE:
        raise UserError(
            f"{body.name} of [bodies.{body.kind}] in {where} must have its center of gravity on its axis; make at and "
            f"axis equal, or without axis put both at the center of {other.name}."
        )


def _check_inertia(model: Multibody, body: Body, where: str) -> None:
    if body.joint in ("wheelset", "rotor"):
        return
    given = {
        form: [f"{body.kind}.{form}_{axis}" in model.numbers for axis in "xyz"]
        for form in ("inertia", "gyration")
    }
    if sum(all(each) for each in given.values()) != 1 or sum(any(each) for each in given.values()) != 1:
        raise UserError(
            f"[bodies.{body.kind}] in {where} must have either inertia_x, inertia_y, inertia_z or gyration_x, "
            f"gyration_y, gyration_z among [numbers.{body.kind}.*]; state three of one kind."
        )
    x, y, z = model.inertia(body)
    if not (x <= y + z and y <= x + z and z <= x + y):
        raise UserError(
            f"moments of inertia of {body.kind} in {where} are {x:g}, {y:g}, {z:g} kg m^2, and one exceeds the sum of "
            "the other two, which no body has; correct them."
        )


def _references(model: Multibody) -> Iterator[tuple[str, str, tuple[str, ...]]]:
    """Yield where a body is named, its name, and the joints that it may have."""
    solid = ("free", "wheelset", "revolute")
    for part, elements in (
        ("springs", model.springs),
        ("rods", model.rods),
        ("bump_stops", model.stops),
    ):
        for element in elements:
            yield from ((f"between of [{part}.{element.kind}]", name, solid) for name in element.between)
    for gear in model.gears:
        what = f"[gears.{gear.kind}]"
        yield f"housing of {what}", gear.housing, ("revolute",)
        yield f"rotor of {what}", gear.rotor, ("rotor",)
    for brake in model.brakes:
        yield f"frame of [brakes.{brake.kind}]", brake.frame, ("free", "revolute")
        yield f"wheelset of [brakes.{brake.kind}]", brake.wheelset, ("wheelset",)
