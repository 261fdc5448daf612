"""Linearization of slip and torque: Jacobians, poles, named states, and what it refuses."""

from dataclasses import replace

import control
import numpy as np
import pytest

from wspd_design.analysis.linearization import linearize
from wspd_design.codegen.functions import quarter_plant, slip_plant
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import uniform_rails
from wspd_design.parameters.loading import load_rail

SPEEDS = (33.333, 20.0, 10.0, 5.0, 2.0, 1.0)


@pytest.mark.parametrize("name", uniform_rails())
@pytest.mark.parametrize("speed", SPEEDS)
def test_jacobians_against_central_differences(er24pc, name, speed):
    rail = load_rail(name)
    point = linearize(er24pc, rail, slip=0.14, speed=speed)
    derivative = slip_plant(er24pc, rail).derivative

    def rates(slip, torque, duty):
        return np.array(derivative(slip, torque, speed, duty)).ravel()

    at = np.array([0.14, point.equilibrium_torque, point.equilibrium_duty])
    scale = np.array([0.14, er24pc.brake.max_torque, 1.0])
    columns = []
    for k in range(3):

        def central(h, k=k):
            step = np.zeros(3)
            step[k] = h * scale[k]
            return (rates(*(at + step)) - rates(*(at - step))) / (2.0 * step[k])

        columns.append((4.0 * central(5e-4) - central(1e-3)) / 3.0)
    numerical = np.column_stack(columns)
    exact = np.column_stack([point.state_matrix, point.input_matrix])
    # Relative to the largest rate of the row when each variable moves over its own range.
    size = np.max(np.abs(exact * scale), axis=1, keepdims=True) / scale
    np.testing.assert_array_less(np.abs(numerical - exact), 1e-6 * size)
    assert numerical[0, 0] == pytest.approx(point.slip_pole, rel=1e-6)


@pytest.mark.parametrize("name", uniform_rails())
@pytest.mark.parametrize("speed", SPEEDS)
def test_equilibrium_and_poles(er24pc, name, speed):
    rail = load_rail(name)
    point = linearize(er24pc, rail, slip=0.14, speed=speed)
    rest = slip_plant(er24pc, rail).derivative(0.14, point.equilibrium_torque, speed, point.equilibrium_duty)
    np.testing.assert_allclose(np.array(rest).ravel(), 0.0, atol=1e-9)
    assert point.equilibrium_duty == pytest.approx(point.equilibrium_torque / 60e3)
    lag_pole = -1.0 / 0.6
    assert point.poles(with_lag=False) == (point.slip_pole,)
    assert point.poles() == pytest.approx(sorted((point.slip_pole, lag_pole), reverse=True), rel=1e-12)


def test_state_space_has_named_states_and_the_static_gain(er24pc):
    point = linearize(er24pc, load_rail("polach-wet"), slip=0.14, speed=1.5)
    assert point.slip_pole < 0.0  # a static gain exists
    with_lag, without = point.state_space(), point.state_space(with_lag=False)
    assert isinstance(with_lag, control.StateSpace)
    assert with_lag.state_labels == ["slip", "torque"]
    assert (with_lag.input_labels, with_lag.output_labels) == (["duty"], ["slip"])
    assert (without.state_labels, without.input_labels) == (["slip"], ["torque"])
    per_torque = -point.gain / point.slip_pole
    assert control.dcgain(without) == pytest.approx(per_torque, rel=1e-12)
    assert control.dcgain(with_lag) == pytest.approx(per_torque * er24pc.brake.max_torque, rel=1e-12)
    np.testing.assert_allclose(sorted(with_lag.poles().real), sorted(point.poles()), rtol=1e-12)
    np.testing.assert_allclose(without.poles().real, point.poles(with_lag=False), rtol=1e-14)


def test_small_step_of_duty_moves_the_slip_as_linearized(er24pc):
    # The nonlinear slip equation integrated by SciPy beside control's step response.
    from scipy.integrate import solve_ivp

    rail = load_rail("polach-wet")
    point = linearize(er24pc, rail, slip=0.14, speed=20.0)
    derivative, duty = slip_plant(er24pc, rail).derivative, point.equilibrium_duty + 1e-4
    times = np.linspace(0.0, 0.8, 30)
    solution = solve_ivp(
        lambda _t, x: np.array(derivative(x[0], x[1], 20.0, duty)).ravel(),
        (0.0, 0.8),
        [0.14, point.equilibrium_torque],
        t_eval=times,
        rtol=1e-11,
        atol=1e-13,
    )
    linear = 1e-4 * control.step_response(point.state_space(), times).outputs
    np.testing.assert_allclose(solution.y[0] - 0.14, linear, atol=2e-3 * np.max(np.abs(linear)))


