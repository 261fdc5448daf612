"""Numbers of a multibody file in place of its own: what may be varied, and what stays the vehicle's."""

import pytest

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants, load_vehicle
from wspd_design.plants.locomotive import LinearLocomotive, Locomotive

LOCO = load_vehicle("er24pc")


def numbers(plant):
    return dict(zip(plant.number_names, plant.numbers, strict=True))


def test_what_the_vehicle_decides_is_not_varied():
    bounds = Locomotive(LOCO).own_bounds
    assert not {"mass", "wheel_radius", "rotor.inertia_axial"} & set(bounds)
    assert {"traction_rod.height", "secondary.stiffness_z", "wheelset.inertia_axial"} <= set(bounds)
    assert bounds["traction_rod.height"] == (0.0, 1.1)
    assert len(bounds) > 60


@pytest.mark.parametrize("kind", [Locomotive, LinearLocomotive])
def test_one_number_changes_and_the_totals_stay(kind):
    plant = kind(LOCO)
    heavy = plant.with_number("bogie_frame.mass", 5500.0)
    assert type(heavy) is kind
    before, after = numbers(plant), numbers(heavy)
    assert (before["bogie_frame.mass"], after["bogie_frame.mass"]) == (4600.0, 5500.0)
    changed = {name for name in before if before[name] != after[name]}
    # The car body is what the others leave: springs and wheels carry the same in all, the secondary ones less.
    assert {name for name in changed if not name.startswith("preload.")} == {"bogie_frame.mass"}
    loads = [
        sum(x for name, x in each.items() if name.startswith("preload.wheelset")) for each in (before, after)
    ]
    assert loads[1] == pytest.approx(loads[0], rel=1e-9)
    lighter = (
        2 * 900.0 * constants().gravity / 4
    )  # N, of each side; a spring in compression counts as negative
    assert after["preload.secondary_1_left"] - before["preload.secondary_1_left"] == pytest.approx(lighter)


def test_the_last_value_of_a_number_counts():
    plant = Locomotive(LOCO).with_number("drive.stiffness", 1e5).with_number("drive.stiffness", 3e5)
    assert numbers(plant)["drive.stiffness"] == 3e5


def test_the_effective_inertia_is_the_vehicles_whatever_a_wheelset_has():
    plain, light = (
        numbers(p) for p in (Locomotive(LOCO), Locomotive(LOCO).with_number("wheelset.inertia_axial", 240.0))
    )
    ratio = plain["drive.ratio"]
    for found in (plain, light):
        turning = found["wheelset.inertia_axial"] + ratio**2 * (
            found["rotor.inertia_axial"] + found["drive.pinion_inertia"]
        )
        assert turning == pytest.approx(LOCO.wheelset_inertia, rel=1e-12)
    assert light["rotor.inertia_axial"] > plain["rotor.inertia_axial"]


def test_an_unknown_number_is_refused():
    with pytest.raises(UserError, match=r"no number .traction_rod\.hight. .*traction_rod\.height"):
        _ = Locomotive(LOCO).with_number("traction_rod.hight", 0.3).numbers
