"""Forms of the same stop on several models of a vehicle."""

from wspd_design.exchange.common_keys import (
    CONTROLLER_KEY,
    PLANT_KEY,
    RAIL_KEY,
    SCHEMA_KEY,
    SPEED_KEY,
    VEHICLE_KEY,
    VERSION_KEY,
    nullable,
)
from wspd_design.exchange.forms import Form, Key
from wspd_design.exchange.stop_forms import SCENARIO

RUNG_AXLE = Form(
    name="rung_axle",
    keys=(
        Key(name="slip_mean", kind="number", meaning="above 10 km/h"),
        Key(name="slip_max", kind="number", meaning="likewise"),
        Key(
            name="static_load_N",
            kind="number",
            meaning="of one wheel before the brake is applied, mean of both",
        ),
        nullable("braking_load_N", "mean while the brake is built up; null where it never is"),
        nullable("wheel_load_spread_N", "standard deviation about a moving mean over 1 s, likewise"),
        Key(name="least_load_N", kind="number", meaning="above 10 km/h"),
        Key(name="longest_lock_s", kind="number", meaning="without a break, above 10 km/h"),
        nullable(
            "vibration_m_s",
            "rms of the rim speed from 8 to 18 Hz in the half second with most of it; null in a shorter stop",
        ),
        nullable("vibration_frequency_Hz", "where the spectrum of that half second is highest"),
        Key(name="vibration_speed_m_s", kind="number", meaning="of the train in that half second"),
        Key(name="vibration_slip", kind="number", meaning="mean slip in it"),
    ),
)
RUNG = Form(
    name="rung",
    keys=(
        Key(name="title", kind="text", meaning="of the model, with what disturbs its stop alone"),
        PLANT_KEY,
        Key(name="distance_m", kind="number", meaning="until the ending"),
        Key(name="stopping_time_s", kind="number", meaning="until the ending"),
        nullable("slip_mean", "above 10 km/h, mean of the wheelsets with a brake"),
        Key(name="axles", kind=RUNG_AXLE, many=(1, None), meaning="each wheelset, front first"),
        Key(
            name="distance_spread_m",
            kind="number",
            meaning="over starts that nobody can tell apart; 0 unless the closed loop is sensitive",
        ),
        Key(name="step_change", kind="number", meaning="relative change of the distance with half the steps"),
    ),
)
AGREEMENT = Form(
    name="agreement",
    keys=(
        Key(name="measure", kind="text", meaning="what is compared"),
        Key(name="tolerance", kind="number", meaning="deviation up to which a model suffices"),
        Key(
            name="deviations",
            kind="number",
            many=(1, None),
            nullable=True,
            meaning="of each rung from the last one, of the worst wheelset",
        ),
        Key(
            name="suffices", kind="text", meaning="title of the first rung from which on all are near enough"
        ),
    ),
)
RUNGS_KEYS = (
    Key(name="remark", kind="text", meaning="what is inferred about the models; empty where nothing is"),
    Key(name="rungs", kind=RUNG, many=(1, None), meaning="the stop on each model, the smallest first"),
    Key(name="agreements", kind=AGREEMENT, many=(1, None), meaning="how far each model is from the last one"),
)
RUNGS = Form(name="rungs", keys=RUNGS_KEYS)
LADDER = Form(
    name="ladder",
    schema="wspd-ladder/1",
    keys=(
        SCHEMA_KEY,
        CONTROLLER_KEY,
        VEHICLE_KEY,
        RAIL_KEY,
        SPEED_KEY,
        Key(name="scenario", kind=SCENARIO, meaning="what disturbs the stop"),
        *RUNGS_KEYS,
        VERSION_KEY,
    ),
)
