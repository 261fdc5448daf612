"""Forms of linearizations, designs, parameters and a whole report."""

from wspd_design.exchange.check_forms import CHECK
from wspd_design.exchange.common_keys import (
    ANY,
    PAIR,
    PLANT_KEY,
    RAIL_KEY,
    REFERENCE_KEY,
    SAMPLE_TIME_KEY,
    SCHEMA_KEY,
    SEED_KEY,
    VEHICLE_KEY,
    VERSION_KEY,
    nullable,
)
from wspd_design.exchange.forms import Form, Key
from wspd_design.exchange.ladder_forms import RUNGS
from wspd_design.exchange.stop_forms import FAULT, STOP
from wspd_design.exchange.uncertainty_forms import UNCERTAINTY

LINEARIZATION_POINT = Form(
    name="linearization_point",
    keys=(
        Key(name="speed_m_s", kind="number", meaning="of the train"),
        Key(name="slip_pole_per_s", kind="number", meaning="open-loop pole of the slip without the valve"),
        Key(name="gain_per_Nms", kind="number", meaning="G of eq. (19)"),
        Key(
            name="poles_with_lag_per_s",
            kind="number",
            many=ANY,
            meaning="with the valve, fastest growing first",
        ),
        Key(
            name="equilibrium_torque_Nm",
            kind="number",
            meaning="torque per wheelset that holds the slip",
        ),
        Key(
            name="equilibrium_duty",
            kind="number",
            meaning="the same as share of the largest torque; above 1 the brake cannot hold it",
        ),
        Key(name="pole_beyond_lag", kind="flag", meaning="whether the slip pole exceeds 1/tau"),
    ),
)
LINEARIZATION = Form(
    name="linearization",
    schema="wspd-linearization/1",
    keys=(
        SCHEMA_KEY,
        VEHICLE_KEY,
        RAIL_KEY,
        PLANT_KEY,
        REFERENCE_KEY,
        Key(name="valve_time_constant_s", kind="number", meaning="tau"),
        Key(name="points", kind=LINEARIZATION_POINT, many=(1, None), meaning="one object for each speed"),
        VERSION_KEY,
    ),
)
SHEET_STOP = Form(
    name="sheet_stop",
    keys=(
        Key(name="speed_m_s", kind="number", meaning="where the stop begins"),
        Key(name="equivalent_time_s", kind="number", meaning="of the build-up, t_e"),
        Key(name="deceleration_m_s2", kind="number", meaning="of the developed brake, mean value a_e"),
        Key(name="distance_m", kind="number", meaning="v0 t_e + v0^2/(2 a_e), EN 14531-1"),
        Key(name="time_s", kind="number", meaning="t_e + v0/a_e"),
        nullable(
            "braked_weight_percentage",
            "C/s - D of a single vehicle, EN 16834; null off the level and from speeds without constants",
        ),
    ),
)
BRAKE = Form(
    name="brake",
    schema="wspd-brake/1",
    keys=(
        SCHEMA_KEY,
        VEHICLE_KEY,
        Key(name="grade", kind="number", meaning="rise over run, positive uphill"),
        Key(
            name="rim_force_N",
            kind="number",
            meaning="of the fully applied friction brake at the rims of all wheels, pads with their stated friction",
        ),
        Key(
            name="by_steps",
            kind="flag",
            meaning="pads fade, an electrodynamic brake blends in or magnets pull: the stops are worked out by steps "
            "and have the mean values that give their distance",
        ),
        Key(name="rotating_mass_kg", kind="number", meaning="that turning parts add to the mass"),
        Key(
            name="demanded_adhesion",
            kind="number",
            meaning="that the fully applied brake asks for, over the static load, of the axle that asks for most",
        ),
        Key(name="stops", kind=SHEET_STOP, many=(1, None), meaning="by mean values, one for each speed"),
        VERSION_KEY,
    ),
)
SPECIFICATION = Form(
    name="specification",
    keys=(
        REFERENCE_KEY,
        Key(name="slip_tolerance", kind="number", meaning="width of the band about the reference"),
        Key(name="slips", kind="number", many=PAIR, meaning="range of slip of the checks"),
        Key(name="speeds_m_s", kind="number", many=PAIR, meaning="range of operation"),
        SAMPLE_TIME_KEY,
    ),
)
GAIN = Form(
    name="gain",
    keys=(
        Key(name="name", kind="text", meaning="of the gain"),
        Key(
            name="value",
            kind="value",
            meaning="number, list of numbers, true or false, in the unit beside it",
        ),
        Key(name="unit", kind="text", meaning="of the value"),
        Key(name="why", kind="text", meaning="the rule that chose it"),
    ),
)
DESIGN = Form(
    name="design",
    keys=(
        Key(name="name", kind="text", meaning="of the design"),
        Key(name="law", kind="text", meaning="family of the control law"),
        VEHICLE_KEY,
        Key(name="vehicle_hash", kind="text", meaning="fingerprint of the vehicle that it was made for"),
        Key(name="rail", kind="text", meaning="name of the rail that it was made for"),
        Key(name="specification", kind=SPECIFICATION, meaning="what was asked for"),
        Key(name="gains", kind=GAIN, many=ANY, meaning="with their reasons"),
    ),
)
ENTRY = Form(
    name="entry",
    keys=(
        Key(name="name", kind="text", meaning="of the number"),
        Key(name="value_si", kind="value", meaning="in SI units; words stay as they are"),
        Key(
            name="bounds_si",
            kind="number",
            many=PAIR,
            nullable=True,
            meaning="in SI units; null where the number is exact",
        ),
        Key(name="unit_of_file", kind="text", meaning="that the parameter file states"),
        Key(name="source", kind="text", meaning="key of the source"),
        Key(name="at", kind="text", meaning="place in the source"),
        Key(name="status", kind="text", meaning="how far the number can be trusted"),
        Key(name="note", kind="text", meaning="remark"),
    ),
)
PARAMETERS = Form(
    name="parameters",
    keys=(
        Key(name="kind", kind="text", meaning="vehicle, rail, controller or constants"),
        Key(name="name", kind="text", meaning="of the set"),
        Key(name="title", kind="text", meaning="what it describes"),
        Key(name="entries", kind=ENTRY, many=ANY, meaning="its numbers"),
    ),
)
INPUT = Form(
    name="input",
    keys=(
        Key(name="name", kind="text", meaning="of the attachment"),
        Key(name="sha256", kind="text", meaning="of its content"),
    ),
)
PROVENANCE = Form(
    name="provenance",
    keys=(
        Key(
            name="command",
            kind="text",
            meaning="makes the report again from its attachments; empty where only a program in Python does",
        ),
        Key(name="made_at", kind="text", meaning="date and time, UTC, ISO 8601"),
        SEED_KEY,
        Key(name="inputs", kind=INPUT, many=ANY, meaning="files that the report was made from"),
        Key(name="input_hash", kind="text", meaning="SHA-256 of what sha256sum prints for the inputs"),
        Key(
            name="searches_cut",
            kind="text",
            many=ANY,
            meaning="checks of which a search was ended by its budget of counted work",
        ),
        Key(name="program_version", kind="text", meaning="of wspd_design"),
        Key(
            name="package_sha256",
            kind="text",
            meaning="SHA-256 of what sha256sum prints for the sorted files of the package",
        ),
        Key(
            name="package_tree",
            kind="text",
            meaning="name that git gives the folder of the package: its revision, whatever the commit",
        ),
        Key(
            name="changed",
            kind="flag",
            meaning="whether the package is known not to be that of the last commit of its clone",
        ),
        Key(name="compiler", kind="text", meaning="of the machine, in its own words"),
        Key(name="platform", kind="text", meaning="operating system, processor family and C library"),
        Key(name="versions", kind="value", meaning="object: package to version"),
    ),
)
FAULTED_STOP = Form(
    name="faulted_stop",
    keys=(
        Key(name="fault", kind=FAULT, nullable=True, meaning="null for the stop on patches"),
        Key(name="stopped", kind="flag", meaning="whether the train stopped"),
        Key(name="distance_m", kind="number", meaning="to standstill or to the time limit"),
        Key(
            name="longest_locks_s",
            kind="number",
            many=ANY,
            meaning="of each wheelset above 10 km/h, front first",
        ),
        Key(
            name="holds",
            kind="flag",
            meaning="whether it stopped and no wheel that a law could keep turning was locked for more than 0.5 s",
        ),
    ),
)
REPORTED_LAW = Form(
    name="reported_law",
    keys=(
        Key(name="name", kind="text", meaning="in tables and figures"),
        Key(name="title", kind="text", meaning="what it is"),
        Key(name="origin", kind="text", meaning="where it comes from"),
        Key(name="acts_on", kind="text", meaning="one wheelset, or all wheelsets of the vehicle together"),
        Key(name="fingerprint", kind="text", meaning="SHA-256 of all that decides what it does"),
    ),
)
REQUIREMENT = Form(
    name="requirement",
    keys=(
        Key(name="id", kind="text", meaning="R1, R2, ..."),
        Key(name="requirement", kind="text", meaning="name of the criterion, or of what is asked of checks"),
        Key(name="title", kind="text", meaning="in words"),
        nullable("limit", "in SI units; null where a check decides or nothing is required"),
        nullable("reached", "in SI units; null where there is no such figure"),
        nullable("perfect", "what a perfect law reaches in the same stop; null where that is not known"),
        nullable("margin", "distance from the limit over the limit, positive where it is kept"),
        Key(
            name="outcome", kind="text", words=("met", "missed", "open", "told"), meaning="told: not required"
        ),
        Key(name="evidence", kind="text", meaning="what shows it"),
        Key(name="checks", kind="text", many=ANY, meaning="names of those that decide it"),
        Key(name="source", kind="text", meaning="of the limit"),
        Key(name="verified", kind="flag", meaning="whether somebody compared the limit with its source"),
        Key(name="remark", kind="text", meaning="what the outcome rests on"),
    ),
)
ALTERNATIVE = Form(
    name="alternative",
    keys=(
        Key(name="law", kind="text", meaning="family, with gains by its rules"),
        SAMPLE_TIME_KEY,
        Key(name="missed", kind="text", many=ANY, meaning="names of the requirements that it does not meet"),
        nullable("distance_m", "of the same stop; null where drawn stops are judged"),
    ),
)
REPORT = Form(
    name="report",
    schema="wspd-report/3",
    keys=(
        SCHEMA_KEY,
        Key(name="provenance", kind=PROVENANCE, meaning="how to make the report again"),
        Key(name="law", kind=REPORTED_LAW, meaning="what the report is about"),
        Key(
            name="design",
            kind=DESIGN,
            nullable=True,
            meaning="of this law; null for one without gains that were chosen",
        ),
        Key(name="specification", kind=SPECIFICATION, meaning="what is asked of the law"),
        Key(
            name="compared_designs",
            kind=DESIGN,
            many=ANY,
            meaning="of each other controller that has gains",
        ),
        Key(name="brake", kind=BRAKE, meaning="while no wheel slides, by mean values"),
        Key(name="linearizations", kind=LINEARIZATION_POINT, many=ANY, meaning="over speed"),
        Key(name="checks", kind=CHECK, many=ANY, meaning="one object for each claim"),
        Key(
            name="requirements",
            kind=REQUIREMENT,
            many=(1, None),
            meaning="what is asked for, what is reached and what shows it, causes before effects",
        ),
        Key(
            name="verdict",
            kind="text",
            words=("accepted", "rejected", "undecided"),
            meaning="accepted if every requirement is met, rejected if one is missed",
        ),
        Key(
            name="alternatives",
            kind=ALTERNATIVE,
            many=ANY,
            meaning="that were tried in place of a design that is not accepted, the best first",
        ),
        Key(name="stops", kind=STOP, many=(1, None), meaning="the design's own stop first"),
        Key(
            name="faulted_stops",
            kind=FAULTED_STOP,
            many=ANY,
            meaning="of the design: each fault at the axle where it does most harm, and patches",
        ),
        Key(
            name="uncertainty",
            kind=UNCERTAINTY,
            nullable=True,
            meaning="of the design's own stop; null where no number has bounds",
        ),
        Key(
            name="ladder",
            kind=RUNGS,
            nullable=True,
            meaning="the design's own stop on every model; null where it was not asked for",
        ),
        Key(name="parameters", kind=PARAMETERS, many=ANY, meaning="each set that was used"),
        VERSION_KEY,
    ),
)
