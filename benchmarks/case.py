"""The stop that all ways have to compute: four axles, printed adaptive fuzzy law, wet rail, from 120 km/h."""

import ctypes
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np

from wspd_design.codegen.closed_loop import ClosedLoop, closed_loop_source
from wspd_design.codegen.compiler import find_compiler, load_library
from wspd_design.codegen.kernels import plant_kernels
from wspd_design.codegen.law_library import LoadedLaw, virtual_law
from wspd_design.codegen.laws import law_kernels
from wspd_design.codegen.loop_numbers import LoopInput, Settings
from wspd_design.design.catalog import controller
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import constants, load_rail, load_vehicle
from wspd_design.plants.planar import Planar
from wspd_design.simulation.loop_input import loop_input
from wspd_design.simulation.records import Scenario

SAMPLE_TIME = 0.01  # s, 100 Hz: what a present WSP has, and the case of the trial measurements
SPEED = 120.0 / 3.6
VEHICLE = load_vehicle("er24pc")
RAIL = load_rail("polach-wet")
LAW = controller("afsmc", VEHICLE, RAIL, Specification(sample_time=SAMPLE_TIME))
SCALAR_FLAGS = ("-O3", "-march=native", "-fPIC", "-shared", "-std=gnu11")


def scenario() -> Scenario:
    """Return the stop."""
    return Scenario(rail=RAIL, initial_speed=SPEED)


def given(*, stops: int = 1, refinement: int = 1, **changes: float) -> LoopInput:
    """Input of the compiled loop, with changes to its settings."""
    case = (Planar(VEHICLE), scenario())
    loop = loop_input([case] * stops, LAW, refinement=refinement)
    settings = Settings.from_buffer_copy(loop.settings)
    for name, value in changes.items():
        setattr(settings, name, value)
    return replace(loop, settings=settings)


def without_compiler() -> ClosedLoop:
    """Load the loop as a wheel gives it to a machine without a compiler: a compiled plant, the law as CasADi has it."""
    plant = Planar(VEHICLE)
    kernels, axles = law_kernels(LAW), plant.axles
    library = load_library(closed_loop_source(plant_kernels(plant, disturbed=False), stops=1))
    engine = virtual_law(kernels, axles=axles, stops=1)
    law = LoadedLaw(kernels, engine, axles=axles, stops=1)
    return ClosedLoop(library, law, axles=axles, stops=1)


class Scalar:
    """The hand-written program, compiled the usual way."""

    def __init__(self, folder: Path) -> None:
        library = folder / "scalar_stop.so"
        source = Path(__file__).with_name("scalar_stop.c")
        compiler = find_compiler()
        assert compiler is not None, "the benchmarks need a C compiler"
        subprocess.run([*compiler, *SCALAR_FLAGS, str(source), "-o", str(library), "-lm"], check=True)
        self._stop = ctypes.CDLL(str(library)).stop
        self._input, self._output = _numbers(given()), np.zeros(15)
        doubles = ctypes.POINTER(ctypes.c_double)
        self._arguments = [x.ctypes.data_as(doubles) for x in (self._input, self._output)]

    def run(self) -> tuple[float, int]:
        """Return distance and number of steps."""
        self._output[:] = 0.0
        self._stop(*self._arguments)
        return float(self._output[0]), int(self._output[14])


def _numbers(loop: LoopInput) -> np.ndarray:
    """The structure ``Input`` of the hand-written program."""
    v, b, c, r, g, s = VEHICLE, VEHICLE.brake, VEHICLE.contact, RAIL, LAW.gains, loop.settings
    mechanics = (v.mass, v.wheel_radius, v.wheel_inertia, v.wheel_damping, v.wheel_damping_decay)
    resistance = (v.resistance_constant, v.resistance_linear, v.resistance_quadratic)
    body = (v.body_mass, v.bogie_mass, v.body_height, v.bogie_height, v.traction_rod_height, v.bogie_spacing)
    pitch = (v.wheelbase, v.body_pitch_frequency, v.bogie_pitch_frequency, v.pitch_damping_ratio)
    brake = (b.max_torque, b.max_pressure, b.supply_rate, b.fill_time, b.vent_time)
    contact = (c.shear_modulus, c.semi_axis_rolling, c.semi_axis_lateral, c.kalker_c11, c.reference_load)
    rail = (r.mu0, r.friction_ratio, r.friction_decay, r.adhesion_reduction, r.slip_reduction)
    gains = (
        g.slip_reference,
        g.proportional_gain,
        g.integral_gain,
        g.boundary_layer,
        g.weight_rate,
        g.bound_rate,
    )
    rules = (*g.initial_weights, g.initial_bound, *g.centres, *g.widths, g.torque_unit)
    run = (
        SPEED,
        s.sample_time,
        s.longest_step,
        s.creep_rate,
        s.slope_limit,
        s.stop_speed,
        s.regularization_speed,
    )
    ends = (s.judging_speed, s.time_limit, constants().gravity)
    parts = (mechanics, resistance, body, pitch, brake, contact, rail, gains, rules, run, ends)
    return np.array([number for part in parts for number in part])
