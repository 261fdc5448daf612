"""Plants that come with a wheel: found by their source alone, the same bits on every machine, and no compiler."""

import importlib.util
import platform
import re
import subprocess
import sys
from dataclasses import replace
from functools import cache, partial
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from wspd_design.codegen import closed_loop, compiler, law_library, notices, prebuilt
from wspd_design.codegen.closed_loop import closed_loop_source, load_closed_loop
from wspd_design.codegen.compiler import NoCompilerError, find_compiler
from wspd_design.codegen.kernels import plant_kernels
from wspd_design.codegen.memory import Memory
from wspd_design.codegen.prebuilt import CPU_LEVEL, SUFFIX, library_name, prebuilt_library
from wspd_design.parameters.files import available
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.plants.names import plant_of
from wspd_design.plants.planar import Planar
from wspd_design.simulation.campaign import simulate_many
from wspd_design.simulation.loop_input import loop_input, sample_rows
from wspd_design.simulation.records import Scenario, Sensing
from wspd_design.simulation.stop import simulate

BUILD = Path(__file__).parents[3] / "wheels" / "build.py"
LEVELS = {"x86-64": "x86-64", "x86-64-v3": "x86-64-v3", "x86-64-v4": "x86-64-v4", "arm64": "armv8-a"}
LAWS = (
    "afsmc",
    "afsmc-repaired",
    "smc",
    "torque-feedback",
    "trenitalia",
    "knorr-bremse",
    "mitsubishi",
    "none",
)
NO_COMPILER = "no C compiler for this test"


@pytest.fixture(scope="module")
def build():
    """The script that builds wheels."""
    spec = importlib.util.spec_from_file_location("build_wheels", BUILD)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def compile_to(path, source, *options):
    text = path.with_suffix(".c")
    text.write_text(source, encoding="utf-8")
    command = [*find_compiler(), *options, *compiler.PORTABLE_FLAGS, str(text), "-o", str(path), "-lm"]
    subprocess.run(command, check=True)


@cache
def plant_source(vehicle, stops):
    return closed_loop_source(plant_kernels(Planar(vehicle), disturbed=False), stops=stops)


@pytest.fixture(scope="module")
def runnable(tmp_path_factory):
    """Instruction sets that this machine runs, by the library that tells them."""
    folder = tmp_path_factory.mktemp("level")
    if platform.machine() == "x86_64":
        template = Path(prebuilt.__file__).with_name("templates") / "cpu_level.c"
        compile_to(folder / f"{CPU_LEVEL}{SUFFIX}", template.read_text())
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(prebuilt, "folder", lambda: folder)
        prebuilt.targets.cache_clear()
        yield prebuilt.targets()
    prebuilt.targets.cache_clear()


@pytest.fixture(scope="module")
def libraries(tmp_path_factory, er24pc):
    """Put the plant of some stops side by side into a folder as in a wheel, for some instruction sets, each once."""
    folder = tmp_path_factory.mktemp("prebuilt")

    def made(stops, targets):
        source = plant_source(er24pc, stops)
        for target in targets:
            path = folder / f"{library_name(source, target)}{SUFFIX}"
            if not path.exists():
                compile_to(path, source, f"-march={LEVELS[target]}")
        return folder

    return made


@pytest.fixture
def from_wheel(libraries, runnable, monkeypatch):
    """As in a process that runs from a wheel, for the least machine, with a stop and with three side by side."""
    for stops in (1, 3):
        folder = libraries(stops, runnable[-1:])
    monkeypatch.setattr(prebuilt, "folder", lambda: folder)
    monkeypatch.setattr(prebuilt, "targets", lambda: runnable)


@pytest.fixture
def no_compiler(monkeypatch):
    def fail(_source):
        raise NoCompilerError(NO_COMPILER)

    monkeypatch.setattr(closed_loop, "load_library", fail)
    monkeypatch.setattr(law_library, "load_library", fail)
    monkeypatch.setattr(notices, "_told", {NO_COMPILER})


def numbers(output):
    lanes = (*output.lane_totals.values(), output.wheel_speeds)
    return np.concatenate([*lanes, *output.stop_totals.values(), output.samples.ravel()])


@pytest.fixture(scope="module")
def scenario():
    return Scenario(rail=load_rail("polach-wet"), initial_speed=8.0, sensing=Sensing(speed_noise=0.01))


def given_for(vehicle, law, scenario, stops=1):
    speeds = [scenario.initial_speed - k for k in range(stops)]
    return loop_input([(Planar(vehicle), replace(scenario, initial_speed=speed)) for speed in speeds], law)


