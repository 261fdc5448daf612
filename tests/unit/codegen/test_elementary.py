"""exp, log, atan2, sin and cos of the compiled code against mpmath with 50 digits."""

import math
from importlib.resources import files

import mpmath
import numpy as np
import pytest

from wspd_design.codegen.compiler import load_library

HEADER = files("wspd_design").joinpath("codegen", "templates", "elementary.h").read_text()
LANES = 4096
SOURCE = f"#define STOPS 2\n{HEADER}" + "".join(
    f"""
void {name}(const double *restrict x, const double *restrict y, double *restrict o)
{{
    (void)y;
    #pragma omp simd
    for (int l = 0; l < {LANES}; l++) o[l] = {call};
}}
"""
    for name, call in {
        "exp_": "wspd_exp(x[l])",
        "log_": "wspd_log(x[l])",
        "sin_": "wspd_sin(x[l])",
        "cos_": "wspd_cos(x[l])",
        "atan_": "wspd_atan2(x[l], 1.0)",
        "atan2_": "wspd_atan2(x[l], y[l])",
    }.items()
)


@pytest.fixture(scope="module")
def evaluate(call_lanes):
    library = load_library(SOURCE)

    def evaluated(name, x, y=None):
        x = np.asarray(x, dtype=np.float64)
        padded = np.resize(x, LANES)
        second = np.ones(LANES) if y is None else np.resize(np.asarray(y, dtype=np.float64), LANES)
        (result,) = call_lanes(getattr(library, name), [padded, second], [1])
        return result[0, : len(x)]

    return evaluated


def errors_in_ulp(results, exact, arguments):
    """Distance of the results from the 50-digit values, in units of the last place of the latter."""
    with mpmath.workdps(50):
        for result, *argument in zip(results, *arguments, strict=True):
            true = exact(*(mpmath.mpf(float(a)) for a in argument))
            yield float(abs(mpmath.mpf(float(result)) - true) / mpmath.mpf(math.ulp(abs(float(true)))))


def around(*points):
    """The points with their nearest neighbors on both sides."""
    return [z for p in points for z in (math.nextafter(p, -math.inf), p, math.nextafter(p, math.inf))]


RNG = np.random.default_rng(7)
RANGES = {
    "exp_": (
        mpmath.exp,
        [
            *np.linspace(-708.0, 709.0, 900),
            *RNG.uniform(-1.0, 1.0, 900),
            *RNG.uniform(-40.0, 1e-09, 900),
            *around(0.5 * math.log(2.0), -0.5 * math.log(2.0), 1.0),
            1e-300,
            -1e-300,
            -708.0,
            709.0,
        ],
    ),
    "log_": (
        mpmath.log,
        [
            *np.geomspace(1e-307, 1e308, 900),
            *RNG.uniform(0.5, 2.0, 900),
            *(1.0 + RNG.uniform(-1e-06, 1e-06, 300)),
            *around(math.sqrt(0.5), math.sqrt(2.0), 1.0),
            5e-324,
            1e-310,
            2.2250738585072014e-308,
        ],
    ),
    "sin_": (
        mpmath.sin,
        [
            *np.linspace(-10000.0, 10000.0, 900),
            *RNG.uniform(-7.0, 7.0, 900),
            *around(*(0.5 * math.pi * k for k in range(9))),
        ],
    ),
    "cos_": (
        mpmath.cos,
        [
            *np.linspace(-10000.0, 10000.0, 900),
            *RNG.uniform(-7.0, 7.0, 900),
            *around(*(0.5 * math.pi * k for k in range(9))),
        ],
    ),
    "atan_": (
        mpmath.atan,
        [
            *np.geomspace(1e-300, 1e300, 900),
            *RNG.uniform(-3.0, 3.0, 900),
            *around(math.tan(math.pi / 8), math.tan(3 * math.pi / 8), 1.0),
        ],
    ),
}


@pytest.mark.parametrize("name", RANGES)
def test_error_is_below_two_units_of_the_last_place(evaluate, name):
    exact, points = RANGES[name]
    points = [x for x in points if x != 1.0 or name != "log_"]  # log(1) = 0 has no last place
    worst = max(errors_in_ulp(evaluate(name, points), exact, [points]))
    assert worst < 2.0


def test_angle_of_a_fraction_in_all_quadrants(evaluate):
    y, x = RNG.uniform(-1.0, 1.0, (2, 2000)) * 10.0 ** RNG.uniform(-8.0, 8.0, (2, 2000))
    results = evaluate("atan2_", y, x)
    assert max(errors_in_ulp(results, mpmath.atan2, [y, x])) < 2.0
    np.testing.assert_allclose(evaluate("atan2_", [3.0, -3.0], [0.0, 0.0]), [math.pi / 2, -math.pi / 2])


def test_special_arguments(evaluate):
    inf = math.inf
    np.testing.assert_array_equal(
        evaluate("exp_", [0.0, -inf, inf, -800.0, 800.0]), [1.0, 0.0, inf, 0.0, inf]
    )
    np.testing.assert_array_equal(evaluate("log_", [1.0, 0.0, inf, -1.0]), [0.0, -inf, inf, math.nan])
    np.testing.assert_array_equal(evaluate("sin_", [0.0, inf]), [0.0, math.nan])
    np.testing.assert_array_equal(evaluate("cos_", [0.0, inf]), [1.0, math.nan])
    np.testing.assert_allclose(evaluate("atan_", [0.0, inf, -inf]), [0.0, math.pi / 2, -math.pi / 2])


@pytest.mark.parametrize("name", [*RANGES, "atan2_"])
def test_not_a_number_stays_one(evaluate, name):
    assert np.isnan(evaluate(name, [math.nan])).all()
    assert np.isnan(evaluate("atan2_", [1.0], [math.nan])).all()


def test_a_wrong_coefficient_is_seen(call_lanes):
    # The planted fault: the highest coefficient of exp in its fourth digit.
    wrong = SOURCE.replace("0x1.6c16c16c162c3p-10", "0x1.6c17c16c162c3p-10")
    assert wrong != SOURCE
    points = np.resize(RANGES["exp_"][1], LANES)
    (result,) = call_lanes(load_library(wrong).exp_, [points, points], [1])
    assert max(errors_in_ulp(result[0], mpmath.exp, [points])) > 2.0
