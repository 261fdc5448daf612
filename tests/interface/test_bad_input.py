"""Wrong use: one sentence with the remedy, exit code 2, nothing half-written, no traceback."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

FAR = ("--speed", "30 km/h")
WET_AND_DRY = "polach-wet,polach-wet,polach-dry,polach-dry"

# Command line -> what the sentence must name: the culprit and the remedy.
COMMAND_LINES = {
    "speed below zero": (("simulate", "--speed", "-5 km/h"), ("-1.38889 m/s", "above 0")),
    "speed zero": (("simulate", "--speed", "0 km/h"), ("above 0", "120 km/h")),
    "speed NaN": (("simulate", "--speed", "nan km/h"), ("nan km/h", "120 km/h")),
    "speed NaN without unit": (("simulate", "--speed", "NaN"), ("NaN", "km/h")),
    "speed infinite": (("simulate", "--speed", "1e999 km/h"), ("1e999 km/h", "finite")),
    "speed without unit": (("simulate", "--speed", "120"), ("no unit", "120 km/h")),
    "speed misspelled": (("simulate", "--speed", "100 kmh"), ("100 kmh", 'did you mean "100 km/h"?')),
    "speed of a time": (("simulate", "--speed", "100 ms"), ("unit of time", "km/h")),
    "speed of a word": (("compare", "--speed", "fast"), ("fast", "120 km/h")),
    "range in one word": (("design", "--speeds", "10-160 km/h"), ("2 arguments", "wspd design --help")),
    "command misspelled": (("desing",), ("'design'? See wspd --help.",)),
    "slip above 1": (("simulate", "--slip", "1.4"), ("1.4", "(0, 1)")),
    "slip 0": (("simulate", "--slip", "0"), ("slip = 0 ", "(0, 1)")),
    "slip 1": (("linearize", "--slip", "1"), ("slip = 1 ", "(0, 1)")),
    "slip below zero": (("compare", "--slip", "-0.1"), ("-0.1", "(0, 1)")),
    "slip above 100 %": (("design", "--slip", "140 %"), ("1.4", "(0, 1)")),
    "slip NaN": (("verify", "--slip", "nan"), ("nan", "finite")),
    "sample time 0": (("simulate", "--sample-time", "0 ms"), ("sample time", "1 ms")),
    "sample time without unit": (("simulate", "--sample-time", "100"), ("no unit", "100 ms")),
    "tolerance": (("design", "--tolerance", "0.9"), ("tolerance", "0.86")),
    "speeds fall": (("design", "--speeds", "120 km/h", "10 km/h"), ("120 to 10 km/h", "rise")),
    "speed of a linearization": (("linearize", "--speed", "0 m/s"), ("above 0",)),
    "rail unknown": (("simulate", "--rail", "polach-wett"), ('did you mean "polach-wet"?',)),
    "vehicle unknown": (("linearize", "--vehicle", "er24cp"), ('did you mean "er24pc"?',)),
    "controller unknown": (("simulate", "trenitala"), ('did you mean "trenitalia"?',)),
    "law unknown": (("design", "--law", "afsm"), ('did you mean "afsmc"?',)),
    "check unknown": (("verify", "smc", "--only", "reachin"), ('did you mean "reaching"?',)),
    "equation unknown": (("equations", "50"), ("50", "wspd equations")),
    "verdict unknown": (("equations", "--verdict", "misprnt"), ('did you mean "misprint"?',)),
    "parameter set unknown": (("sources", "er24cp"), ('did you mean "er24pc"?',)),
    "plant of a linearization": (("linearize", "--plant", "planar"), ("planar", "--plant quarter")),
    "plant of certificates": (("verify", "--plant", "planar"), ("planar", "--plant quarter")),
    "axle rails of the quarter locomotive": (
        ("simulate", "--plant", "quarter", "--axle-rails", WET_AND_DRY),
        ("single axles", "planar"),
    ),
    "too few axle rails": (("compare", "--axle-rails", "polach-wet"), ("names 1 rail;", "name 4")),
    "axle rail unknown": (("simulate", "--axle-rails", WET_AND_DRY[:-1]), ('did you mean "polach-dry"?',)),
    "patch without unit": (("simulate", "--patch", "50 polach-wet"), ("50 m polach-wet",)),
    "patch without rail": (("compare", "--patch", "50 m"), ("50 m polach-wet",)),
    "patch of a time": (("simulate", "--patch", "50 s polach-wet"), ("start of the patch", "unit of time")),
    "patch on an unknown rail": (("simulate", "--patch", "5 m polach-wett"), ('did you mean "polach-wet"?',)),
    "patch behind the start": (("simulate", "--patch", "-5 m polach-wet"), ("not be negative",)),
    "patches that fall": (
        ("simulate", "--patch", "50 m polach-wet", "--patch", "20 m polach-dry"),
        ("starts must rise",),
    ),
    "grade too steep": (("simulate", "--grade", "20 %"), ("0.2", "[-0.1, 0.1]")),
    "grade of a word": (("simulate", "--grade", "steep"), ("steep", "5 permille")),
    "grade with two units": (("simulate", "--grade", "5 % permille"), ("5 permille",)),
    "speed noise below zero": (("simulate", "--speed-noise", "-0.1 m/s"), ("-0.1 m/s", "not be negative")),
    "speed noise of a length": (("compare", "--speed-noise", "0.1 m"), ("speed noise", "km/h")),
    "no pulses": (("simulate", "--pulses", "0"), ("--pulses", "--help")),
    "reference error of all": (("simulate", "--reference-error", "100 %"), ("100 %", "between")),
    "reference error NaN": (("simulate", "--reference-error", "nan"), ("nan", "finite")),
    "dead time below zero": (("simulate", "--dead-time", "-5 ms"), ("-5 ms", "not be negative")),
    "shortest pulse above the sample time": (
        ("simulate", "--shortest-pulse", "150 ms"),
        ("0.15 s", "0.1 s"),
    ),
    "shortest pulse below zero": (("simulate", "--shortest-pulse", "-1 ms"), ("-1 ms", "not be negative")),
    "period timing without pulses": (("simulate", "--period-timing"), ("--pulses 100",)),
    "reference drift of a speed": (("compare", "--reference-drift", "1 m/s"), ("reference drift", "m/s^2")),
    "reference noise below zero": (
        ("simulate", "--reference-noise", "-1 m/s"),
        ("-1 m/s", "not be negative"),
    ),
    "torque error of all": (("simulate", "--torque-error", "-100 %"), ("-100 %", "between", "torque")),
    "load spread below zero": (("simulate", "--load-spread", "-1 %"), ("-1 %", "between 0 and 20 %")),
    "load spread of the quarter locomotive": (
        ("simulate", "--load-spread", "4 %", "--plant", "quarter"),
        ("planar",),
    ),
    "seed too large": (("simulate", "--seed", str(2**63)), ("seed", "2^63")),
    "no runs": (("simulate", "--runs", "0"), ("--runs", "--help")),
    "nominal without runs": (("simulate", "--nominal"), ("--runs 1000",)),
    "rows in another format": (("simulate", "--runs", "9", "-o", "rows.xlsx"), (".csv, .parquet or .mat",)),
    "traces in another format": (("simulate", "-o", "traces.txt"), (".csv, .parquet or .mat",)),
    "preset unknown": (("simulate", "trenitalia:text"), ('"text"', "trenitalia:textbook")),
    "preset of a law without": (("simulate", "smc:textbook"), ("smc:textbook", "available")),
    "folder of a reproduction is a file": (("reproduce", "-o", "typo.toml"), ("typo.toml", "folder")),
    "folder of a reproduction is full": (("reproduce", "-o", "full"), ("full", "--force")),
    "folder above a reproduction is missing": (("reproduce", "-o", "a/b"), ("folder a", "does not exist")),
    "plant unknown": (("verify", "--plant", "half"), ("half", "quarter")),
    "two controllers": (("simulate", "smc", "--controller", "none"), ("smc", "none", "leave one out")),
    "design file missing": (("verify", "missing.toml"), ("missing.toml", "check the path")),
    "vehicle file missing": (("simulate", "--vehicle", "missing.toml"), ("missing.toml", "check the path")),
    "design file with a typo": (("simulate", "typo.toml", *FAR), ("slip_tolerence", "slip_tolerance")),
    "rail file with a typo": (("simulate", "--rail", "rail.toml"), ("friction_ratoi", "friction_ratio")),
    "design file that is not TOML": (("verify", "broken.toml"), ("broken.toml", "correct that place")),
    "design for another vehicle": (
        ("simulate", "smc.toml", "--vehicle", "er24pc-service"),
        ("made for vehicle er24pc", "--vehicle er24pc"),
    ),
    "design with another slip": (
        ("simulate", "smc.toml", "--slip", "0.2"),
        ("--slip 0.2", "leave --slip out"),
    ),
    "design with another sample time": (
        ("verify", "smc.toml", "--sample-time", "20 ms"),
        ("--sample-time 0.02", "leave --sample-time out"),
    ),
    "design with another speed range": (
        ("verify", "smc.toml", "--speeds", "5 km/h", "120 km/h"),
        ("--speeds 1.38889 33.3333", "leave --speeds out"),
    ),
    "folder missing": (("design", "-o", "missing/design.toml"), ("missing", "does not exist")),
    "folder that cannot be written": (("design", "-o", "/proc/design.toml"), ("/proc", "choose")),
    "output is a folder": (("design", "-o", "folder"), ("folder", "name of a file")),
    "output of a stop is a folder": (("simulate", "--output", "folder"), ("folder", "name of a file")),
    "output exists": (("design", "-o", "typo.toml"), ("typo.toml", "--force")),
    "output of the wizard exists": (("new", "--yes", "-o", "typo.toml"), ("typo.toml", "--force")),
    "output of a stop exists": (("simulate", "--output", "typo.toml"), ("typo.toml", "--force")),
    "report in another format": (("report", "-o", "report.docx"), (".html or .pdf",)),
    "report exists": (("report", "-o", "old.html"), ("old.html", "--force")),
    "report as PDF exists": (("report", "-o", "new.html", "--pdf"), ("new.pdf", "--force")),
    "no terminal": ((), ("terminal", "wspd new --yes")),
    "no terminal for new": (("new",), ("terminal", "wspd new --yes")),
    "no draft": (("new", "--resume", "missing.toml.part"), ("missing.toml.part", "check the path")),
    "draft of another kind": (("new", "--resume", "typo.toml"), (".part", "-o")),
    "draft that is none": (("new", "--resume", "other.toml.part"), ("not a draft", "wspd new")),
    "draft with a typo": (("new", "--yes", "--resume", "typo.toml.part", "-o", "a.toml"), ("slipp", "slip?")),
    "draft with a wrong value": (("new", "--yes", "--resume", "wrong.toml.part"), ("7", "(0, 1)")),
    "option unknown": (("simulate", "--spede", "3"), ("--spede", "--speed", "wspd simulate --help")),
    "option without value": (("simulate", "--slip"), ("--slip", "argument")),
    "command unknown": (("simulat",), ("simulat", "--help")),
    "seed that is not a number": (("simulate", "--seed", "x"), ("--seed", "--help")),
    "seed below zero": (("simulate", "--seed", "-1"), ("--seed", "--help")),
}


@pytest.fixture
def files(tmp_path, smc_text):
    (tmp_path / "folder").mkdir()
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "page.html").touch()
    (tmp_path / "old.html").touch()
    (tmp_path / "new.pdf").touch()
    (tmp_path / "smc.toml").write_text(smc_text)
    (tmp_path / "typo.toml").write_text(smc_text.replace("slip_tolerance", "slip_tolerence"))
    (tmp_path / "broken.toml").write_text('schema = "wspd-design/1"\nname = smc\n')
    (tmp_path / "rail.toml").write_text('base = "polach-wet"\n[friction_ratoi]\nvalue = 0.4\nunit = "-"\n')
    (tmp_path / "other.toml.part").write_text('schema = "wspd-design/1"\n')
    draft = 'schema = "wspd-draft/1"\n[answers]\n'
    (tmp_path / "typo.toml.part").write_text(draft + 'slipp = "0.1"\n')
    (tmp_path / "wrong.toml.part").write_text(draft + 'slip = "7"\n')
    return tmp_path


def contents(folder):
    return {path: path.read_bytes() if path.is_file() else None for path in sorted(folder.rglob("*"))}


@pytest.mark.parametrize("case", COMMAND_LINES)
def test_one_sentence_and_nothing_written(case, wspd, files):
    arguments, words = COMMAND_LINES[case]
    before = contents(files)
    outcome = wspd(*arguments)
    assert outcome.code == 2
    assert outcome.out == ""
    assert outcome.err.startswith("wspd: ")
    assert outcome.err.count("\n") == 1
    assert outcome.err.rstrip("\n").endswith((".", "?", "!"))
    for word in words:
        assert word in outcome.err
    assert contents(files) == before


@pytest.mark.usefixtures("files")
def test_a_good_command_line_passes_the_same_checks(wspd):
    """The cases above fail for their fault, not for the rest of their command line."""
    good = wspd("simulate", "smc.toml", "--slip", "14 %", "--sample-time", "0.1 s", "--speed", "20 km/h")
    assert (good.code, good.err) == (0, "")
    rail = Path("rail.toml")
    rail.write_text(rail.read_text().replace("ratoi", "ratio"))
    assert wspd("linearize", "--rail", "rail.toml", "--speed", "20 km/h").code == 0


@pytest.mark.skipif(os.geteuid() == 0, reason="the superuser may write everywhere")
def test_folder_without_write_permission(wspd, tmp_path):
    closed = tmp_path / "closed"
    closed.mkdir(mode=0o500)
    outcome = wspd("design", "-o", "closed/design.toml")
    assert outcome.code == 2
    assert "closed" in outcome.err


@pytest.mark.parametrize(
    "arguments",
    [(), ("simulate", "--speed", "100 kmh"), ("simulate", "--rail", "polach-wett"), ("--nonsense",)],
    ids=lambda arguments: " ".join(arguments) or "no arguments",
)
def test_the_installed_command(arguments, tmp_path):
    """As a user starts it, in a process of its own and with nothing on standard input."""
    finished = subprocess.run(
        [sys.executable, "-c", "from wspd_design.cli import main; main()", *arguments],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert finished.returncode == 2
    assert finished.stdout == ""
    assert finished.stderr.count("\n") == 1
    assert "Traceback" not in finished.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="the device that is always full is one of Linux")
def test_output_on_a_full_disk(tmp_path):
    with Path("/dev/full").open("w") as full:
        finished = subprocess.run(
            [sys.executable, "-c", "from wspd_design.cli import main; main()", "linearize"],
            cwd=tmp_path,
            env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])},
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            timeout=60,
            check=False,
        )
    assert finished.returncode == 2
    assert finished.stderr.count("\n") == 1
    assert "no space left" in finished.stderr
