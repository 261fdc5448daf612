"""Numbers of two reports, worked out again from their attached files by formulas and stops of our own.

One report is that of the paper's law, on the quarter locomotive; the other that of the demo's protection, on four
axles. ``independent_report`` knows nothing of the package, so that a number can only agree if both are right. Of every
number a wrong one is planted in the record, and must be found.
"""

import csv
import hashlib
import io
import json
import math
import tomllib
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from independent_axles import IndependentAxles
from independent_report import (
    JUDGED,
    AdaptiveFuzzyLaw,
    Locomotive,
    built_up,
    growth_per_sample,
    held_slip,
    ideal_stop_of_axles,
    numbers,
)

from wspd_design.certificates import suite
from wspd_design.design.file import read_design
from wspd_design.parameters.loading import load_rail
from wspd_design.reporting.attachments import attachments
from wspd_design.reporting.report import report_time
from wspd_design.simulation.records import Scenario, Sensing
from wspd_design.studies import dossier as dossier_module
from wspd_design.studies.uncertainty import uncertainty

pytestmark = pytest.mark.slow
REPORTS = Path(__file__).parents[2] / "reports"
START = 120.0 / 3.6
SETS = 32  # so that the percentiles are neither ends nor neighbors of them


@dataclass(frozen=True)
class Number:
    """A number of the record, and what it has to be."""

    path: tuple[str | int, ...]
    mine: float | str
    relative: float = 1e-9
    absolute: float = 0.0

    def read(self, record):
        for key in self.path:
            record = record[key]
        return record

    def agrees(self, record):
        printed = self.read(record)
        if isinstance(self.mine, str):
            return printed == self.mine
        return abs(printed - self.mine) <= self.relative * abs(self.mine) + self.absolute


def of_stop(relative=1e-9, absolute=0.0, **mine):
    """Numbers of the stop of the design."""
    return [Number(("stops", 0, name), float(each), relative, absolute) for name, each in mine.items()]


class Attached:
    """The files of a report."""

    def __init__(self, files):
        self.files = files
        self.record = json.loads(files["report.json"])
        self.nominal, self.bounds = {}, {}
        for kind, name in (("vehicle", "er24pc"), ("rail", "polach-wet")):
            values, bounds = numbers(files[f"shipped-{name}.toml"], kind)
            self.nominal |= values
            self.bounds |= bounds

    def table(self, name):
        """Return the columns of an attached table."""
        rows = list(csv.DictReader(io.StringIO(self.files[name])))
        return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}

    @cached_property
    def trace(self):
        (name,) = (each for each in self.files if each.startswith("stop-1"))
        return self.table(name)

    @cached_property
    def locomotive(self):
        return Locomotive(self.nominal)

    def law(self):
        """Return the law with nothing adapted: it goes by the nominal radius, whatever vehicle it brakes."""
        design = tomllib.loads(self.files["design.toml"])
        return AdaptiveFuzzyLaw(design, self.nominal["vehicle.wheel_radius"], self.locomotive.full)

    def margins(self):
        """Return the margins of all requirements with figure and limit, in shares of the limit."""
        for place, row in enumerate(self.record["requirements"]):
            if row["limit"] and row["reached"] is not None:
                at_least = row["requirement"].startswith("efficiency")
                reserve = (row["reached"] - row["limit"]) * (1.0 if at_least else -1.0)
                yield Number(("requirements", place, "margin"), reserve / row["limit"], absolute=1e-12)

    def hashes(self):
        """Return the hashes of the input files, and that over them."""
        listed = self.record["provenance"]["inputs"]
        found = [hashlib.sha256(self.files[each["name"]].encode()).hexdigest() for each in listed]
        for place, each in enumerate(found):
            yield Number(("provenance", "inputs", place, "sha256"), each)
        lines = "".join(f"{one}  {each['name']}\n" for one, each in zip(found, listed, strict=True))
        yield Number(("provenance", "input_hash"), hashlib.sha256(lines.encode()).hexdigest())


