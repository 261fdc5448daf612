"""The committed generated model means what the derivations say, on every number type; tampering is caught."""

import importlib
import re
import shutil
import sys
from types import ModuleType

import casadi
import flint
import ival
import numpy as np
import pytest
import sympy as sp

from derivations.notation import Generated
from tests.lazily import Lazily, definition, generated_functions

generate = Lazily("generate")

CASES = generated_functions()
IDS = [f"{module}.{name}" for module, name in CASES]
RANGES = {  # near the working point of a locomotive, and away from singularities
    "slip": (0.02, 0.6),
    "speed": (1.0, 34.0),
    "wheel_load": (8e4, 1.1e5),
    "contact_stiffness": (9e6, 1.2e7),
    "friction_ratio": (0.3, 0.6),
    "friction_decay": (0.1, 0.6),
    "mass": (6e4, 9e4),
    "wheel_inertia": (300.0, 400.0),
    "creep_force": (1e4, 4e4),
    "creep_force_slip_derivative": (-4e4, 4e4),
    "resistance": (1e3, 1e4),
    "supply_rate": (0.6, 0.9),
    "fill_time": (0.4, 0.7),
    "target_torque": (2.1, 3.0),  # above the torque, below that of the supply
    "supply_torque": (4.0, 5.0),
}


def point(function: Generated, seed: int) -> list[float]:
    random = np.random.default_rng(seed)
    return [float(random.uniform(*RANGES.get(s.name, (0.2, 2.0)))) for s in function.arguments]


def committed(name: str) -> ModuleType:
    return importlib.import_module(f"wspd_design.model.generated.{name}")


def as_tuple(value: object) -> tuple:
    return value if isinstance(value, tuple) else (value,)


def meaning(source: str, function: Generated) -> list[sp.Expr]:
    """Execute generated source on SymPy symbols: what the function computes, with exact constants."""
    space: dict[str, object] = {}
    exec(source.replace("from math import pi", "from sympy import pi"), space)
    results = as_tuple(space[function.name](*function.arguments))
    return [sp.nsimplify(result, rational=True) for result in results]


def means_the_same(source: str, function: Generated) -> bool:
    found, derived = meaning(source, function), function.expressions
    return len(found) == len(derived) and all(
        sp.simplify(a - b) == 0 for a, b in zip(found, derived, strict=True)
    )


@pytest.mark.parametrize(("module", "name"), CASES, ids=IDS)
def test_symbolic_difference_is_zero(module, name):
    source = (generate.ROOT / generate.PACKAGE / f"{module}.py").read_text()
    assert means_the_same(source, definition(module, name))


def test_every_function_of_the_derivations_is_tested():
    derived = [(module, each.name) for module, part in generate.MODULES.items() for each in part.FUNCTIONS]
    assert sorted(derived) == sorted(CASES)


@pytest.mark.parametrize(("module", "name"), CASES, ids=IDS)
def test_random_points(module, name):
    call, function = getattr(committed(module), name), definition(module, name)
    for seed in range(3):
        values = point(function, seed)
        exact = [
            float(e.evalf(30, subs=dict(zip(function.arguments, map(sp.Rational, values), strict=True))))
            for e in function.expressions
        ]
        assert as_tuple(call(*values)) == pytest.approx(exact, rel=1e-10)


@pytest.mark.parametrize(("module", "name"), CASES, ids=IDS)
def test_number_types_agree(module, name):
    call, function = getattr(committed(module), name), definition(module, name)
    values = point(function, seed=7)
    floats = as_tuple(call(*values))

    arrays = as_tuple(call(*(np.array([value, value]) for value in values)))
    np.testing.assert_allclose([array[1] for array in arrays], floats, rtol=1e-13)

    symbols = [casadi.SX.sym(s.name) for s in function.arguments]
    compiled = casadi.Function("f", symbols, list(as_tuple(call(*symbols))))
    np.testing.assert_allclose([float(x) for x in as_tuple(compiled(*values))], floats, rtol=1e-13)

    # A box of one part in a thousand encloses its centre and every sample of it.
    boxes = as_tuple(
        call(*(ival.Interval(value - 5e-4 * abs(value), value + 5e-4 * abs(value)) for value in values))
    )
    balls = as_tuple(call(*(flint.arb(value, 5e-4 * abs(value)) for value in values)))
    random = np.random.default_rng(1)
    for _ in range(5):
        sample = as_tuple(call(*(value * (1.0 + 5e-4 * random.uniform(-1.0, 1.0)) for value in values)))
        assert all(box.lo <= x <= box.hi for box, x in zip(boxes, sample, strict=True))
        assert all(ball.contains(flint.arb(x)) for ball, x in zip(balls, sample, strict=True))


def test_committed_files_are_current():
    assert generate.outdated(generate.ROOT) == []


@pytest.fixture
def copy(tmp_path):
    for path in generate.sources():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(generate.ROOT / path, tmp_path / path)
    return tmp_path


@pytest.mark.parametrize(
    ("module", "function", "pattern", "replacement"),
    [
        ("slip", "slip_drift", r"8\.0 \* creep_force \+ resistance", "8.0 * creep_force - resistance"),
        ("motion", "train_acceleration", r"8\.0", "7.0"),
        ("brake", "filled_pressure", r"\bexp\(-supply_rate", "exp(supply_rate"),
        ("adhesion", "creep_force", r"atan\(gradient \* slip_reduction\)", "atan(gradient)"),
    ],
)
def test_tampered_file_is_caught(copy, module, function, pattern, replacement, monkeypatch, capsys):
    path = generate.PACKAGE / f"{module}.py"
    source = (copy / path).read_text()
    tampered = re.sub(pattern, replacement, source)
    assert tampered != source
    (copy / path).write_text(tampered)

    assert means_the_same(source, definition(module, function))
    assert not means_the_same(tampered, definition(module, function))

    monkeypatch.setattr("derivations.generate.ROOT", copy)
    monkeypatch.setattr(sys, "argv", ["generate", "--check"])
    assert generate.main() == 1
    assert str(path) in capsys.readouterr().err


def test_deleted_file_is_caught_and_written_again(copy, monkeypatch):
    (copy / generate.EQUATIONS).unlink()
    assert generate.outdated(copy) == [generate.EQUATIONS]
    monkeypatch.setattr("derivations.generate.ROOT", copy)
    monkeypatch.setattr(sys, "argv", ["generate"])
    assert generate.main() == 0
    assert generate.outdated(copy) == []


def test_only_powers_that_every_number_type_has():
    x = sp.Symbol("x")
    with pytest.raises(ValueError, match="integer powers"):
        generate.NumberPrinter().doprint(sp.sqrt(x))
