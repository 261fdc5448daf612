"""``wspd ladder``: the same stop on every model, in the terminal and as JSON."""

import json

from wspd_design.exchange.ladder_forms import LADDER

SLOW = ("--vehicle", "coach", "--speed", "30 km/h")


def test_every_model_has_its_rows(wspd):
    outcome = wspd("ladder", "none", *SLOW)
    assert (outcome.code, outcome.err) == (0, "")
    for word in ("quarter", "planar", "load transfer", "What suffices here"):
        assert word in outcome.out


def test_json_has_its_form_and_the_numbers_of_a_stop(wspd):
    found = json.loads(wspd("ladder", "none", *SLOW, "--json").out)
    assert [key.name for key in LADDER.keys] == list(found)
    assert found["schema"] == "wspd-ladder/1"
    alone = json.loads(wspd("simulate", "none", *SLOW, "--json").out)
    planar = next(each for each in found["rungs"] if each["plant"] == "planar")
    assert planar["distance_m"] == alone["distance_m"]
    assert len(planar["axles"]) == 4
    assert all(len(each["deviations"]) == len(found["rungs"]) for each in found["agreements"])


def test_a_stop_too_short_for_a_vibration_has_none(wspd):
    found = json.loads(wspd("ladder", "none", "--vehicle", "coach", "--speed", "10.2 km/h", "--json").out)
    assert found["rungs"][0]["axles"][0]["vibration_m_s"] is None
