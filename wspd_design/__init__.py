"""Design, prove and validate controllers for railway wheel slide protection.

The names below are loaded when they are first used, so that importing the package costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from wspd_design.analysis.linearization import Linearization, linearize
    from wspd_design.certificates.records import Certificate, Problem, Status
    from wspd_design.certificates.suite import verify
    from wspd_design.controllers.protocol import Command, Controller, Measurement
    from wspd_design.design.catalog import controller
    from wspd_design.design.certification import certify, check
    from wspd_design.design.file import read_design, write_design
    from wspd_design.design.own_controller import load_controller
    from wspd_design.design.problem import stability_problem
    from wspd_design.design.records import Design, Specification
    from wspd_design.design.selection import design_controller
    from wspd_design.parameters.errors import UserError, WspdError
    from wspd_design.parameters.loading import load_entries, load_rail, load_vehicle
    from wspd_design.parameters.records import Rail, Vehicle
    from wspd_design.reporting.report import write_report
    from wspd_design.simulation.campaign import simulate_many
    from wspd_design.simulation.comparison import compare, trial
    from wspd_design.simulation.draws import Choice, Draw, Normal, Uniform, within_bounds
    from wspd_design.simulation.ideal import ideal_stop
    from wspd_design.simulation.records import Scenario, Start
    from wspd_design.simulation.stop import simulate
    from wspd_design.studies.dossier import dossier

_HOME = {
    "Certificate": "certificates.records",
    "Choice": "simulation.draws",
    "Command": "controllers.protocol",
    "Controller": "controllers.protocol",
    "Design": "design.records",
    "Draw": "simulation.draws",
    "Linearization": "analysis.linearization",
    "Measurement": "controllers.protocol",
    "Normal": "simulation.draws",
    "Problem": "certificates.records",
    "Rail": "parameters.records",
    "Scenario": "simulation.records",
    "Specification": "design.records",
    "Start": "simulation.records",
    "Status": "certificates.records",
    "Uniform": "simulation.draws",
    "UserError": "parameters.errors",
    "Vehicle": "parameters.records",
    "WspdError": "parameters.errors",
    "certify": "design.certification",
    "check": "design.certification",
    "compare": "simulation.comparison",
    "controller": "design.catalog",
    "design_controller": "design.selection",
    "dossier": "studies.dossier",
    "ideal_stop": "simulation.ideal",
    "linearize": "analysis.linearization",
    "load_controller": "design.own_controller",
    "load_entries": "parameters.loading",
    "load_rail": "parameters.loading",
    "load_vehicle": "parameters.loading",
    "read_design": "design.file",
    "simulate": "simulation.stop",
    "simulate_many": "simulation.campaign",
    "stability_problem": "design.problem",
    "trial": "simulation.comparison",
    "verify": "certificates.suite",
    "within_bounds": "simulation.draws",
    "write_design": "design.file",
    "write_report": "reporting.report",
}

__all__ = [
    "Certificate",
    "Choice",
    "Command",
    "Controller",
    "Design",
    "Draw",
    "Linearization",
    "Measurement",
    "Normal",
    "Problem",
    "Rail",
    "Scenario",
    "Specification",
    "Start",
    "Status",
    "Uniform",
    "UserError",
    "Vehicle",
    "WspdError",
    "certify",
    "check",
    "compare",
    "controller",
    "design_controller",
    "dossier",
    "ideal_stop",
    "linearize",
    "load_controller",
    "load_entries",
    "load_rail",
    "load_vehicle",
    "read_design",
    "simulate",
    "simulate_many",
    "stability_problem",
    "trial",
    "verify",
    "within_bounds",
    "write_design",
    "write_report",
]


def __getattr__(name: str) -> Any:
    """Load a public name from its module."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return __all__
