"""Fingerprints: the SHA-256 of everything that a result rests on.

Numbers count to their last bit, records by their fields, and an object of a user's class by its attributes and by
what Python made of its methods. What has no certain content is refused: a fingerprint that misses something would
let an old verdict stand for a new law.
"""

import hashlib
import inspect
import sys
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from fractions import Fraction
from functools import partial
from pathlib import PurePath
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType
from typing import Any

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Brake, Contact, Rail, Vehicle

_PACKAGE = __name__.partition(".")[0]
_PLAIN = (bool, int, str, bytes, complex, Fraction, type(None), type(Ellipsis))
_NO_CONTENT = ("__dict__", "__weakref__", "__doc__", "__abstractmethods__", "_abc_impl")


def fingerprint(*values: Any) -> str:
    """Return the SHA-256 of values.

    Parameters
    ----------
    *values : any
        Numbers, text, enums, tuples, lists, dictionaries, sets, arrays, dataclasses, functions, classes, and objects
        made of them.

    Returns
    -------
    str
        64 hexadecimal digits, the same in every run for the same content.

    Raises
    ------
    UserError
        If something in a value has no content that can be told, such as an open file.
    """
    return hashlib.sha256(_text(tuple(values), ()).encode()).hexdigest()


def _text(value: Any, above: tuple[int, ...]) -> str:
    """Text that is the same for the same content; ``above`` are the objects that contain the value."""
    if isinstance(value, Enum):
        return f"{_name(type(value))}.{value.name}"
    if isinstance(value, float):
        return float(value).hex()
    if isinstance(value, _PLAIN) and type(value) in _PLAIN:
        return f"{type(value).__name__}:{value!r}"
    if id(value) in above:
        return f"level {len(above) - above.index(id(value))} above"
    inside = partial(_text, above=(*above, id(value)))
    if isinstance(value, tuple | list):
        return f"{_name(type(value))}({','.join(map(inside, value))})"
    if isinstance(value, set | frozenset):
        return f"{_name(type(value))}({','.join(sorted(map(inside, value)))})"
    if isinstance(value, Mapping):
        pairs = sorted(f"{inside(key)}={inside(item)}" for key, item in value.items())
        return f"{_name(type(value))}({','.join(pairs)})"
    if isinstance(value, PurePath):
        return f"path:{value.as_posix()!r}"
    if type(value).__module__.partition(".")[0] == "numpy" and hasattr(value, "dtype"):
        return _array(value, inside)
    if isinstance(value, ModuleType):
        return f"module:{value.__name__}({'' if _is_library(value.__name__) else _file(value)})"
    if isinstance(value, type):
        return _class(value, inside)
    if isinstance(value, FunctionType | MethodType | partial | BuiltinFunctionType):
        return _function(value, inside)
    if isinstance(value, property | staticmethod | classmethod):
        parts = [getattr(value, part, None) for part in ("fget", "fset", "__func__")]
        return f"{type(value).__name__}({','.join(map(inside, parts))})"
    return _object(value, inside)


def _name(kind: type) -> str:
    return f"{kind.__module__}.{kind.__qualname__}"


def _array(value: Any, inside: Any) -> str:
    if value.dtype.hasobject:
        return f"array{value.shape}({inside(value.tolist())})"
    return f"array{value.shape}{value.dtype.str}({value.tobytes().hex()})"


def _object(value: Any, inside: Any) -> str:
    """Fields of a record; class and attributes of any other object."""
    kind = type(value)
    names = [field.name for field in fields(value)] if is_dataclass(value) else []
    slots = [
        name
        for base in kind.__mro__
        for name in _as_tuple(base.__dict__.get("__slots__", ()))
        if hasattr(value, name) and name not in _NO_CONTENT
    ]
    found = sorted({*names, *slots, *getattr(value, "__dict__", {})} - _absent(value))
    if not found and not _is_written_in_python(kind):
        raise UserError(
            f"an object of the class {_name(kind)} has no content that can be told apart from another one; "
            "keep numbers, text, tuples, lists, dictionaries and arrays in a controller"
        )
    content = ",".join(f"{name}={inside(getattr(value, name))}" for name in found)
    return f"{inside(kind)}({content})"


