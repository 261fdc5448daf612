"""What people read: tables that fit the terminal, with and without color, and say what they must."""

import csv
import re
import subprocess
import sys

import pytest

from wspd_design.parameters.equations import load_equations
from wspd_design.parameters.files import data_file
from wspd_design.parameters.loading import available, load_entries
from wspd_design.parameters.schema import CONTROLLER_SCHEMAS
from wspd_design.plants.multibody.loading import load_multibody

SLOW = ("--speed", "20 km/h")
SETS = [*available("vehicle"), *available("rail"), *CONTROLLER_SCHEMAS, *available("track"), "constants"]
TABLES = {
    "help": ("--help",),
    "help of a command": ("simulate", "--help"),
    "equations": ("equations",),
    "one equation": ("equations", "19"),
    "sources": ("sources",),
    **{f"sources {name}": ("sources", name) for name in SETS},
    "linearize": ("linearize", "--rail", "polach-dry"),
    "simulate": ("simulate", "none", *SLOW),
    "compare": ("compare", "none", "knorr-bremse", *SLOW),
    "verify": ("verify", "smc", "--only", "surface_hurwitz", "--only", "open_loop_pole"),
    "design": ("design", "--law", "smc"),
    "doctor": ("doctor",),
}


def test_numbers_of_a_comparison_are_never_broken(wspd, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    out = wspd("compare", "none", "knorr-bremse", *SLOW).out
    (row,) = (line for line in out.splitlines() if line.startswith("knorr-bremse"))
    assert len(row.split()) == 8


@pytest.mark.parametrize("columns", [60, 100])
@pytest.mark.parametrize("name", TABLES)
def test_fits_the_terminal(name, columns, wspd, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(columns))
    outcome = wspd(*TABLES[name])
    assert outcome.out
    assert max(map(len, outcome.out.splitlines())) <= columns


@pytest.mark.parametrize("columns", [60, 80, 120])
@pytest.mark.parametrize("name", ["coach", "er24pc", "very-low"])
def test_no_word_of_a_place_is_cut_off(name, columns, wspd, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(columns))
    shown = wspd("sources", name).out.split()
    entries = load_entries("rail" if name == "very-low" else "vehicle", name).entries.values()
    words = {word for entry in entries for word in entry.at.split() if len(word) < 20}
    assert len(words) > 10
    assert words - set(shown) == set()


@pytest.mark.parametrize(
    "changes", [{"NO_COLOR": "1"}, {"TERM": "dumb"}, {}], ids=["NO_COLOR", "dumb", "piped"]
)
def test_no_escape_sequences(changes, wspd, monkeypatch):
    monkeypatch.delenv("FORCE_COLOR", raising=False)
    for key, value in changes.items():
        monkeypatch.setenv(key, value)
    outcome = wspd("verify", "none", "--only", "gain_positive")
    assert "\x1b" not in outcome.out
    assert "✓ PROVED" in outcome.out


def test_color_where_the_user_asks_for_it(wspd, monkeypatch):
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("FORCE_COLOR", "1")
    outcome = wspd("equations")
    assert "\x1b[31mmisprint" in outcome.out


def test_every_equation_is_listed_with_its_verdict(wspd):
    out = wspd("equations").out
    for equation in load_equations():
        label = f"({equation.number})" if equation.number[0].isdigit() else equation.number
        assert re.search(rf"^{re.escape(label)} +{equation.verdict} ", out, re.MULTILINE), label
    assert "A misprint of one glyph may be the scan's" in out


def test_equations_of_one_verdict(wspd):
    numbers = {e.number for e in load_equations() if "misprint" in e.verdicts}
    out = wspd("equations", "--verdict", "misprint").out
    listed = re.findall(r"^(?:\((\d+)\)|(\S.*?)) +misprint(?:, gap)? {2}", out, re.MULTILINE)
    assert {a or b for a, b in listed} == numbers


@pytest.mark.parametrize("number", ["14", "(14)", "b_w", "table 5", "table 4", "t_d"])
def test_one_equation_shows_its_parts(number, wspd):
    out = wspd("equations", number).out
    equation = next(e for e in load_equations() if e.number.lower() == number.strip("()"))
    squeezed = re.sub(r"\s", "", out)
    for name in ("title", "printed", "corrected", "domain", "unit", "unit_fault", "gap", "file", "test"):
        assert re.sub(r"\s", "", getattr(equation, name)) in squeezed, name


def test_certainty_of_a_correction_is_told(wspd):
    out = " ".join(wspd("equations", "14").out.split())
    assert "misprint, gap" in out
    assert "proved from the paper's other equations or from units; one glyph, which the scan" in out


def test_unknown_entry_is_not_denied_to_the_paper(wspd):
    """Table 8 is in the paper and not in the map."""
    outcome = wspd("equations", "Table 8")
    assert outcome.code == 2
    assert 'the map has no entry "Table 8"' in outcome.err
    assert "the paper has no" not in outcome.err


@pytest.mark.parametrize("columns", ["60", "120"])
def test_sources_list_every_number(columns, wspd, monkeypatch):
    monkeypatch.setenv("COLUMNS", columns)
    out = wspd("sources", "er24pc").out
    for entry in load_entries("vehicle", "er24pc").entries.values():
        assert entry.name in out
        assert entry.status in out
        assert entry.source in out
    assert "76841 kg" in out
    assert "61473 to 92209" in out


def test_sources_of_a_multibody_vehicle(wspd, tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", "160")
    model = load_multibody("er24pc-82")
    out = wspd("sources", "er24pc-82").out
    assert all(name in out for name in model.entries)
    assert out.count(" assumed ") == sum(entry.status == "assumed" for entry in model.entries.values())
    both = wspd("sources", "two-axle-wagon").out  # of the vehicle, then of its bodies
    assert both.index("body_pitch_frequency") < both.index("suspension.half_spacing")
    (tmp_path / "mine.toml").write_text(
        data_file("multibody", "manchester-1.toml").read_text(encoding="utf-8")
    )
    assert "bump_stop.force" in wspd("sources", "mine.toml").out
    assert 'did you mean "er24pc-82"?' in wspd("sources", "er24pc-8").err


def test_sources_of_an_own_file(wspd, tmp_path):
    (tmp_path / "mine.toml").write_text('base = "polach-wet"\n[mu0]\nvalue = 33\nunit = "%"\n')
    out = wspd("sources", "mine.toml").out
    assert "33 %" in out
    assert "own file" in out


def test_linearize_marks_what_the_valve_cannot_stabilize(wspd):
    """Findings, section 2: on the dry rail the pole exceeds 1/tau from 20 to 1 m/s, not at 33.3."""
    out = wspd("linearize", "--rail", "polach-dry").out
    marked = [float(line.split()[0]) for line in out.splitlines() if line.rstrip().endswith(" !")]
    assert 120.0 not in marked
    assert {60.0, 40.0, 20.0, 10.0, 5.0} <= set(marked)
    said = " ".join(out.split())
    assert "does not read the torque and has a memory of integrals alone" in said
    assert "such as a lead filter, is not bound by this" in said
    assert "!" not in wspd("linearize", "--rail", "table10-dry").out


def test_traces_are_written(wspd, tmp_path):
    outcome = wspd("simulate", "none", *SLOW, "--output", "run.csv")
    assert outcome.code == 0
    with (tmp_path / "run.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert list(rows[0])[:3] == ["time_s", "speed_m_s", "distance_m"]
    assert float(rows[0]["speed_m_s"]) == pytest.approx(20.0 / 3.6, rel=1e-8)
    assert f"{float(rows[-1]['distance_m']):.1f} " in outcome.out
    assert list(tmp_path.iterdir()) == [tmp_path / "run.csv"]


def test_traces_on_a_uniform_grid(wspd, tmp_path):
    every = wspd("simulate", "trenitalia", *SLOW, "-o", "run.csv", "--every", "10 ms")
    assert (every.code, every.err) == (0, "")
    with (tmp_path / "run.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    times = [float(row["time_s"]) for row in rows]
    assert times == pytest.approx([0.01 * k for k in range(len(rows))], abs=1e-12)
    assert {"fill_1", "vent_4", "pressure_Pa_2", "told_wheel_speed_rad_s_3"} <= set(rows[0])
    assert {float(row["fill_1"]) for row in rows[:10]} == {float(rows[0]["fill_1"])}  # one sample


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--every", "10 ms"), "--every is about the traces of one stop in a file; add -o FILE.csv"),
        (("--every", "10 ms", "--runs", "3", "-o", "a.csv"), "and leave out --runs"),
        (("--every", "10", "-o", "a.csv"), '--every = "10" has no unit'),
        (("--every", "10 m", "-o", "a.csv"), "has a unit of length, not of time"),
        (("--every", "0 ms", "-o", "a.csv"), "must be finite and above 0"),
    ],
)
def test_a_wrong_interval_is_one_sentence(wspd, tmp_path, options, sentence):
    outcome = wspd("simulate", "none", *SLOW, *options)
    assert outcome.code == 2
    assert sentence in outcome.err
    assert list(tmp_path.iterdir()) == []


def test_traces_of_a_design_say_which_one(wspd, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    wspd("design", "--law", "smc", "--rail", "polach-wet", "-o", "mine.toml")
    assert wspd("simulate", "mine.toml", *SLOW, "--seed", "5", "-o", "run.parquet").code == 0
    about = parquet.read_schema(tmp_path / "run.parquet").metadata
    assert about[b"wspd.seed"] == b"5"
    assert about[b"wspd.design"] == about[b"wspd.controller"]
    assert len(about[b"wspd.design_hash"]) == 64


def test_design_is_written_and_can_be_used(wspd, tmp_path):
    made = wspd("design", "--law", "smc", "--slip", "16 %", "--speeds", "15 km/h", "100 km/h", "-o", "a.toml")
    assert made.code == 0
    assert "switching_gain" in made.out
    assert "wspd verify a.toml" in made.out
    assert "slip rms about 0.16" in wspd("simulate", "a.toml", *SLOW).out
    assert wspd("design", "-o", "a.toml").code == 2
    assert wspd("design", "-o", "a.toml", "--force").code == 0
    assert list(tmp_path.iterdir()) == [tmp_path / "a.toml"]


def test_help_and_import_load_nothing_heavy():
    """Neither ``wspd --help`` nor ``import wspd_design``; a real command does, so the test can fail."""
    program = (
        "import sys; import wspd_design; from wspd_design.cli.app import run; "
        "run({arguments}); heavy = {{'sympy', 'casadi', 'control', 'matplotlib', 'scipy', 'numpy', 'typst', "
        "'jinja2', 'prompt_toolkit'}}; print(sorted(heavy & set(sys.modules)), file=sys.stderr)"
    )

    def loaded(arguments):
        code = program.format(arguments=arguments)
        return subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True
        ).stderr

    assert loaded(["--help"]) == "[]\n"
    assert loaded(["verify", "--help"]) == "[]\n"
    assert "casadi" in loaded(["linearize", "--speed", "10 km/h"])
