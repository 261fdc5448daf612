"""The form of an uncertainty: how figures of a stop spread over drawn numbers, and what each of these does alone."""

from wspd_design.exchange.common_keys import ANY, PAIR, SEED_KEY, nullable
from wspd_design.exchange.forms import Form, Key

WORST_SET = Form(
    name="worst_set",
    keys=(
        Key(name="number", kind="integer", meaning="of the set, from 0 on"),
        nullable(
            "value", "of the figure in the set, simulated alone; null for a distance or time without end"
        ),
        Key(name="parameters", kind="number", by_name=True, meaning="the drawn numbers, in SI units"),
        Key(
            name="command",
            kind="text",
            meaning="that simulates it again; empty where no command made the report",
        ),
    ),
)
SPREAD = Form(
    name="figure_spread",
    keys=(
        Key(
            name="name",
            kind="text",
            meaning="distance [m], time [s], efficiency, slip_rms, slip_max, longest_lock [s], speed_error or "
            "vented_air [cylinders]",
        ),
        nullable("nominal", "in the nominal stop"),
        nullable("low", "least of all sets; null where a train does not stop, as below"),
        nullable("high", "largest of all sets"),
        nullable("p05", "figure of a set, at or below which a twentieth of the sets lie"),
        nullable("p95", "figure of a set, at or below which 19 of 20 sets lie"),
        Key(name="worst", kind=WORST_SET, meaning="the set with the worst figure"),
    ),
)
EFFECT = Form(
    name="effect",
    keys=(
        Key(name="name", kind="text", meaning="of the number, such as vehicle.brake.fill_time"),
        Key(name="bounds_si", kind="number", many=PAIR, meaning="in SI units"),
        Key(
            name="at_low",
            kind="number",
            by_name=True,
            meaning="key figures at the lower bound, all other numbers nominal; a train that does not stop has neither "
            "distance nor time",
        ),
        Key(name="at_high", kind="number", by_name=True, meaning="the same at the upper bound"),
    ),
)
VARIANT = Form(
    name="variant",
    keys=(
        Key(
            name="subject",
            kind="text",
            meaning="rail, speed, load, wheels, sensors, dead time or all numbers",
        ),
        Key(name="words", kind="text", meaning="what is not as in the nominal stop"),
        Key(name="figures", kind="number", by_name=True, meaning="key figures, as above"),
    ),
)
UNCERTAINTY = Form(
    name="uncertainty",
    keys=(
        Key(name="sets", kind="integer", meaning="drawn sets of vehicle and rail"),
        SEED_KEY,
        Key(name="drawn", kind="text", many=ANY, meaning="numbers that are drawn evenly within their bounds"),
        Key(name="held", kind="text", many=ANY, meaning="numbers with bounds that are not drawn"),
        Key(name="unstopped", kind="integer", meaning="sets whose train does not come to a standstill"),
        Key(name="checked", kind="integer", meaning="sets that were simulated again with half the steps"),
        nullable("step_change", "largest relative change of the distance in those"),
        Key(
            name="numerical_m",
            kind="number",
            meaning="spread of the nominal distance over initial speeds that differ by millionths; 0 for a loop that "
            "is not sensitive",
        ),
        Key(name="spreads", kind=SPREAD, many=ANY, meaning="of each key figure"),
        Key(name="effects", kind=EFFECT, many=ANY, meaning="of each drawn number alone"),
        Key(name="variants", kind=VARIANT, many=ANY, meaning="single stops under other conditions"),
    ),
)
