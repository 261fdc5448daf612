"""Forms of many stops, of one law on one rail and of several."""

from wspd_design.exchange.common_keys import (
    ANY,
    CASE_KEYS,
    SCHEMA_KEY,
    VERSION_KEY,
    nullable,
)
from wspd_design.exchange.forms import Form, Key
from wspd_design.exchange.stop_forms import SCENARIO, WITNESS

SPREAD = Form(
    name="spread",
    keys=(
        nullable("min", "smallest"),
        nullable("p05", "quantile 5 %"),
        nullable("median", "quantile 50 %"),
        nullable("p95", "quantile 95 %"),
        nullable("max", "largest"),
    ),
)
STEP_CHECKS = Form(
    name="step_checks",
    keys=(
        Key(name="rows", kind="integer", meaning="that were checked"),
        Key(name="failed", kind="integer", meaning="of them, beyond 1e-6 of the distance or 1e-4 of slip"),
        nullable("distance_change", "largest, relative"),
        nullable("slip_change", "largest, of a slip above 0.3 m/s"),
    ),
)
_SPREADS = (
    ("distance_m", "of the stop,"),
    ("stopping_time_s", "of the stop,"),
    ("efficiency", "ideal stop over distance,"),
    ("slip_rms", "above 10 km/h about the reference of the law, null without one,"),
    ("lock_time_s", "of the wheelset that is locked longest,"),
    ("longest_lock_s", "longest lock of any wheelset above 10 km/h,"),
    ("valve_switches_per_s", "mean of the wheelsets with a brake,"),
    ("vented_air", "full brake cylinders let out, mean of the wheelsets with a brake,"),
)
CAMPAIGN = Form(
    name="campaign",
    schema="wspd-campaign/1",
    keys=(
        *CASE_KEYS,
        Key(name="scenario", kind=SCENARIO, meaning="as of one stop"),
        Key(name="witness", kind=WITNESS, nullable=True, meaning="as of one stop"),
        Key(name="runs", kind="integer", meaning="stops that are done"),
        Key(name="runs_wanted", kind="integer", meaning="stops that were asked for"),
        Key(name="complete", kind="flag", meaning="false after an interrupt, exit code 130"),
        nullable("not_stopped_share", "share of the stops that did not come to a standstill"),
        Key(
            name="sampled",
            kind="text",
            many=ANY,
            meaning="numbers that each stop draws anew",
        ),
        *(
            Key(name=name, kind=SPREAD, meaning=f"{meaning} over the stops that came to a standstill")
            for name, meaning in _SPREADS
        ),
        Key(
            name="check_every",
            kind="integer",
            meaning="runs whose number is a multiple of it are simulated again with half the steps; 0 for none",
        ),
        Key(name="step_checks", kind=STEP_CHECKS, meaning="what half the integration steps change in these"),
        Key(name="seed", kind="integer", meaning="of the first stop and of the drawing"),
        VERSION_KEY,
    ),
)
CAMPAIGNS = Form(
    name="campaigns",
    schema="wspd-campaigns/1",
    keys=(
        SCHEMA_KEY,
        Key(name="campaigns", kind=CAMPAIGN, many=(1, None), meaning="one for each law on each rail"),
        VERSION_KEY,
    ),
)
