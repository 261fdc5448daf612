"""Files of other versions: the design file before is read with a notice, others are refused in one sentence."""

import warnings
from pathlib import Path

import pytest

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.kernel.file import read_certificate
from wspd_design.design.file import design_text, read_design
from wspd_design.design.problem import stability_problem
from wspd_design.exchange.version import program_version
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.versions import OUTDATED, OutdatedWarning, check_schema
from wspd_design.studies.previous import previous

OLD = Path(__file__).with_name("design-1.toml")
"""As the program wrote it at the commit before dd16d67, which made version 2."""


def test_the_version_before_is_read_with_a_notice():
    with pytest.warns(OutdatedWarning, match=r"wspd-design/1.* is taken until 0.3.0; write it anew") as told:
        made = read_design(OLD)
    assert Path(told[0].filename).name == "test_older_files.py"
    assert made.gain("switching_gain") == 9.646990353291994
    vehicle, rail = load_vehicle("er24pc"), load_rail("polach-wet")
    law = made.build(vehicle, rail)
    assert stability_problem(vehicle, rail, law, made.specification).sample_time == 0.1


def test_written_again_it_is_a_present_one(tmp_path):
    with pytest.warns(OutdatedWarning):
        made = read_design(OLD)
    path = tmp_path / "new.toml"
    path.write_text(design_text(made))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert read_design(path) == made


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (('rail = "polach-wet"', 'rail = "mine"'), "does not say where its rail mine is; re-run wspd design"),
        (('vehicle = "er24pc"', "vehicle = 3"), "does not say where its vehicle 3 is"),
        (("wspd-design/1", "wspd-design/3"), 'newer program, this one reads "wspd-design/2"; update'),
        (("wspd-design/1", "wspd-design/0"), 'must be "wspd-design/2"; re-run wspd design'),
        (('schema = "wspd-design/1"\n', ""), 'schema = "" must be "wspd-design/2"'),
    ],
)
def test_others_are_refused_in_one_sentence(change, sentence, tmp_path):
    path = tmp_path / "old.toml"
    path.write_text(OLD.read_text().replace(*change))
    with pytest.raises(UserError, match="is not a design of this version") as told:
        read_design(path)
    assert sentence in str(told.value)
    assert "\n" not in str(told.value)


def test_a_schema_of_another_name_is_not_a_newer_one():
    with pytest.raises(UserError, match=r'"wspd-report/9" must be "wspd-design/2"'):
        check_schema("wspd-report/9", "wspd-design/2", "a.toml", what="a design", remedy="no")


def test_an_older_certificate_is_refused_with_what_to_do():
    with pytest.raises(Refused, match="not a certificate of this version, wspd-certificate/3; make it again"):
        read_certificate('{"schema": "wspd-certificate/1", "check": "reaching"}')


@pytest.mark.parametrize("version", [2, 3, 9])
def test_the_record_of_a_report_of_any_version_is_compared_with(version):
    assert previous(f'{{"schema": "wspd-report/{version}"}}', "old.json").record


def test_another_object_is_no_record_of_a_report():
    with pytest.raises(UserError, match=r"take the report\.json that a report attaches"):
        previous('{"schema": "wspd-stop/2"}', "old.json")


def numbers(version):
    return tuple(int(part) for part in version.split("."))


@pytest.mark.parametrize("outdated", OUTDATED, ids=lambda each: each.what)
def test_nothing_outdated_outlives_its_release(outdated):
    assert numbers(program_version()) < numbers(outdated.until)