@pytest.fixture
def quick():
    """Run the checks that take no time, no other laws and no faults: they state nothing that is compared here."""
    checks = ("gain_positive", "margins", "conservation")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(dossier_module, "verify", partial(suite.verify, only=checks))
        patch.setattr(dossier_module, "uncertainty", partial(uncertainty, sets=SETS))
        for left_out in ("next_step", "robustness"):
            patch.setattr(dossier_module, left_out, lambda *_, **__: None)
        yield patch


def report_of(folder, scenario, **options):
    """Make a report and return its files."""
    design = read_design(REPORTS / folder / "design.toml")
    if design.requirements is not None:
        few = replace(design.requirements.held_out, sets=16)
        options["requirements"] = replace(design.requirements, held_out=few)
    made = dossier_module.dossier(design, vehicle="er24pc", rail="polach-wet", scenario=scenario, **options)
    return Attached({each.name: each.content for each in attachments(made, report_time())})


@pytest.fixture
def paper(quick):  # noqa: ARG001
    stop = Scenario.stop(from_kmh=120.0, rail=load_rail("polach-wet"))
    return report_of("er24pc-polach-wet", stop, plant="quarter")


@pytest.fixture
def protection(quick):
    sensing = Sensing(pulses_per_turn=100, period_timing=True, accelerometer_noise=0.05)
    quick.setattr(dossier_module, "uncertainty", lambda *_, **__: None)
    stop = replace(Scenario.stop(from_kmh=120.0, rail=load_rail("polach-wet")), sensing=sensing)
    return report_of("protection-polach-wet", stop)


def brake(report):
    """Numbers of the brake sheet."""
    made = report.locomotive
    yield Number(("brake", "rim_force_N"), made.rim_force)
    yield Number(("brake", "rotating_mass_kg"), made.rotating_mass)
    yield Number(("brake", "demanded_adhesion"), made.demanded_adhesion)
    stops = report.record["brake"]["stops"]
    place = next(k for k, each in enumerate(stops) if math.isclose(each["speed_m_s"], START))
    names = ("equivalent_time_s", "deceleration_m_s2", "distance_m", "time_s")
    mean = made.mean_stop(START)
    for name, mine in zip(names, mean, strict=True):
        yield Number(("brake", "stops", place, name), mine)
    percentage = 83634.0 / mean[2] - 19.0  # EN 16834, single vehicles from 120 km/h
    yield Number(("brake", "stops", place, "braked_weight_percentage"), percentage)


def linearized(report, slip):
    """Numbers of the slip linearized at the lowest, a middle and the highest speed."""
    for place in (0, 45, 59):
        speed = report.record["linearizations"][place]["speed_m_s"]
        made = report.locomotive
        torque = made.holding_torque(slip, speed)
        for name, mine in (
            ("slip_pole_per_s", made.pole(slip, speed)),
            ("gain_per_Nms", made.gain(speed)),
            ("equilibrium_torque_Nm", torque),
            ("equilibrium_duty", torque / made.full),  # fill and vent time are equal
        ):
            yield Number(("linearizations", place, name), mine, 1e-7)


