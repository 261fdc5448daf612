"""Forms of checks and of a verification."""

from wspd_design.exchange.common_keys import (
    ANY,
    CONTROLLER_KEY,
    PAIR,
    PLANT_KEY,
    RAIL_KEY,
    REFERENCE_KEY,
    SAMPLE_TIME_KEY,
    SCHEMA_KEY,
    SEED_KEY,
    STATUSES,
    VEHICLE_KEY,
    VERSION_KEY,
    nullable,
)
from wspd_design.exchange.forms import Form, Key

RANGE = Form(
    name="range",
    keys=(
        nullable("low", "lower end; null where it is open"),
        nullable("high", "upper end; null where it is open"),
        Key(name="unit", kind="text", meaning="of both ends"),
    ),
)
POINT = Form(
    name="point",
    keys=(
        Key(name="name", kind="text", meaning="of the coordinate"),
        nullable("value", "in the unit beside it"),
        Key(name="unit", kind="text", meaning="of the value"),
    ),
)
HYPOTHESIS = Form(
    name="hypothesis",
    keys=(
        Key(name="text", kind="text", meaning="what the theorem needs"),
        Key(name="status", kind="text", words=STATUSES, meaning="verdict on it"),
    ),
)
PROOF = Form(
    name="proof",
    keys=(
        Key(name="obligation", kind="text", meaning="name within the check"),
        Key(name="statement", kind="text", meaning="what it says in words"),
        Key(name="leaves", kind="integer", meaning="boxes, or parts of the slip, that the checker decided"),
        Key(
            name="certificate",
            kind="text",
            always=False,
            meaning="wspd verify: JSON from which the proof can be checked again",
        ),
        Key(
            name="file",
            kind="text",
            always=False,
            meaning="wspd report: the attachment that wspd check decides about",
        ),
    ),
)
GROUNDS = (
    Key(name="explanation", kind="text", meaning="why the verdict is so"),
    Key(name="margin", kind=RANGE, nullable=True, meaning="positive when the claim holds"),
    Key(name="worst_point", kind=POINT, many=ANY, meaning="coordinates of the tightest point"),
    Key(name="witness", kind=POINT, many=ANY, meaning="coordinates of a point where the claim fails"),
    Key(name="hypotheses", kind=HYPOTHESIS, many=ANY, meaning="conditions of the theorem"),
    Key(name="assumptions", kind="text", many=ANY, meaning="what is taken for granted"),
)
"""Why a verdict is so: keys of every object that tells one."""
CHECK = Form(
    name="check",
    keys=(
        Key(name="name", kind="text", meaning="of the check"),
        Key(name="title", kind="text", meaning="what is checked"),
        Key(name="claim", kind="text", meaning="what is claimed"),
        Key(name="status", kind="text", words=STATUSES, meaning="verdict on the claim"),
        *GROUNDS,
        Key(name="method", kind="text", meaning="how the verdict was found"),
        Key(name="reference", kind="text", meaning="where the argument stands"),
        Key(name="model_hash", kind="text", meaning="fingerprint of all numbers that the verdict rests on"),
        Key(name="undecided_share", kind="number", meaning="share of the domain that was left open"),
        Key(name="varied", kind="text", many=ANY, meaning="numbers with bounds that the claim varies"),
        Key(name="held", kind="text", many=ANY, meaning="numbers with bounds that the claim holds"),
        Key(name="searched_boxes", kind="integer", meaning="boxes that the searches looked at"),
        Key(name="search_cut", kind="flag", meaning="whether a search was ended by its budget"),
        Key(name="proofs", kind=PROOF, many=ANY, meaning="what a checker accepted"),
        Key(name="computing_time_s", kind="number", always=False, meaning="wspd verify: of the check"),
    ),
)
VERIFICATION = Form(
    name="verification",
    schema="wspd-verify/2",
    keys=(
        SCHEMA_KEY,
        CONTROLLER_KEY,
        VEHICLE_KEY,
        RAIL_KEY,
        PLANT_KEY,
        SAMPLE_TIME_KEY,
        REFERENCE_KEY,
        Key(name="slips", kind="number", many=PAIR, meaning="domain of the claims, lowest and highest slip"),
        Key(
            name="speeds_m_s",
            kind="number",
            many=PAIR,
            meaning="domain of the claims, lowest and highest speed",
        ),
        Key(
            name="verdict",
            kind="text",
            words=("good", "refuted", "undecided"),
            meaning="as the exit code 0, 1 or 3",
        ),
        Key(name="checks", kind=CHECK, many=ANY, meaning="one object for each claim"),
        SEED_KEY,
        VERSION_KEY,
    ),
)
