"""Units are read, written and compared; a wrong one is found in equations and in the generated functions."""

import re

import pytest
import sympy as sp

from derivations import unit_check
from derivations.notation import NOMENCLATURE, symbols
from derivations.unit_check import check, parse, unit_name
from tests.lazily import Lazily, definition, generated_functions

adaptive_fuzzy, track = Lazily("adaptive_fuzzy"), Lazily("track")


@pytest.mark.parametrize(
    "unit", ["N m", "N m/s", "1/(N m s)", "m/(N m s2)", "Pa/s", "rad/m", "m2/(rad/m)", "-"]
)
def test_units_are_read_as_they_are_written(unit):
    assert parse(unit_name(parse(unit))) == parse(unit)


def test_named_units():
    assert parse("Pa") == parse("N/m2")
    assert parse("kg m2") == parse("N m s2")
    assert unit_name(parse("kg m2/s2")) == "N m"
    assert unit_name(parse("m2/(rad/m)")) == "m3/rad"


def test_every_quantity_of_the_nomenclature_has_a_unit_that_can_be_read():
    without = {name for name, quantity in NOMENCLATURE.items() if not quantity.unit}
    assert without == {"beta0", "beta2", "gamma0", "gamma2", "gamma4", "gamma6"}  # solved from (49)
    for quantity in NOMENCLATURE.values():
        if quantity.unit:
            parse(quantity.unit)


def own_units(function):
    """Units of arguments whose meaning stands with the function."""
    return {name: re.findall(r"\[(.*?)\]", meaning)[-1] for name, meaning in function.meanings.items()}


def test_units_that_stand_with_a_function_are_checked():
    """The planted fault: the time that has passed, taken for a speed."""
    length, time = symbols("wheel_radius elapsed")
    assert not check((length, time * sp.Symbol("speed")), own={"elapsed": "s"}).fault
    assert check((length, time * sp.Symbol("speed")), own={"elapsed": "m/s"}).fault


@pytest.mark.parametrize(("module", "name"), generated_functions())
def test_generated_functions_return_what_their_docstrings_say(module, name):
    function = definition(module, name)
    stated = re.findall(r"\[([^\];]*)[;\]]", function.returns)
    if function.name == "irregularity_spectrum":
        found = check(
            (function.value, sp.Symbol("spectral_density")),
            tuple(s.name for s in track.spectrum.free_symbols if s.name != "wavenumber"),
            keep_angles=True,
        )
        assert not found.fault
        return
    for place, expression in enumerate(function.expressions):
        found = check((expression,), own=own_units(function))
        assert not found.fault
        if stated:
            unit = stated[place if len(stated) == len(function.expressions) else -1]
            assert sp.Matrix([parse(found.unit)[:3]]) == sp.Matrix([parse(unit)[:3]])


def test_misprint_of_eq_14_is_proved():
    T, tau, T_max, u = symbols("torque time_constant max_torque command")
    left = tau * sp.Symbol("torque_rate") + T
    assert check((left, T * sp.Symbol("command_rate"))).fault == "ū'*T is in N m/s, τ*T' + T in N m"
    assert check((left, T_max * u)) == unit_check.Units("N m", "", {})


def test_last_line_of_eq_44_is_proved_wrong():
    rate, claimed = sp.Symbol("lyapunov2_rate"), adaptive_fuzzy.rate_claimed
    assert not check((rate, claimed)).fault
    assert check((rate, claimed, adaptive_fuzzy.last_line_printed)).fault.startswith("-|ξ| is in N m")


def test_units_of_unknowns_are_solved_for():
    s, alpha1, b_squared, G = symbols("sliding_variable weight_rate weight_error_squared gain")
    by_adaptation = check((sp.Symbol("b_hat_rate"), alpha1 * s), ("weight_rate",))
    by_energy = check((sp.Integer(1), G * b_squared / alpha1), ("weight_rate",))
    assert by_adaptation.solved == by_energy.solved == {"weight_rate": "N m/s"}


def test_unknown_that_two_equations_put_apart_is_a_fault():
    s, alpha1, T = symbols("sliding_variable weight_rate torque")
    found = check((sp.Symbol("b_hat_rate"), alpha1 * s, alpha1 * T), ("weight_rate",))
    assert found.fault
    assert not found.solved


def test_arguments_and_exponents_are_pure_numbers():
    t, rate = symbols("time supply_rate")
    assert check((sp.exp(-rate * t),)) == unit_check.Units("-", "", {})
    assert "has to be a pure number" in check((sp.exp(-t),)).fault
    assert "has to be a pure number" in check((t**rate,)).fault


def test_integrals_and_derivatives_have_the_unit_of_time():
    t = sp.Symbol("t")
    torque = sp.Function("T")(t)
    assert check((sp.Integral(torque, (t, 0, 1)), sp.Symbol("torque_integral"))).unit == "N m s"
    assert check((sp.Derivative(torque, t), sp.Symbol("torque_rate"))).unit == "N m/s"


def test_symbol_without_unit_is_refused():
    with pytest.raises(ValueError, match="nobody has no unit"):
        check((sp.Symbol("nobody"),))