def stopped(report):
    """Numbers of the paper's stop, simulated again."""
    made = report.locomotive
    trace, ideal = made.stop(report.law(), START), made.ideal_stop(START).distance[-1]
    time, distance = trace.time[-1], trace.distance[-1]
    judged = trace.speed > JUDGED
    span = trace.time[judged][-1]
    reached, rms, over, under = held_slip(trace, 0.14)
    build_up, until = built_up(trace.time, trace.torque, trace.distance, trace.speed)
    from_slips = made.share_of_peak(trace.time, trace.speed, slips=trace.slip)
    full = [duty in (0.0, 1.0) for duty in trace.pulsed]
    return [
        *of_stop(1e-4, distance_m=distance, stopping_time_s=time, ideal_stop_m=ideal),
        *of_stop(1e-4, efficiency=ideal / distance, plateau_m_s2=START / (2.0 * (time - distance / START))),
        *of_stop(1e-3, lag_s=2.0 * distance / START - time, lag_distance_m=2.0 * distance - START * time),
        *of_stop(1e-3, torque_integral_Nms=4.0 * np.trapezoid(trace.torque, trace.time)),
        *of_stop(1e-3, slip_mean=np.trapezoid(trace.slip[judged], trace.time[judged]) / span),
        *of_stop(
            1e-3,
            slip_rms=math.sqrt(np.trapezoid((trace.slip[judged] - 0.14) ** 2, trace.time[judged]) / span),
        ),
        *of_stop(1e-3, slip_max=trace.slip[judged].max(), held_slip_rms=rms),
        *of_stop(1e-3, slip_overshoot=over, slip_undershoot=under, adhesion_utilization=from_slips),
        *of_stop(0.0, 0.005, slip_reached_s=reached, build_up_s=build_up),
        *of_stop(0.0, 0.005 * START, build_up_distance_m=until),
        *of_stop(0.02, valve_switches=trace.switches, saturated_share=np.mean(full)),
        *of_stop(1e-3, vented_air=trace.vented),
        # Between nine tenths and the reference lie two of the record's steps.
        *of_stop(0.0, 1.5e-4, perfect_slip_rms=held_slip(made.held_stop(lambda _v: 0.14, START), 0.14)[1]),
    ]


def spread(report):
    """Numbers of the uncertainty of the distance, from the table of drawn sets, and its worst set simulated again."""
    sets = report.table("sets.csv")
    ordered = np.sort(sets["distance"])
    spreads = report.record["uncertainty"]["spreads"]
    place = next(k for k, each in enumerate(spreads) if each["name"] == "distance")
    worst = int(np.argmax(sets["distance"]))
    drawn = {name: sets[name][worst] for name in report.bounds}
    at = ("uncertainty", "spreads", place)
    for name, mine in (
        ("low", ordered[0]),
        ("high", ordered[-1]),
        ("p05", ordered[math.ceil(0.05 * SETS) - 1]),
        ("p95", ordered[math.ceil(0.95 * SETS) - 1]),
    ):
        yield Number((*at, name), mine, 1e-8)
    yield Number((*at, "worst", "number"), worst)
    for name in ("vehicle.mass", "rail.mu0"):
        yield Number((*at, "worst", "parameters", name), drawn[name], 1e-8)
    again = Locomotive(report.nominal | drawn).stop(report.law(), START)
    yield Number((*at, "worst", "value"), again.distance[-1], 1e-3)
    effect = ("uncertainty", "effects", 0, "bounds_si")
    for end, mine in enumerate(report.bounds["vehicle.mass"]):
        yield Number((*effect, end), mine)


def of_the_paper(report):
    """Everything that is worked out about the paper's design."""
    growth = next(k for k, each in enumerate(report.record["requirements"]) if each["requirement"] == "loop")
    speeds = np.geomspace(10.0 / 3.6, START, 25)
    largest = report.bounds["vehicle.wheelset_inertia"][1]
    gain = report.bounds["vehicle.wheel_radius"][0] / (largest * START)
    return [
        *brake(report),
        *linearized(report, 0.14),
        Number(
            ("requirements", growth, "reached"),
            growth_per_sample(report.locomotive, report.law(), speeds),
            1e-6,
        ),
        Number(("checks", 0, "margin", "low"), gain),
        *stopped(report),
        *spread(report),
        *report.margins(),
        *report.hashes(),
    ]