def _absent(value: Any) -> set[str]:
    """Names of what a vehicle or rail does not have.

    What a file may leave out has a default that says there is no such thing: a vehicle without it keeps the
    fingerprint that it had before such things were known. The name of a multibody file says nothing of its content,
    which counts for what uses it.
    """
    if not isinstance(value, Vehicle | Brake | Contact | Rail):
        return set()
    return {
        field.name
        for field in fields(value)
        if (field.name != "bounds" and field.default == getattr(value, field.name))
        or field.name == "multibody"
    }


def _as_tuple(slots: Any) -> tuple[str, ...]:
    return (slots,) if isinstance(slots, str) else tuple(slots)


def _is_written_in_python(kind: type) -> bool:
    return any(isinstance(item, FunctionType) for item in vars(kind).values())


def _class(kind: type, inside: Any) -> str:
    """Name of a class of this package, of Python or of a library; of any other class also what it does.

    What was put into a class of this package from outside belongs to its content.
    """
    if _is_library(kind.__module__):
        foreign = "".join(
            f",{name}={inside(item)}"
            for name, item in sorted(vars(kind).items())
            if isinstance(item, FunctionType) and not _is_library(item.__module__)
        )
        return f"class:{_name(kind)}{foreign}"
    bases = ",".join(inside(base) for base in kind.__bases__)
    members = ",".join(
        f"{name}={inside(item)}"
        for name, item in sorted(vars(kind).items())
        if name not in _NO_CONTENT and _counts(name, item)
    )
    return f"class:{_name(kind)}[{bases}]({members})"


def _counts(name: str, item: Any) -> bool:
    """Whether a member says what a class does, and is not made anew in every run."""
    if name.startswith("__") and not isinstance(item, FunctionType):
        return False
    return type(item).__name__ not in ("member_descriptor", "getset_descriptor", "wrapper_descriptor")


def _function(value: Any, inside: Any) -> str:
    if isinstance(value, partial):
        return f"partial({inside(value.func)},{inside(value.args)},{inside(value.keywords)})"
    if isinstance(value, MethodType):
        return f"method({inside(value.__func__)},{inside(value.__self__)})"
    if isinstance(value, BuiltinFunctionType):
        return f"function:{value.__module__}.{value.__qualname__}"
    if _is_library(value.__module__):
        return f"function:{value.__module__}.{value.__qualname__}"
    parts = (value.__defaults__, value.__kwdefaults__, [_cell(cell) for cell in value.__closure__ or ()])
    used = {name: value.__globals__[name] for name in _names(value.__code__) if name in value.__globals__}
    return f"function({_code(value.__code__, inside)},{','.join(map(inside, parts))},{inside(used)})"


def _cell(cell: Any) -> Any:
    try:
        return cell.cell_contents
    except ValueError:
        return "empty cell"


def _names(code: CodeType) -> set[str]:
    inner = [_names(each) for each in code.co_consts if isinstance(each, CodeType)]
    return {*code.co_names}.union(*inner)


def _is_library(module: str | None) -> bool:
    """Whether a module belongs to this package, to Python or to what is installed beside it."""
    top = (module or "builtins").partition(".")[0]
    if top == _PACKAGE or (top in sys.stdlib_module_names and top != "__main__"):
        return True
    file = getattr(sys.modules.get(top), "__file__", None)
    return file is not None and "site-packages" in PurePath(file).parts


def _file(module: ModuleType) -> str:
    try:
        return inspect.getsource(module)
    except (OSError, TypeError):
        raise UserError(
            f"the module {module.__name__}, which a controller uses, has no source that can be read; "
            "keep it in a file ending in .py"
        ) from None


def _code(code: CodeType, inside: Any) -> str:
    """What Python made of a function: unlike its source always there, and another one for two in the same line."""
    constants = ",".join(
        _code(each, inside) if isinstance(each, CodeType) else inside(each) for each in code.co_consts
    )
    return f"code({code.co_code.hex()},{constants},{code.co_names},{code.co_varnames})"
