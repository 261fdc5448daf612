"""Properties of parameter files: forms that mean the same are the same, what is written is read back, and whatever
stands in a file becomes a record or one sentence."""

import tomllib

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from wspd_design.exchange.parameter_file import parameter_file
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_entries, load_rail, load_vehicle
from wspd_design.parameters.schema import schema_of
from wspd_design.parameters.units import units_of

SETTINGS = settings(
    max_examples=40,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
    derandomize=True,
)
NUMBERS = [
    (name, unit)
    for name, quantity in schema_of("vehicle", "").items()
    if quantity.shape == "number"
    and not quantity.optional
    and name not in ("mass", "body_mass", "bogie_mass")
    for unit in units_of(quantity.dimension)
]
SCALARS = st.one_of(
    st.integers(), st.floats(), st.booleans(), st.text(max_size=12), st.lists(st.integers(), max_size=3)
)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "mine.toml"


@SETTINGS
@given(place=st.sampled_from(NUMBERS), number=st.floats(1e-3, 1e3).map(lambda x: float(f"{x:.6g}")))
def test_short_form_and_table_are_the_same_or_are_both_refused(path, place, number):
    name, unit = place
    told = []
    for text in (
        f'{name} = "{number!r} {unit}"',
        f'{name} = "{number!r}{" " * unit[0].isdigit()}{unit}"',  # 1.0 1/s would become 1.01 /s
        f'[{name}]\nvalue = {number!r}\nunit = "{unit}"',
    ):
        path.write_text(f'base = "er24pc"\n{text}\n')
        try:
            entry = load_entries("vehicle", path).entries[name]
            told.append((entry.value, entry.bounds, entry.inherited))
        except UserError as error:
            told.append((str(error), None, ""))
    assert told[0] == told[1] == told[2]


@SETTINGS
@given(
    key=st.one_of(st.sampled_from([*schema_of("rail", ""), "base", "title", "profile"]), st.text(max_size=8)),
    value=SCALARS,
)
def test_whatever_stands_in_a_rail_file_is_a_rail_or_one_sentence(path, key, value):
    text = repr(value).lower() if isinstance(value, bool) else repr(value)
    name = key if key in schema_of("rail", "") else '"' + "".join(c for c in key if c.isalnum()) + '"'
    path.write_text(f'base = "polach-wet"\n{name} = {text}\n', encoding="utf-8", errors="surrogatepass")
    refused, mu0 = "", 0.5
    try:
        mu0 = load_rail(path).mu0
    except UserError as error:
        refused = str(error)
    assert "\n" not in refused
    assert len(refused) < 700
    assert 0.0 < mu0 <= 1.0


@pytest.mark.parametrize(
    ("kind", "name"),
    [("vehicle", "coach"), ("vehicle", "two-axle-wagon"), ("rail", "very-low"), ("rail", "patchy")],
)
def test_what_is_written_is_read_back(path, kind, name):
    entries = load_entries(kind, name).entries
    own = [entry for entry in entries.values() if not entry.inherited]
    path.write_text(parameter_file("Copy", ["a comment"], own), encoding="utf-8")
    assert tomllib.loads(path.read_text(encoding="utf-8"))["title"] == "Copy"
    again = load_entries(kind, path).entries
    assert again == entries
    if kind == "vehicle":
        assert load_vehicle(path).brake == load_vehicle(name).brake
