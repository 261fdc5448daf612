"""A controller from a user's own Python file, ``my_file.py:MyController``."""

import inspect
import math
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from wspd_design.controllers.protocol import Command, Law, Measurement, VehicleMeasurement, acts_on_vehicle
from wspd_design.design.records import Specification
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle

_MODULE_PREFIX = "wspd_own_controller."
_ATTRIBUTES = ("name", "sample_time", "start", "step")
_PROBES = tuple(Measurement(speed, speed * ratio, 2e4) for speed in (30.0, 10.0) for ratio in (1.8, 1.2, 0.1))
_PRESSURES = 2e5, 6e5  # Pa, of a brake cylinder and of the reservoir while it is probed
_HOW = "see wspd docs own-controller"


def is_own_controller(name: str) -> bool:
    """Tell whether a controller is given by a Python file."""
    return name.endswith(".py") or name.rpartition(":")[0].endswith(".py")


def load_controller(
    name: str,
    *,
    vehicle: Vehicle,
    rail: Rail,
    slip: float | None = None,
    sample_time: float | None = None,
) -> Law:
    """Load a controller of a wheelset or of a vehicle from a Python file.

    A class or function that makes the controller is given what it has parameters for, by these names.

    Parameters
    ----------
    name : str
        ``FILE.py:NAME``. NAME is a controller, or a class or function that makes one.
    vehicle : Vehicle
        The vehicle it shall brake.
    rail : Rail
        Of the stop.
    slip : float, optional
        Slip reference [-]. Without it the default of the controller holds, or the paper's if it has none.
    sample_time : float, optional
        As ``slip`` [s].

    Raises
    ------
    UserError
        If the file fails or what it gives is not a controller.
    """
    found = _found(name)
    options, written = _options(vehicle, rail, slip, sample_time)
    made: Any = found if _is_controller(found) else _make(found, name, options, written)
    _check(made, name, vehicle)
    return made  # type: ignore[no-any-return]


@dataclass(frozen=True, slots=True, kw_only=True)
class TunableController:
    """A class or function of a user that makes controllers, with the numbers that it can be given."""

    numbers: Mapping[str, float]  # parameters whose default is a number above 0, with it
    named: bool  # whether it can be given a name
    make: Callable[[Mapping[str, object]], Law]


def tunable_controller(
    name: str, *, vehicle: Vehicle, rail: Rail, slip: float, sample_time: float
) -> TunableController:
    """Load what makes controllers from a Python file, and see what numbers it can be given.

    Parameters
    ----------
    name : str
        ``FILE.py:NAME``; NAME is a class or function. Its parameters with a number above 0 as default can be varied,
        and its slip, if it takes one.
    vehicle, rail, slip, sample_time
        As of :func:`load_controller`; the slip is the value that a search starts from.

    Raises
    ------
    UserError
        If the file fails, or nothing in it can be varied.
    """
    found = _found(name)
    if _is_controller(found) or not callable(found):
        raise UserError(
            f"{name} has no numbers to vary; let NAME be a class or function whose parameters have numbers as defaults"
        )
    parameters = inspect.signature(found).parameters
    numbers = {
        each.name: float(each.default)
        for each in parameters.values()
        if isinstance(each.default, float) and each.default > 0.0 and each.name != "sample_time"
    }
    if "slip" in parameters:
        numbers["slip"] = slip
    if not numbers:
        raise UserError(f"{name} has no numbers to vary; give its parameters numbers above 0 as defaults")

    def make(given: Mapping[str, object]) -> Law:
        options, written = _options(vehicle, rail, None, sample_time)
        made: Any = _make(found, name, {**options, **given}, {**written, **given})
        _check(made, name, vehicle)
        return made  # type: ignore[no-any-return]

    return TunableController(numbers=numbers, named="name" in parameters, make=make)


def _options(
    vehicle: Vehicle, rail: Rail, slip: float | None, sample_time: float | None
) -> tuple[dict[str, object], dict[str, object]]:
    """Return what a controller can ask for, and what of it was written."""
    paper = Specification()
    wanted = {
        "vehicle": vehicle,
        "rail": rail,
        "wheelsets": vehicle.wheelsets,
        "slip": slip,
        "sample_time": sample_time,
    }
    written = {key: value for key, value in wanted.items() if value is not None}
    return {"slip": paper.slip, "sample_time": paper.sample_time} | written, written


def _found(name: str) -> Any:
    """Return what stands behind a name in a file."""
    file, _, attribute = name.rpartition(":")
    if not file.endswith(".py"):
        raise UserError(f"{name} needs the name of the controller in it: {name}:NAME; {_HOW}")
    module = _run(Path(file))
    if not hasattr(module, attribute):
        own = [
            key for key, value in vars(module).items() if getattr(value, "__module__", "") == module.__name__
        ]
        raise UserError(f'{file} has no "{attribute}"; it defines {", ".join(own) or "nothing"}; {_HOW}')
    return getattr(module, attribute)


def fault_in_own_file(error: BaseException) -> str | None:
    """Say where a user's own file failed; None when the fault is not in such a file."""
    place, trace = None, error.__traceback__
    while trace is not None:
        frame = trace.tb_frame
        if frame.f_globals.get("__name__", "").startswith(_MODULE_PREFIX):
            place = f"{frame.f_code.co_filename}, line {trace.tb_lineno}"
        trace = trace.tb_next
    return place and f"{place}: {type(error).__name__}: {error}"


