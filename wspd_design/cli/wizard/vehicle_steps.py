"""The questions that lead to a vehicle file, each with the range that railways have."""

from collections.abc import Callable
from dataclasses import replace

from wspd_design.analysis.stopping import demanded_adhesion
from wspd_design.cli.wizard.steps import Answers, Option, Step, review_step
from wspd_design.cli.wizard.vehicle_answers import KIND, NO, NONE, READERS, YES, wanted_vehicle
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.gear import gear_of
from wspd_design.parameters.loading import available, load_entries, load_vehicle
from wspd_design.parameters.units import dimension_of, format_quantity
from wspd_design.studies.new_vehicle import ELECTRIC, PIPE, Wanted, derived_vehicle, wanted_like


def vehicle_steps() -> tuple[Step, ...]:
    """Return all questions in their order."""
    kinds = tuple(
        Option(value=name, text=load_entries("vehicle", name).title)
        for name in available("vehicle")
        if name != "er24pc"  # whose brake no railway has
    )
    return (
        Step(
            key="kind",
            help="wspd sources NAME shows every number of a shipped vehicle with its source.",
            title="Kind",
            explanation="The shipped vehicle that yours is most like. It suggests the answers below, and gives what is "
            "not asked, such as heights and springs; the file says so at each number.",
            default=KIND,
            options=kinds,
        ),
        _line(
            "mass", "Empty mass", "Ready to run, without load.", lambda like: format_quantity(like.mass, "t")
        ),
        Step(
            key="laden_mass",
            dimension="mass",
            title="Laden mass",
            explanation=f'With passengers or goods, or "{NONE}". "FILE:laden" is then the laden vehicle.',
            default=NONE,
            suggest=_suggested(
                lambda like: format_quantity(like.laden_mass, "t") if like.laden_mass else NONE
            ),
            check=_echo(
                "laden_mass", lambda wanted: f"{wanted.laden_mass:.6g} kg" if wanted.laden_mass else NONE
            ),
        ),
        Step(
            key="weighs",
            title="Load-dependent brake",
            explanation="Whether the brake weighs the load and gives the laden vehicle the same deceleration.",
            default=YES,
            options=(
                Option(value=YES, text="the same deceleration empty and laden"),
                Option(value=NO, text="the same torque empty and laden"),
            ),
            suggest=_suggested(lambda like: YES if like.weighs else NO),
            applies=lambda answers: answers.get("laden_mass", NONE) != NONE,
        ),
        Step(
            key="axles",
            help="A whole number.",
            title="Axles",
            explanation="Of the whole vehicle; how many stand in a bogie follows from the kind.",
            default="4",
            suggest=_suggested(lambda like: str(like.wheelsets)),
            check=_echo("axles", _gear),
        ),
        _line(
            "bogie_spacing",
            "Distance of the bogies",
            "From centre to centre; of single axles, their distance.",
            lambda like: format_quantity(like.bogie_spacing, "m"),
        ),
        Step(
            key="wheelbase",
            dimension="length",
            title="Wheelbase of a bogie",
            explanation="From its first to its last axle.",
            default="2.5 m",
            suggest=_suggested(lambda like: format_quantity(like.wheelbase, "m")),
            check=_echo("wheelbase", lambda wanted: f"{wanted.wheelbase:.4g} m"),
            applies=lambda answers: wanted_like(answers.get("kind", KIND)).wheelbase > 0.0,
        ),
        Step(
            key="wheel_diameter",
            dimension="length",
            title="Wheel diameter",
            explanation="Of new wheels; worn ones follow as the lower bound.",
            default="920 mm",
            suggest=_suggested(lambda like: format_quantity(like.wheel_diameter, "mm")),
            check=_echo("wheel_diameter", lambda wanted: f"radius {wanted.wheel_diameter / 2.0:.4g} m"),
        ),
        Step(
            key="rotating_mass",
            dimension="mass",
            title="Rotating mass",
            explanation="What all that turns adds to the mass of the train, of the whole vehicle: a mass, or % of the "
            "empty one. Trailers have 4 to 8 %, driven vehicles 8 to 15 %.",
            default="5 %",
            suggest=_suggested(lambda like: f"{100.0 * like.rotating_mass / like.mass:.3g} %"),
            check=_echo(
                "rotating_mass",
                lambda wanted: (
                    f"{wanted.rotating_mass:.4g} kg, {100.0 * wanted.rotating_mass / wanted.mass:.3g} % of "
                    "the empty mass"
                ),
            ),
        ),
        _line(
            "speed",
            "Speed",
            "From which the deceleration holds: the resistance counts with its mean.",
            lambda like: format_quantity(like.speed, "km/h"),
        ),
        Step(
            key="deceleration",
            dimension="acceleration",
            title="Deceleration",
            explanation="Mean of the fully developed brake, dry and level, after EN 14531: it gives the torque.",
            default="1.2 m/s^2",
            suggest=_suggested(lambda like: f"{like.deceleration:.3g} m/s^2"),
            check=_echo("deceleration", _torque),
        ),
        Step(
            key="build_up",
            title="Build-up of the brake",
            explanation="How the demand for pressure comes to the vehicle.",
            default=PIPE,
            options=(
                Option(value=PIPE, text="by the main pipe, as an exponential"),
                Option(value=ELECTRIC, text="by wire: a dead time, then an even ramp"),
            ),
            suggest=_suggested(lambda like: like.build_up),
        ),
        Step(
            key="build_up_delay",
            dimension="time",
            title="Dead time of the demand",
            explanation="Until the demand begins to rise.",
            default="0.2 s",
            suggest=_suggested(lambda like: f"{like.build_up_delay or 0.2:.4g} s"),
            check=_echo("build_up_delay", lambda wanted: f"{wanted.build_up_delay:.4g} s"),
            applies=lambda answers: answers.get("build_up") == ELECTRIC,
        ),
        Step(
            key="build_up_time",
            dimension="time",
            title="Time of the build-up",
            explanation="By the main pipe, until 95 % of the pressure: position P has 3 to 5 s. By wire, the time of "
            "the ramp: about 1 s.",
            default="4 s",
            suggest=_time_of_build_up,
            check=_echo("build_up_time", lambda wanted: f"{wanted.build_up_time:.4g} s"),
        ),
        _line(
            "fill_time",
            "Filling of the cylinder",
            "Time constant T_F with which the valve of the protection fills the cylinder, as a first-order lag.",
            lambda like: format_quantity(like.fill_time, "s"),
        ),
        _line(
            "vent_time",
            "Venting of the cylinder",
            "Time constant T_V with which it vents; dump valves vent faster than they fill.",
            lambda like: format_quantity(like.vent_time, "s"),
        ),
        review_step(
            "Saving works out all other numbers and writes the vehicle file.", "work out the rest and save"
        ),
    )


