"""Design, prove and validate controllers for railway wheel slide protection.

The names below are loaded when they are first used, so that importing the package costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from wspd_design.analysis.linearization import Linearization, linearize
    from wspd_design.analysis.vehicle_modes import vehicle_modes
    from wspd_design.certificates.records import Certificate, Certificates, Problem, Status
    from wspd_design.certificates.suite import verify
    from wspd_design.controllers.protocol import Command, Controller, Measurement
    from wspd_design.design.catalog import baselines, controller
    from wspd_design.design.certification import certify, check
    from wspd_design.design.file import read_design, write_design
    from wspd_design.design.own_controller import load_controller
    from wspd_design.design.problem import stability_problem
    from wspd_design.design.records import Design, Gain, Specification
    from wspd_design.design.selection import design_controller
    from wspd_design.exchange.python_control import (
        law_start,
        law_system,
        linear_law,
        quarter_system,
        slip_system,
        vehicle_system,
    )
    from wspd_design.parameters.errors import UserError, WspdError
    from wspd_design.parameters.loading import load_entries, load_rail, load_vehicle
    from wspd_design.parameters.records import Brake, Rail, Vehicle
    from wspd_design.parameters.table import Table
    from wspd_design.plotting.poles import plot_poles
    from wspd_design.reporting.report import write_report
    from wspd_design.simulation.campaign import Campaign, simulate_many
    from wspd_design.simulation.comparison import Comparison, Trial, compare, trial
    from wspd_design.simulation.draws import Choice, Draw, Normal, Uniform, within_bounds
    from wspd_design.simulation.ideal import ideal_stop
    from wspd_design.simulation.metrics import Metrics
    from wspd_design.simulation.records import Fault, Patch, Scenario, Sensing, Start
    from wspd_design.simulation.runs import Ending, Run
    from wspd_design.simulation.stop import simulate
    from wspd_design.simulation.trace_table import Traces
    from wspd_design.studies.dossier import dossier

    __version__: str

_HOME = {
    "Brake": "parameters.records",
    "Campaign": "simulation.campaign",
    "Certificate": "certificates.records",
    "Certificates": "certificates.records",
    "Choice": "simulation.draws",
    "Command": "controllers.protocol",
    "Comparison": "simulation.comparison",
    "Controller": "controllers.protocol",
    "Design": "design.records",
    "Draw": "simulation.draws",
    "Ending": "simulation.runs",
    "Fault": "simulation.records",
    "Gain": "design.records",
    "Linearization": "analysis.linearization",
    "Measurement": "controllers.protocol",
    "Metrics": "simulation.metrics",
    "Normal": "simulation.draws",
    "Patch": "simulation.records",
    "Problem": "certificates.records",
    "Rail": "parameters.records",
    "Run": "simulation.runs",
    "Scenario": "simulation.records",
    "Sensing": "simulation.records",
    "Specification": "design.records",
    "Start": "simulation.records",
    "Status": "certificates.records",
    "Table": "parameters.table",
    "Traces": "simulation.trace_table",
    "Trial": "simulation.comparison",
    "Uniform": "simulation.draws",
    "UserError": "parameters.errors",
    "Vehicle": "parameters.records",
    "WspdError": "parameters.errors",
    "baselines": "design.catalog",
    "certify": "design.certification",
    "check": "design.certification",
    "compare": "simulation.comparison",
    "controller": "design.catalog",
    "design_controller": "design.selection",
    "dossier": "studies.dossier",
    "ideal_stop": "simulation.ideal",
    "law_start": "exchange.python_control",
    "law_system": "exchange.python_control",
    "linear_law": "exchange.python_control",
    "linearize": "analysis.linearization",
    "load_controller": "design.own_controller",
    "load_entries": "parameters.loading",
    "load_rail": "parameters.loading",
    "load_vehicle": "parameters.loading",
    "plot_poles": "plotting.poles",
    "quarter_system": "exchange.python_control",
    "read_design": "design.file",
    "simulate": "simulation.stop",
    "simulate_many": "simulation.campaign",
    "slip_system": "exchange.python_control",
    "stability_problem": "design.problem",
    "trial": "simulation.comparison",
    "vehicle_modes": "analysis.vehicle_modes",
    "vehicle_system": "exchange.python_control",
    "verify": "certificates.suite",
    "within_bounds": "simulation.draws",
    "write_design": "design.file",
    "write_report": "reporting.report",
}

__all__ = [
    "Brake",
    "Campaign",
    "Certificate",
    "Certificates",
    "Choice",
    "Command",
    "Comparison",
    "Controller",
    "Design",
    "Draw",
    "Ending",
    "Fault",
    "Gain",
    "Linearization",
    "Measurement",
    "Metrics",
    "Normal",
    "Patch",
    "Problem",
    "Rail",
    "Run",
    "Scenario",
    "Sensing",
    "Specification",
    "Start",
    "Status",
    "Table",
    "Traces",
    "Trial",
    "Uniform",
    "UserError",
    "Vehicle",
    "WspdError",
    "__version__",
    "baselines",
    "certify",
    "check",
    "compare",
    "controller",
    "design_controller",
    "dossier",
    "ideal_stop",
    "law_start",
    "law_system",
    "linear_law",
    "linearize",
    "load_controller",
    "load_entries",
    "load_rail",
    "load_vehicle",
    "plot_poles",
    "quarter_system",
    "read_design",
    "simulate",
    "simulate_many",
    "slip_system",
    "stability_problem",
    "trial",
    "vehicle_modes",
    "vehicle_system",
    "verify",
    "within_bounds",
    "write_design",
    "write_report",
]


def __getattr__(name: str) -> Any:
    """Load a public name from its module."""
    if name == "__version__":
        return import_module(f"{__name__}.exchange.version").program_version()
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return __all__
