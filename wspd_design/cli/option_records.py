"""Options that several commands share as records: names, help and defaults stand once.

A command takes a parameter of a record, such as ``disturbances: StopOptions``, and the decorator :func:`takes_records`,
which puts the fields of the record into its signature in place of it.
"""

import inspect
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import wraps
from typing import Any, get_type_hints


def takes_records(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the options of its records in place of the parameters that stand for them."""
    own = get_type_hints(command, include_extras=True)
    records: dict[str, type] = {}
    parameters = []
    for parameter in inspect.signature(command).parameters.values():
        annotation = own[parameter.name]
        if isinstance(annotation, type) and is_dataclass(annotation):
            records[parameter.name] = annotation
            hints = get_type_hints(annotation, include_extras=True)
            parameters += [
                _parameter(each.name, hints[each.name], each.default) for each in fields(annotation)
            ]
        else:
            parameters.append(_parameter(parameter.name, annotation, parameter.default))

    @wraps(command)
    def with_options(**given: Any) -> None:
        made = {
            name: record(**{each.name: given.pop(each.name, each.default) for each in fields(record)})
            for name, record in records.items()
        }
        command(**given, **made)

    del with_options.__wrapped__  # its hints are not those of this signature
    with_options.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    with_options.__annotations__ = {each.name: each.annotation for each in parameters}
    return with_options


def _parameter(name: str, annotation: Any, default: Any) -> inspect.Parameter:
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation)
