"""One root of all errors: whoever catches it catches what this package raises on purpose.

Private errors are caught where they are raised. The stand-alone checker imports nothing of the package: what it refuses
becomes the reason of an answer, never an error of ``wd.check``.
"""

import inspect
import pkgutil
from importlib import import_module

import wspd_design
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.parameters.errors import UserError, WspdError


def test_every_error_of_the_package_is_below_the_root():
    modules = [
        import_module(found.name) for found in pkgutil.walk_packages(wspd_design.__path__, "wspd_design.")
    ]
    errors = {
        kind
        for module in modules
        for _, kind in inspect.getmembers(module, inspect.isclass)
        if issubclass(kind, BaseException)
        and not issubclass(kind, Warning)
        and kind.__module__.startswith("wspd_design.")
    }
    assert {UserError, WspdError} < errors
    public = {kind for kind in errors if not kind.__name__.startswith("_")} - {Refused}
    assert [kind.__qualname__ for kind in public if not issubclass(kind, WspdError)] == []
    assert issubclass(UserError, ValueError)
