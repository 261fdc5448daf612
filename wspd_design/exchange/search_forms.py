"""The form of a search: what was varied, what was tried, what was chosen and how it was judged."""

from wspd_design.design.search.methods import METHODS
from wspd_design.exchange.common_keys import (
    ANY,
    RAIL_KEY,
    SAMPLE_TIME_KEY,
    SCHEMA_KEY,
    VEHICLE_KEY,
    VERSION_KEY,
)
from wspd_design.exchange.forms import Form, Key

DRAWN_SETS = Form(
    name="drawn_sets",
    keys=(
        Key(name="sets", kind="integer", meaning="of vehicle, rail and stop"),
        Key(name="seed", kind="integer", meaning="that they are drawn from"),
    ),
)
VARIABLE = Form(
    name="variable",
    keys=(
        Key(name="name", kind="text", meaning="gain, or slip_reference"),
        Key(name="unit", kind="text", meaning="of the numbers below"),
        Key(name="low", kind="number", meaning="least value"),
        Key(name="high", kind="number", meaning="largest value"),
        Key(name="start", kind="number", meaning="value of the design that the search started from"),
        Key(name="log", kind="flag", meaning="whether the range is even on a logarithmic scale"),
        Key(name="factor", kind="flag", meaning="whether it multiplies the gain of the start"),
        Key(name="why", kind="text", meaning="reason of the range"),
    ),
)
SCORE = Form(
    name="score",
    keys=(
        Key(
            name="objective",
            kind="number",
            nullable=True,
            meaning="mean excess of the distance over the ideal stop, and 0.3 times that of the worst sixth",
        ),
        Key(name="unstopped", kind="number", meaning="share of trains that did not come to a standstill"),
        Key(name="reached", kind="number", by_name=True, meaning="by the name of the criterion, in SI units"),
    ),
)
TRIED = Form(
    name="tried",
    keys=(
        Key(name="values", kind="number", many=ANY, meaning="of the variables, in their order"),
        Key(name="score", kind=SCORE, meaning="on the sets of the search"),
    ),
)
FINALIST = Form(
    name="finalist",
    keys=(
        Key(name="point", kind="integer", meaning="place among the points"),
        Key(name="score", kind=SCORE, meaning="on the sets of the final"),
    ),
)
SENSITIVITY = Form(
    name="sensitivity",
    keys=(
        Key(name="name", kind="text", meaning="of the variable that is moved"),
        Key(name="value", kind="number", meaning="that it is moved to"),
        Key(name="objective", kind="number", meaning="change of the objective"),
        Key(name="mean_excess", kind="number", meaning="change of the mean excess of the distance"),
        Key(name="error", kind="number", meaning="standard error of that change"),
    ),
)
JUDGED = Form(
    name="judged",
    keys=(
        Key(name="requirement", kind="text", meaning="name of the criterion, or stable_within"),
        Key(name="title", kind="text", meaning="in words"),
        Key(name="limit", kind="number", nullable=True, meaning="in SI units; null where none is asked for"),
        Key(
            name="reached",
            kind="number",
            nullable=True,
            meaning="in SI units; null where the law has no such figure",
        ),
        Key(name="met", kind="flag", nullable=True, meaning="null without a limit"),
    ),
)
SEARCH = Form(
    name="search",
    schema="wspd-search/1",
    keys=(
        SCHEMA_KEY,
        Key(name="design", kind="text", meaning="name of the design that was found"),
        Key(name="law", kind="text", meaning="family of the control law"),
        VEHICLE_KEY,
        RAIL_KEY,
        SAMPLE_TIME_KEY,
        Key(name="rails", kind="text", many=(1, None), meaning="that the sets take in turn"),
        Key(name="method", kind="text", meaning="of the search", words=tuple(METHODS)),
        Key(name="evaluations", kind="integer", meaning="points that were tried"),
        Key(name="search_sets", kind=DRAWN_SETS, meaning="the same for every point"),
        Key(name="variables", kind=VARIABLE, many=(1, None), meaning="what was varied"),
        Key(
            name="limits",
            kind="number",
            by_name=True,
            meaning="that points had to keep, by criterion, in SI units",
        ),
        Key(name="points", kind=TRIED, many=(1, None), meaning="in the order of the search, the start first"),
        Key(name="chosen", kind="integer", meaning="place of the chosen point among them, from 0"),
        Key(name="reason", kind="text", meaning="of the choice"),
        Key(
            name="final_sets",
            kind=DRAWN_SETS,
            nullable=True,
            meaning="on which the best points met again; null without a final",
        ),
        Key(name="finalists", kind=FINALIST, many=ANY, meaning="of the final, the best first"),
        Key(
            name="front",
            kind="integer",
            many=ANY,
            meaning="places of the points that no other one beats in objective, valve switches and vented air at once",
        ),
        Key(
            name="sensitivities",
            kind=SENSITIVITY,
            many=ANY,
            meaning="a tenth of the range of one variable at a time",
        ),
        Key(name="held_out_sets", kind=DRAWN_SETS, meaning="that the search never saw"),
        Key(name="held_out_start", kind=SCORE, meaning="of the start on the held-out sets"),
        Key(name="held_out", kind=SCORE, meaning="of the design on the held-out sets, looked at once"),
        Key(name="held_out_by_rail", kind=SCORE, by_name=True, meaning="the same on the sets of each rail"),
        Key(name="requirements", kind=JUDGED, many=ANY, meaning="on the held-out sets"),
        Key(name="unproved", kind="text", many=ANY, meaning="certificates that must hold and do not"),
        VERSION_KEY,
    ),
)