def _suggested(text: Callable[[Wanted], str]) -> Callable[[Answers], str]:
    """Suggest what the kind has, in proportion to the mass where that is another one."""

    def suggest(answers: Answers) -> str:
        like = wanted_like(answers.get("kind", KIND))
        mass = wanted_vehicle({key: answers[key] for key in ("kind", "mass") if key in answers}).mass
        if like.laden_mass and mass != like.mass:
            like = replace(like, laden_mass=float(f"{like.laden_mass / like.mass * mass:.3g}"))
        return text(like)

    return suggest


def _time_of_build_up(answers: Answers) -> str:
    like = wanted_like(answers.get("kind", KIND))
    if answers.get("build_up", like.build_up) == like.build_up:
        return f"{like.build_up_time:.4g} s"
    return "1 s" if like.build_up == PIPE else "4 s"


def _echo(key: str, say: Callable[[Wanted], str]) -> Callable[[str, Answers], str]:
    """Say what the program understands of an answer; later answers give way to it."""

    def check(text: str, answers: Answers) -> str:
        earlier = list(READERS)[: list(READERS).index(key)]
        kept = {each: answers[each] for each in ("kind", *earlier) if each in answers}
        return say(wanted_vehicle(kept | {key: text}))

    return check


def _line(key: str, title: str, explanation: str, text: Callable[[Wanted], str]) -> Step:
    """Return a question for a quantity, which is echoed in SI units."""

    def say(wanted: Wanted) -> str:
        value = getattr(wanted, key)
        return f"{value:.6g} {_UNITS[key]}"

    return Step(
        key=key,
        title=title,
        explanation=explanation,
        default="",
        dimension=dimension_of(_UNITS[key]),
        suggest=_suggested(text),
        check=_echo(key, say),
    )


_UNITS = {
    "mass": "kg",
    "bogie_spacing": "m",
    "speed": "m/s",
    "fill_time": "s",
    "vent_time": "s",
}


def _gear(wanted: Wanted) -> str:
    axles = gear_of(load_vehicle(wanted.kind)).axles
    if wanted.wheelsets % axles:
        raise UserError(
            f"axles = {wanted.wheelsets} must be a multiple of {axles}, the axles of a bogie of a {wanted.kind}"
        )
    if axles == 1:
        return f"{wanted.wheelsets} single axles"
    if wanted.wheelsets == axles:
        raise UserError(
            f"axles = {wanted.wheelsets} make one bogie, on which no body stands; write {2 * axles}"
        )
    return f"{wanted.wheelsets} axles in {wanted.wheelsets // axles} bogies of {axles}"


def _torque(wanted: Wanted) -> str:
    made = derived_vehicle("yours", wanted)
    return (
        f"a torque of {made.brake.max_torque / 1e3:.4g} kN m at each braked wheelset, which asks for an adhesion of "
        f"{demanded_adhesion(made):.3f}"
    )
