"""Forms of the modes of a vehicle and of the speeds from which it hunts."""

from wspd_design.exchange.common_keys import ANY, RAIL_KEY, SCHEMA_KEY, VEHICLE_KEY, VERSION_KEY, nullable
from wspd_design.exchange.forms import Form, Key

SHARE = Form(
    name="energy_share",
    keys=(
        Key(name="body", kind="text", meaning="kind of body"),
        Key(name="direction", kind="text", meaning="in which it moves or turns"),
        Key(name="share", kind="number", meaning="of the kinetic energy of the mode; all of them make 1"),
    ),
)
MODE = Form(
    name="mode",
    keys=(
        Key(name="name", kind="text", meaning="from where most of the energy of motion is"),
        Key(name="natural_frequency_Hz", kind="number", meaning="size of the eigenvalue over 2 pi"),
        Key(
            name="frequency_Hz",
            kind="number",
            meaning="of the oscillation; 0 where the mode does not oscillate",
        ),
        Key(name="damping_ratio", kind="number", meaning="negative where the mode grows"),
        Key(name="growth_per_s", kind="number", meaning="real part of the eigenvalue"),
        Key(name="shares", kind=SHARE, many=ANY, meaning="of at least 1 %, largest first"),
    ),
)
CRITICAL_SPEED = Form(
    name="critical_speed",
    keys=(
        Key(name="conicity", kind="number", meaning="of the wheels"),
        nullable("speed_m_s", "lowest from which a mode that oscillates grows; null where none was found"),
        nullable("frequency_Hz", "of this mode"),
        Key(name="mode", kind="text", nullable=True, meaning="what moves in it most"),
        Key(name="tried_from_m_s", kind="number", meaning="lowest speed that was tried"),
        Key(name="tried_to_m_s", kind="number", meaning="highest speed that was tried"),
    ),
)
MODES = Form(
    name="modes",
    schema="wspd-modes/1",
    keys=(
        SCHEMA_KEY,
        VEHICLE_KEY,
        RAIL_KEY,
        Key(name="speed_m_s", kind="number", meaning="of the train"),
        Key(name="slip", kind="number", meaning="that brakes hold at all wheelsets; 0 where they roll"),
        Key(name="conicity", kind="number", meaning="of the wheels"),
        Key(
            name="lateral_slope",
            kind="number",
            meaning="slope of small lateral creep over that of Kalker's theory",
        ),
        Key(name="acceleration_m_s2", kind="number", meaning="of the train"),
        Key(
            name="torques_Nm", kind="number", many=ANY, meaning="braking torque of each axle, from the front"
        ),
        Key(name="loads_left_N", kind="number", many=ANY, meaning="of the left wheel of each axle"),
        Key(name="loads_right_N", kind="number", many=ANY, meaning="of the right wheel of each axle"),
        Key(name="modes", kind=MODE, many=ANY, meaning="those that oscillate by frequency, then the others"),
        Key(
            name="critical_speeds",
            kind=CRITICAL_SPEED,
            many=ANY,
            meaning="of a vehicle that rolls, for each conicity",
        ),
        Key(
            name="assumed_numbers", kind="text", many=ANY, meaning="numbers of the vehicle that are estimates"
        ),
        Key(name="remarks", kind="text", many=ANY, meaning="what is doubtful"),
        VERSION_KEY,
    ),
)