@pytest.mark.parametrize("slip", [0.0, 1.0, 1.4, -0.1, float("nan")])
def test_slip_outside_its_range_is_refused(er24pc, slip):
    with pytest.raises(UserError, match=r"slip = .* must lie in \(0, 1\)"):
        linearize(er24pc, load_rail("polach-dry"), slip=slip, speed=10.0)


@pytest.mark.parametrize("speed", [0.0, -3.0, 200.0, float("nan"), float("inf")])
def test_speed_outside_its_range_is_refused(er24pc, speed):
    with pytest.raises(UserError, match=r"speed = .* must be above 0"):
        linearize(er24pc, load_rail("polach-dry"), slip=0.14, speed=speed)


@pytest.mark.parametrize(
    ("duty", "pressure", "pole"),
    [(0.1, 0.14, 2.44), (0.2, 0.75, 0.89), (0.3, 1.99, 0.70), (0.4, 3.52, 0.82), (0.5, 4.65, 1.28)],
)
def test_known_poles_of_averaged_orifices(er24pc, duty, pressure, pole):
    """Poles over 1/tau of ideal nozzles with a supply of 6 bar above the atmosphere, worked out by others."""
    brake = replace(er24pc.brake, valve="orifice", fill_time=1.0, vent_time=1.0, reservoir_pressure=6e5)
    other = replace(er24pc, brake=brake)
    plant, torque = (
        slip_plant(other, load_rail("polach-dry")),
        brake.max_torque * pressure * 1e5 / brake.max_pressure,
    )
    found, _ = plant.jacobians(0.14, torque, 10.0, duty)
    assert float(found[1, 1]) == pytest.approx(-pole, rel=0.02)
    held = plant.derivative(0.14, torque, 10.0, duty)[1] * brake.max_pressure / brake.max_torque
    assert abs(float(held)) < 0.02e5  # the equilibrium is given to 0.01 bar


def test_orifices_are_linearized_where_they_hold_the_torque(er24pc):
    other = replace(er24pc, brake=replace(er24pc.brake, valve="orifice"))
    point = linearize(other, load_rail("polach-wet"), slip=0.14, speed=10.0)
    rates = slip_plant(other, load_rail("polach-wet")).derivative(
        0.14, point.equilibrium_torque, 10.0, point.equilibrium_duty
    )
    assert [abs(float(rate)) for rate in (rates[0], rates[1] / other.brake.max_torque)] == pytest.approx(
        [0.0, 0.0], abs=1e-12
    )
    assert 0.0 < point.equilibrium_duty < 1.0
    assert point.time_constant == pytest.approx(-1.0 / point.state_matrix[1, 1])


def test_the_quarter_locomotive_is_no_function_of_other_brakes(er24pc):
    with pytest.raises(UserError, match=r"brake of er24pc is not that of eqs\. \(8\), \(9\)"):
        quarter_plant(replace(er24pc, brake=replace(er24pc.brake, valve="orifice")), load_rail("polach-wet"))


@pytest.mark.parametrize("vent", [0.15, 0.4, 0.9])
def test_a_valve_that_fills_and_vents_with_two_times(er24pc, vent):
    """The averaged valve T' = d (T_max - T)/T_F - (1 - d) T/T_V at the duty that holds the slip."""
    other = replace(er24pc, brake=replace(er24pc.brake, vent_time=vent))
    found = linearize(other, load_rail("polach-dry"), slip=0.14, speed=10.0)
    duty, torque, top, fill = found.equilibrium_duty, found.equilibrium_torque, 60e3, 0.6
    assert duty * (top - torque) / fill == pytest.approx((1.0 - duty) * torque / vent)
    rate = duty / fill + (1.0 - duty) / vent
    assert found.time_constant == pytest.approx(1.0 / rate)
    assert found.state_matrix[1] == pytest.approx([0.0, -rate])
    assert found.input_matrix[1] == pytest.approx((top - torque) / fill + torque / vent)
    assert min(fill, vent) < found.time_constant < max(fill, vent)


@pytest.mark.parametrize("vent", [0.15, 0.3, 1.2])
@pytest.mark.parametrize("speed", [30.0, 5.0, 1.5])
def test_a_torque_that_the_brake_does_not_have_leaves_the_valve_filling(er24pc, vent, speed):
    """A weak brake on a dry rail: no averaged valve holds more than T_max, and none has a negative time constant."""
    weak = replace(er24pc, brake=replace(er24pc.brake, max_torque=8e3, fill_time=0.3, vent_time=vent))
    found = linearize(weak, load_rail("polach-dry"), slip=0.14, speed=speed)
    assert found.equilibrium_torque > 8e3
    assert found.equilibrium_duty == found.equilibrium_torque / 8e3
    assert found.time_constant == pytest.approx(0.3)
    assert min(found.poles()) == pytest.approx(-1.0 / 0.3)