def _run(path: Path) -> ModuleType:
    """Run a file as a module; its folder can be imported from meanwhile, as for a script."""
    try:
        source = path.read_bytes()
    except OSError as error:
        raise UserError(f"cannot read {path} ({error.strerror}); check the path") from None
    module = ModuleType(_MODULE_PREFIX + path.stem)
    module.__file__ = str(path)
    sys.modules[module.__name__] = module  # dataclasses look their module up
    sys.path.insert(0, str(path.parent.absolute()))
    try:
        exec(compile(source, str(path), "exec"), module.__dict__)
    except SyntaxError as error:
        raise UserError(f"{path}, line {error.lineno}, is not Python: {error.msg}") from None
    except Exception as error:
        raise UserError(_fault(error, path.name)) from None
    finally:
        sys.path.pop(0)
    return module


def _is_controller(found: Any) -> bool:
    return not isinstance(found, type) and all(hasattr(found, key) for key in _ATTRIBUTES)


def _make(found: Any, name: str, options: Mapping[str, object], written: Mapping[str, object]) -> object:
    """Call a class or function with those options that it has parameters for."""
    if not callable(found):
        raise UserError(f"{name} is neither a controller nor a class or function that makes one; {_HOW}")
    given = {}
    for parameter in inspect.signature(found).parameters.values():
        by_name = parameter.kind in (parameter.POSITIONAL_OR_KEYWORD, parameter.KEYWORD_ONLY)
        needed = parameter.default is parameter.empty and parameter.kind not in (
            parameter.VAR_POSITIONAL,
            parameter.VAR_KEYWORD,
        )
        offered = options if needed else written
        if by_name and parameter.name in offered:
            given[parameter.name] = offered[parameter.name]
        elif needed:
            raise UserError(
                f'{name} asks for "{parameter.name}"; it can have {", ".join(options)} '
                "by these names, all else needs a default"
            )
    return _guarded(lambda: found(**given), name)


def _check(made: Any, name: str, vehicle: Vehicle) -> None:
    """Look at the attributes, and at what ``start`` and ``step`` do with numbers."""
    missing = [key for key in _ATTRIBUTES if not hasattr(made, key)]
    if missing:
        raise UserError(f"{name} does not make a controller: it lacks {', '.join(missing)}; {_HOW}")
    sampling = made.sample_time
    if not isinstance(sampling, int | float) or not 1e-3 <= sampling <= 1.0:
        raise UserError(f"sample_time = {sampling!r} of {name} must be a number between 0.001 and 1 s")
    whole = acts_on_vehicle(made)
    if whole and made.wheelsets != vehicle.wheelsets:
        raise UserError(
            f"wheelsets = {made.wheelsets!r} of {name} must be {vehicle.wheelsets}, as vehicle {vehicle.name} has; "
            "let it take wheelsets"
        )
    before = _content(made)
    seen = tuple(_of_vehicle(each, vehicle.wheelsets) for each in _PROBES) if whole else _PROBES
    results = _guarded(lambda: [_probe(made, each) for each in seen * 2], name)
    for states, following, commanded in results:
        commands = commanded if whole else (commanded,)
        if not isinstance(commands, tuple) or not all(isinstance(each, Command) for each in commands):
            wanted = "(Command(fill=..., vent=...), ...)" if whole else "Command(fill=..., vent=...)"
            raise UserError(f"step of {name} must return (state, {wanted}); {_HOW}")
        if whole and len(commands) != made.wheelsets:
            raise UserError(
                f"step of {name} returns {len(commands)} commands; it must return {made.wheelsets}, one for each "
                "wheelset, front first"
            )
        if len(states) != len(following):
            raise UserError(
                f"start of {name} returns {len(states)} states and step {len(following)}; both must return "
                "all that the controller remembers"
            )
        named = getattr(made, "memory", None) if whole else None
        if named is not None and len(named) != len(states):
            raise UserError(
                f"memory of {name} names {len(named)} elements of its state, which has {len(states)}; "
                "name each in its order, or leave memory out"
            )
        if not all(math.isfinite(number) for number in (*states, *following, *sum(commands, ()))):
            raise UserError(f"{name} returns a number that is not finite: {commanded}")
    half = len(_PROBES)
    if results[:half] != results[half:] or _content(made) != before:
        raise UserError(
            f"{name} changes from call to call; what it remembers must be in the state that step takes and "
            f"returns, and nothing may be random; {_HOW}"
        )


def _content(made: Any) -> tuple[str, list[Any]]:
    """What an object holds: all of it as text, and vehicles and rails, whose text is short, as they are."""
    held = getattr(made, "__dict__", {})
    return repr(held), [each for each in held.values() if isinstance(each, Vehicle | Rail)]


def _of_vehicle(seen: Measurement, wheelsets: int) -> VehicleMeasurement:
    """Return what a controller of a vehicle sees where every wheelset sees the same."""
    pressure, reservoir = _PRESSURES
    return VehicleMeasurement(
        speed=seen.speed,
        wheel_speeds=(seen.wheel_speed,) * wheelsets,
        torques=(seen.torque,) * wheelsets,
        healthy=(1.0,) * wheelsets,
        pressures=(pressure,) * wheelsets,
        acceleration=-1.0,
        demand=1.0,
        reservoir=reservoir,
    )


def _probe(made: Any, seen: Measurement | VehicleMeasurement) -> tuple[Any, Any, Any]:
    state = made.start(seen)
    following, command = made.step(state, seen)
    return tuple(map(float, state)), tuple(map(float, following)), command


def _guarded(work: Callable[[], Any], name: str) -> Any:
    try:
        return work()
    except Exception as error:  # the user's code may fail in any way
        raise UserError(_fault(error, name)) from None


def _fault(error: Exception, name: str) -> str:
    return fault_in_own_file(error) or f"{name}: {type(error).__name__}: {error}"