def of_the_protection(report):
    """What can be worked out about a law that is not written out again: its traces and the yardsticks of its stop."""
    trace, made = report.trace, report.locomotive
    time, speed = trace["time_s"], trace["speed_m_s"]
    braked = [key.rsplit("_", 1)[0] for key in trace]
    slips = np.array([trace[key] for key in trace if key.startswith("slip_")])
    torque = sum(trace[key] for key in trace if key.startswith("torque_Nm_"))
    assert braked.count("torque_Nm") == made.axles
    distance = np.trapezoid(speed, time)
    names = {key.removeprefix("vehicle.brake."): each for key, each in report.nominal.items()}
    of = SimpleNamespace(**{key.split(".")[-1]: each for key, each in report.nominal.items()})
    vehicle = SimpleNamespace(**vars(of), contact=of, brake=SimpleNamespace(**names))
    ideal = ideal_stop_of_axles(IndependentAxles(vehicle, of), made.peaks, START)
    build_up, until = built_up(time, torque, trace["distance_m"], speed)
    # Brake, running resistance and the damping of two wheels on each axle take the momentum of train and wheelsets.
    turning = sum(trace[key] for key in trace if key.startswith("wheel_speed"))
    momentum = made.radius * made.mass * (START - speed[-1]) + made.wheelset * (turning[0] - turning[-1])
    momentum -= made.radius * np.trapezoid(made.resistance(speed), time)
    momentum -= 2.0 * np.trapezoid(made.damping * np.exp(-made.damping_decay * time) * turning, time)
    return [
        *brake(report),
        *of_stop(1e-5, stopping_time_s=time[-1]),
        *of_stop(2e-5, distance_m=distance, ideal_stop_m=ideal, efficiency=ideal / distance),
        *of_stop(1e-4, torque_integral_Nms=momentum),
        *of_stop(1e-3, adhesion_utilization=made.share_of_peak(time, speed)),
        *of_stop(1e-3, lag_s=2.0 * distance / START - time[-1]),
        *of_stop(1e-4, plateau_m_s2=START / (2.0 * (time[-1] - distance / START))),
        *of_stop(2e-3, slip_mean=slips[:, speed > JUDGED].mean()),
        *of_stop(1e-2, slip_max=slips[:, speed > JUDGED].max()),
        *of_stop(0.0, 0.02, build_up_s=build_up),  # rows of the traces lie 20 ms apart
        *of_stop(0.0, 0.02 * START, build_up_distance_m=until),
        *report.margins(),
        *report.hashes(),
    ]


def wrong(record, mine):
    """Return the numbers of a record that are not what they have to be."""
    return ["/".join(map(str, each.path)) for each in mine if not each.agrees(record)]


def planted(record, number):
    """Return a record in which one number is wrong by ten times what it may be, or one letter of a hash is."""
    changed = json.loads(json.dumps(record))
    *way, last = number.path
    inner = changed
    for key in way:
        inner = inner[key]
    if isinstance(number.mine, str):
        inner[last] = inner[last][:-1] + ("0" if inner[last][-1] != "0" else "1")
    else:
        inner[last] += 10.0 * (number.relative * abs(number.mine) + number.absolute)
    return changed


def check(record, mine, *, least):
    """Hold that all numbers are right, that there are enough of them, and that each is missed if it is wrong."""
    assert wrong(record, mine) == []
    assert len({each.path for each in mine}) >= least
    for number in mine:
        assert wrong(planted(record, number), mine) == ["/".join(map(str, number.path))]


# One test for each report: workers that share the tests of a module would make its reports once each.


def test_the_report_of_the_paper_s_design(paper):
    check(paper.record, of_the_paper(paper), least=60)
    files = dict(paper.files)
    files["shipped-er24pc.toml"] = files["shipped-er24pc.toml"].replace("value = 752", "value = 753")
    found = wrong(paper.record, list(brake(Attached(files))))
    assert "brake/rotating_mass_kg" in found
    assert "brake/rim_force_N" not in found


def test_what_works_them_out_knows_nothing_of_the_package():
    import independent_report

    assert "wspd_design" not in Path(independent_report.__file__).read_text(encoding="utf-8")


def test_the_report_of_the_protection(protection):
    check(protection.record, of_the_protection(protection), least=25)
