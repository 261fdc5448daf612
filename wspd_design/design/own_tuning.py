"""Tuning of laws from Python files: what can be varied of them, and the file that holds what was found."""

from pathlib import Path

from wspd_design.design.finding import Found
from wspd_design.design.own_controller import TunableController, tunable_controller
from wspd_design.design.ranges import USUAL
from wspd_design.design.search.run import Space
from wspd_design.design.search.variables import Variable
from wspd_design.design.specification_file import Task
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle


def own_space(name: str, task: Task, vehicle: Vehicle, rail: Rail) -> tuple[Space, TunableController]:
    """Return what a search may vary of a law from a Python file, a factor 4 about each of its numbers.

    Parameters
    ----------
    name : str
        ``FILE.py:NAME``, a class or function.
    task : Task
        With the sample time that the law has to take.
    vehicle, rail
        What the law is made for.

    Raises
    ------
    UserError
        If the file cannot be imported by name, nothing can be varied, or the law has another sample time.
    """
    if not Path(name.rpartition(":")[0]).stem.isidentifier():
        raise UserError(
            f"{name} cannot be imported by the file that holds what is found; rename it to a Python name"
        )
    wanted = task.specification
    own = tunable_controller(
        name, vehicle=vehicle, rail=rail, slip=wanted.slip, sample_time=wanted.sample_time
    )
    start = own.make(own.numbers)
    if start.sample_time != wanted.sample_time:
        raise UserError(
            f"{name} has a sample time of {start.sample_time:g} s, {task.name} one of {wanted.sample_time:g} s; let it "
            "take sample_time"
        )
    variables = tuple(
        Variable(
            name=each,
            unit="-",
            low=USUAL.low * value,
            high=min(USUAL.high * value, 0.99) if each == "slip" else USUAL.high * value,
            start=value,
            log=True,
            factor=False,
            why=USUAL.why,
        )
        for each, value in own.numbers.items()
    )
    names = [each.name for each in variables]
    return (
        Space(
            law=start.name,
            variables=variables,
            build=lambda values: own.make(dict(zip(names, values, strict=True))),
        ),
        own,
    )


def tuned_source(law: str, name: str, own: TunableController, found: Found) -> str:
    """Return a Python file that makes the law with the numbers that were found.

    Parameters
    ----------
    law : str
        ``FILE.py:NAME`` of the law.
    name : str
        That says the effort, for a law that can be given one.
    own : TunableController
        The law.
    found : Found
        The search.
    """
    file, _, attribute = law.rpartition(":")
    numbers = dict(zip((each.name for each in found.space.variables), found.chosen.values, strict=True))
    given = {"name": name, **numbers} if own.named else numbers
    effort, held_out = found.task.effort, found.task.requirements.held_out
    return "\n".join(
        (
            f'"""{name}: {attribute} of {Path(file).name} with the numbers of a search.',
            "",
            f"{effort.evaluations} evaluations ({effort.method}) on {effort.sets.sets} sets, seed {effort.sets.seed};",
            f"on {held_out.sets} held-out sets of seed {held_out.seed}",
            f"the mean efficiency is {found.held_out.reached['efficiency_mean']:.4f}, at the start "
            f"{found.held_out_start.reached['efficiency_mean']:.4f}.",
            '"""',
            "",
            "from functools import partial",
            "",
            f"from {Path(file).stem} import {attribute}",
            "",
            "tuned = partial(",
            f"    {attribute},",
            *(f"    {key}={value!r}," for key, value in given.items()),
            ")",
            "",
        )
    )