@pytest.mark.skipif(
    not Path("/proc/cpuinfo").exists() or platform.machine() != "x86_64", reason="Linux on x86-64"
)
def test_the_level_of_the_processor(runnable):
    flags = set(re.search(r"^flags\s*:(.*)$", Path("/proc/cpuinfo").read_text(), re.MULTILINE)[1].split())
    third = {"avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe", "xsave"} <= flags
    fourth = {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"} <= flags
    expected = ["x86-64-v4"] * (third and fourth) + ["x86-64-v3"] * third + ["x86-64"]
    assert list(runnable) == expected


@pytest.mark.parametrize(
    ("stops", "sets"),
    [
        (1, slice(-1, None)),  # that which is farthest from this machine
        (3, slice(-1, None)),
        pytest.param(1, slice(None), marks=pytest.mark.reference),
        pytest.param(3, slice(None), marks=pytest.mark.reference),
    ],
    ids=["one stop, least machine", "three stops, least machine", "one stop", "three stops"],
)
def test_instruction_sets_do_not_change_a_bit(
    er24pc, make_controller, scenario, libraries, runnable, monkeypatch, stops, sets
):
    law = make_controller("afsmc")
    given, rows = given_for(er24pc, law, scenario, stops), sample_rows(law)
    native = numbers(load_closed_loop(Planar(er24pc), law, stops=stops).run(given, sample_rows=rows))
    folder = libraries(stops, runnable[sets])
    monkeypatch.setattr(prebuilt, "folder", lambda: folder)
    for target in runnable[sets]:
        monkeypatch.setattr(prebuilt, "targets", lambda target=target: (target,))
        assert prebuilt_library(plant_source(er24pc, stops)) is not None
        loop = load_closed_loop(Planar(er24pc), law, stops=stops)
        np.testing.assert_array_equal(numbers(loop.run(given, sample_rows=rows)), native)


@pytest.mark.usefixtures("from_wheel")
def test_a_plant_from_a_wheel_is_not_compiled(er24pc, make_controller, scenario, monkeypatch):
    compiled, true = [], closed_loop.load_library
    monkeypatch.setattr(closed_loop, "load_library", lambda source: compiled.append(source) or true(source))
    law = make_controller("trenitalia")
    simulate(er24pc, law, scenario)
    assert compiled == []
    body = er24pc.body_mass - er24pc.bogie_mass
    longer = replace(er24pc, wheelsets=6, body_mass=body)  # a number of axles that is not there
    simulate(longer, law, scenario)
    assert len(compiled) == 1


@pytest.mark.usefixtures("from_wheel")
def test_a_library_of_other_code_is_not_taken(er24pc, make_controller, scenario, monkeypatch):
    # The planted fault: the code was changed after the wheel was built, another weight of two stages.
    law, true = make_controller("trenitalia"), closed_loop.closed_loop_source
    before = simulate(er24pc, law, scenario).totals.distance

    def changed(*arguments, **options):
        source = true(*arguments, **options)
        assert "+ 2.0 * (of(1) + of(2))" in source
        return source.replace("+ 2.0 * (of(1) + of(2))", "+ 2.0001 * (of(1) + of(2))")

    monkeypatch.setattr(closed_loop, "closed_loop_source", changed)
    after = simulate(er24pc, law, scenario).totals.distance
    assert 1e-6 < abs(after / before - 1.0) < 1e-2


@pytest.mark.parametrize("name", LAWS)
def test_without_a_compiler_the_law_runs_in_the_virtual_machine(
    er24pc, make_controller, scenario, request, name
):
    law = make_controller(name, "polach-wet")
    rows = sample_rows(law)
    cases = [(stops, given_for(er24pc, law, scenario, stops)) for stops in (1, 3)]
    compiled = [
        load_closed_loop(Planar(er24pc), law, stops=stops).run(given, sample_rows=rows)
        for stops, given in cases
    ]
    request.getfixturevalue("from_wheel")
    request.getfixturevalue("no_compiler")
    for (stops, given), expected in zip(cases, compiled, strict=True):
        loop = load_closed_loop(Planar(er24pc), law, stops=stops)
        assert loop.engine == "compiled plant, law in CasADi's virtual machine"
        output = loop.run(given, sample_rows=rows)
        assert output.steps == expected.steps
        assert output.result == expected.result
        np.testing.assert_allclose(output.samples, expected.samples, rtol=1e-6, atol=1e-6)
        for key, values in expected.stop_totals.items():
            np.testing.assert_allclose(output.stop_totals[key], values, rtol=1e-6, err_msg=key)


def test_a_bad_command_is_told_by_the_virtual_machine(er24pc, make_controller, scenario, request):
    class Overfilling:
        name, sample_time = "overfilling", 0.1

        def start(self, measurement):  # noqa: ARG002
            return (0.0,)

        def step(self, state, measurement):  # noqa: ARG002
            return (state[0] + 1.0,), type(make_controller("none").step((), None)[1])(0.2 * state[0], 0.0)

    given = given_for(er24pc, Overfilling(), scenario)
    expected = load_closed_loop(Planar(er24pc), Overfilling()).run(given)
    for fixture in ("from_wheel", "no_compiler"):
        request.getfixturevalue(fixture)
    output = load_closed_loop(Planar(er24pc), Overfilling()).run(given)
    assert output.result == expected.result
    assert output.bad_command == expected.bad_command == pytest.approx((0.6, 1.2, 0.0))


@pytest.mark.usefixtures("from_wheel", "no_compiler")
def test_one_notice_tells_what_is_missing(er24pc, make_controller, scenario, monkeypatch):
    monkeypatch.setattr(notices, "_told", set())
    with pytest.warns(UserWarning, match=rf"^{NO_COMPILER}; the law runs .* pip install") as caught:
        runs = [simulate(er24pc, make_controller(name), scenario) for name in ("trenitalia", "none")]
    assert len(caught) == 1
    assert {run.engine for run in runs} == {"compiled plant, law in CasADi's virtual machine"}


@pytest.fixture(scope="module")
def built(build):
    """Sources of the plants in a wheel."""
    return {source for source, _ in build.plant_sources()}


class Asked(Exception):
    """The source that is looked for in the wheel; it need not be compiled and run to see it."""


def ask(source):
    raise Asked(source)


def ask_side_by_side(source):
    """Compile one stop alone, which a campaign begins with."""
    if "#define STOPS 1\n" not in source:
        raise Asked(source)


def test_a_wheel_holds_what_stops_and_campaigns_ask_for(
    er24pc, make_controller, scenario, build, built, monkeypatch
):
    law, asked = make_controller("none"), set()
    for plant, vibrating in product(("planar", "quarter"), (False, True)):
        each = replace(scenario, initial_speed=1.0, pad_vibration=vibrating)
        for wanted, told in ((simulate, ask), (partial(simulate_many, count=2), ask_side_by_side)):
            monkeypatch.setattr(closed_loop, "_plants", Memory(8))
            monkeypatch.setattr(closed_loop, "prebuilt_library", told)
            with pytest.raises(Asked) as found:
                wanted(er24pc, law, each, plant=plant)
            asked.add(str(found.value))
    assert len(asked) == 8
    assert asked <= built
    assert len(built) >= 4 * sum(map(len, build.AXLES.values()))


@pytest.mark.parametrize("name", available("vehicle"))
def test_a_wheel_holds_the_plants_of_shipped_vehicles(name, make_controller, built, monkeypatch):
    monkeypatch.setattr(closed_loop, "_plants", Memory(8))
    monkeypatch.setattr(closed_loop, "prebuilt_library", ask)
    stop = Scenario(rail=load_rail("polach-wet"), initial_speed=1.0)
    with pytest.raises(Asked) as found:
        simulate(load_vehicle(name), make_controller("none"), stop)
    assert str(found.value) in built


@pytest.mark.parametrize("name", ["locomotive", "locomotive-linear"])
def test_a_wheel_holds_the_locomotive(name, er24pc, built):
    kernels = plant_kernels(plant_of(name, er24pc), disturbed=False)
    assert closed_loop_source(kernels, stops=1) in built


MAGIC = {".so": b"\x7fELF", ".dll": b"MZ", ".dylib": b"\xcf\xfa\xed\xfe"}


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("ziglang") is None, reason="ziglang is not installed")
def check_platform(name, build, folder):
    """Compile one plant for the first instruction set of a platform, and look at what comes out."""
    system = build.PLATFORMS[name]
    target, *_ = system.targets
    build.compile_plants(replace(system, targets={target: system.targets[target]}), folder)
    files = sorted(folder.iterdir())
    assert {path.suffix for path in files} == {system.suffix}
    assert len(files) == 1 + ("x86_64" in system.triple)
    assert all(path.read_bytes().startswith(MAGIC[system.suffix]) for path in files)


def test_linux_is_compiled_for(er24pc, build, tmp_path, monkeypatch):
    source, own = plant_source(er24pc, 1), f"manylinux2014_{platform.machine()}"
    monkeypatch.setattr(build, "plant_sources", lambda: iter([(source, 1)]))
    check_platform(own if own in build.LINUX else build.LINUX[0], build, tmp_path)
    if sys.platform == "linux":
        monkeypatch.setattr(prebuilt, "folder", lambda: tmp_path)
        prebuilt.targets.cache_clear()
        assert prebuilt_library(source).wspd_size() > 0
        prebuilt.targets.cache_clear()


@pytest.mark.reference  # the first time zig makes the libraries of these systems, for minutes
@pytest.mark.parametrize(
    "name",
    [
        "manylinux2014_x86_64",
        "manylinux2014_aarch64",
        "win_amd64",
        "macosx_11_0_x86_64",
        "macosx_11_0_arm64",
    ],
)
def test_other_systems_are_compiled_for(er24pc, build, tmp_path, monkeypatch, name):
    source = plant_source(er24pc, 1)
    monkeypatch.setattr(build, "plant_sources", lambda: iter([(source, 1)]))
    check_platform(name, build, tmp_path)
