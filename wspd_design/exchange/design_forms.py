"""The form of a design file, which is TOML: units stand beside the gains, the specification is in SI units."""

from wspd_design.design.file import SCHEMA
from wspd_design.exchange.common_keys import ANY, PAIR, RAIL_KEY, SCHEMA_KEY, VEHICLE_KEY
from wspd_design.exchange.forms import Form, Key

SPECIFICATION_TABLE = Form(
    name="specification_table",
    keys=(
        Key(name="slip", kind="number", meaning="slip reference"),
        Key(name="speeds", kind="number", many=PAIR, meaning="range of operation, in m/s"),
        Key(name="slips", kind="number", many=PAIR, meaning="range of slip of the checks"),
        Key(name="slip_tolerance", kind="number", meaning="width of the band about the reference"),
        Key(name="sample_time", kind="number", meaning="of the controller, in s"),
    ),
)
GAIN_TABLE = Form(
    name="gain_table",
    keys=(
        Key(
            name="value",
            kind="value",
            meaning="number, list of numbers, true or false, in the unit beside it",
        ),
        Key(name="unit", kind="text", meaning="of the value; another one of the same dimension is converted"),
        Key(name="why", kind="text", meaning="the rule that chose it"),
    ),
)
HELD_OUT_TABLE = Form(
    name="held_out_table",
    keys=(
        Key(name="sets", kind="integer", meaning="drawn sets of vehicle, rail and stop"),
        Key(name="seed", kind="integer", meaning="that they are drawn from"),
    ),
)
REQUIREMENTS_TABLE = Form(
    name="requirements_table",
    keys=(
        Key(name="rails", kind="text", many=(1, None), meaning="names or files; the sets take them in turn"),
        Key(
            name="within_bounds",
            kind="text",
            many=ANY,
            meaning="files whose bounds are drawn from",
            always=False,
        ),
        Key(name="certificates", kind="text", many=ANY, meaning="checks that must be proved", always=False),
        Key(
            name="stable_within",
            kind="value",
            by_name=True,
            meaning="by rail, share of the box on which quadratic functions must be found",
            always=False,
        ),
        Key(name="held_out", kind=HELD_OUT_TABLE, meaning="sets that no search has seen"),
        Key(name="limits", kind="value", by_name=True, meaning="by criterion, with units"),
        Key(name="stop", kind="value", by_name=True, meaning="numbers of every stop, with units"),
        Key(
            name="draw", kind="value", by_name=True, meaning="numbers that each stop draws anew", always=False
        ),
    ),
)
DESIGN_FILE = Form(
    name="design_file",
    schema=SCHEMA,
    keys=(
        SCHEMA_KEY,
        Key(name="name", kind="text", meaning="of the design"),
        Key(name="law", kind="text", meaning="family of the control law"),
        VEHICLE_KEY,
        Key(name="vehicle_hash", kind="text", meaning="fingerprint of the vehicle that it was made for"),
        RAIL_KEY,
        Key(name="rail_hash", kind="text", meaning="fingerprint of the rail that it was made for"),
        Key(name="vehicle_file", kind="text", meaning="of one's own vehicle, from this folder", always=False),
        Key(name="rail_file", kind="text", meaning="of one's own rail, from this folder", always=False),
        Key(
            name="judged_by",
            kind="text",
            meaning="requirements of its reports, a template or a file, where it has no table of them",
            always=False,
        ),
        Key(name="specification", kind=SPECIFICATION_TABLE, meaning="what was asked for"),
        Key(name="gains", kind=GAIN_TABLE, by_name=True, meaning="a table for each gain of the law"),
        Key(name="requirements", kind=REQUIREMENTS_TABLE, meaning="that it was searched for", always=False),
    ),
)
