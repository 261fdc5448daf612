"""What matters about an answer of the wizard, worked out from vehicle, rail and law while it is asked.

Every number is that of the nominal vehicle and rail; what holds within their bounds is for ``wspd verify``.
"""

import math
from functools import lru_cache

from wspd_design.cli import options
from wspd_design.cli.wizard.asked_design import OWN, is_of_whole_vehicle, tried, vehicle_and_rail, wanted
from wspd_design.cli.wizard.steps import Answers
from wspd_design.design.case import RAIL, VEHICLE
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.units import KMH, format_quantity, parse_quantity

READS_SLIP_ALONE = ("afsmc", "smc")
"""Laws whose memory holds integrals of the slip alone and that do not read the torque: no gains beat the valve."""
_PAPERS_CASE = (VEHICLE, RAIL)


def of_rail(text: str, answers: Answers) -> str:
    """Say how much of the adhesion the brake asks for."""
    if text == OWN:
        return ""
    vehicle, rail = vehicle_and_rail({**answers, "rail": text})
    return _adhesion(vehicle, rail, wanted({}).speeds)


def of_law(text: str, answers: Answers) -> str:
    """Say what a law cannot do."""
    if is_of_whole_vehicle({"law": text}):
        return (
            "Most checks speak about one wheelset and not about this law: it is judged by stops, in its report and "
            "in your tests."
        )
    if text not in READS_SLIP_ALONE:
        return (
            "It needs the cylinder pressure, and rests beside the reference where mass or friction are not those of "
            "the design."
        )
    return _against_the_valve({**answers, "slip": suggested_slip(answers)})


def of_slip(text: str, answers: Answers) -> str:
    """Say what a slip costs that is held all the way."""
    from wspd_design.design.slip_choice import MOST, best_constant_slip, held_distance

    if is_of_whole_vehicle(answers):
        return "The reference of this law falls with the train speed; this slip counts only where it is constant."
    names = vehicle_and_rail(answers)
    speed = wanted({}).speeds[1]
    if not _slides(*names):
        return ""
    vehicle, rail, slip = load_vehicle(names[0]), load_rail(names[1]), tried(answers, slip=text).slip
    distance, best = held_distance(vehicle, rail, speed, slip), best_constant_slip(vehicle, rail, speed)
    if math.isnan(distance) or math.isnan(best.distance):
        return ""
    others = (
        f"no constant slip up to {MOST:g} stops shorter"
        if distance <= best.distance
        else f"{best.slip:g}, the best constant slip up to {MOST:g}, takes {best.distance:.1f} m"
    )
    return (
        f"A brake that holds slip {slip:g} from {speed * KMH:g} km/h stops in {distance:.1f} m on {rail.name}; "
        f"{others}; the peak of the adhesion at all speeds takes {best.at_the_peak:.1f} m."
    )


def of_sample_time(text: str, answers: Answers) -> str:
    """Say how far a slide grows within a sample, and what feedback of the slip can stabilize."""
    names = vehicle_and_rail(answers)
    if is_of_whole_vehicle(answers) or not _slides(*names):
        return ""
    made = tried(answers, sample_time=text)
    pole, speed = _largest_pole(*names, made.slip, made.speeds)
    if pole <= 0.0:
        return (
            f"At slip {made.slip:g} the slip returns by itself at all speeds: no slide grows between samples."
        )
    growth = (
        f"At slip {made.slip:g} and {speed * KMH:.3g} km/h a deviation grows by "
        f"a factor of {math.exp(pole * made.sample_time):.3g} within one sample (nominal slip pole {pole:.3g} 1/s)"
    )
    brake = load_vehicle(names[0]).brake
    lag = (
        brake.valve == "lag" and brake.fill_time == brake.vent_time
    )  # what the theorem on sampling speaks about
    if answers.get("law", options.LAW) not in READS_SLIP_ALONE or not lag:
        return f"{growth}."
    from wspd_design.certificates.theorems.valve import largest_pole

    limit = largest_pole(made.sample_time, brake.fill_time)[0]
    enough = "which is enough" if pole <= limit else "which is not enough"
    return f"{growth}; proportional feedback of the sampled slip stabilizes up to {limit:.3g} 1/s, {enough}."


def suggested_slip(answers: Answers) -> str:
    """Return the best constant slip; the paper's for its case, for laws that hold another one, and where none is best.

    On rails whose friction does not fall more slip always stops a little shorter.
    """
    names = vehicle_and_rail(answers)
    if names == _PAPERS_CASE or is_of_whole_vehicle(answers) or not _slides(*names):
        return options.SLIP
    from wspd_design.design.slip_choice import MOST, best_constant_slip

    best = best_constant_slip(load_vehicle(names[0]), load_rail(names[1]), wanted({}).speeds[1])
    return options.SLIP if math.isnan(best.distance) or best.slip == MOST else f"{best.slip:g}"


def suggested_tolerance(answers: Answers) -> str:
    """Return the usual tolerance, but no more than half the slip."""
    slip, usual = wanted(answers).slip, parse_quantity(options.TOLERANCE, "ratio", what="tolerance")
    return options.TOLERANCE if slip >= 2.0 * usual else format_quantity(0.5 * slip, "-")


def _against_the_valve(answers: Answers) -> str:
    """Say whether the slip runs away faster than the valve follows."""
    from wspd_design.analysis.slip_pole import valve_rate

    names = vehicle_and_rail(answers)
    if not _slides(*names) or load_vehicle(names[0]).brake.valve != "lag":
        return ""
    made = wanted(answers)
    (pole, speed), rate = _largest_pole(*names, made.slip, made.speeds), valve_rate(load_vehicle(names[0]))
    if pole < rate:
        return (
            f"It reads the slip alone. At slip {made.slip:g} the nominal slip pole, at most {pole:.2g} 1/s, is slower "
            f"than the valve, {rate:.3g} 1/s."
        )
    return (
        f"It reads the slip alone, and at slip {made.slip:g} and {speed * KMH:.3g} km/h the slip runs away with "
        f"{pole:.2g} 1/s (nominal), faster than the valve follows, {rate:.3g} 1/s: whatever the gains, no equilibrium "
        "is stable there."
    )


def _slides(vehicle: str, rail: str) -> bool:
    return _share(vehicle, rail, wanted({}).speeds) >= 1.0


@lru_cache(maxsize=64)
def _share(vehicle: str, rail: str, speeds: tuple[float, float]) -> float:
    from wspd_design.design.adhesion_use import used_adhesion

    return used_adhesion(load_vehicle(vehicle), load_rail(rail), speeds)[0]


@lru_cache(maxsize=64)
def _adhesion(vehicle: str, rail: str, speeds: tuple[float, float]) -> str:
    from wspd_design.design.adhesion_use import adhesion_sentence

    return adhesion_sentence(load_vehicle(vehicle), load_rail(rail), speeds)


@lru_cache(maxsize=64)
def _largest_pole(vehicle: str, rail: str, slip: float, speeds: tuple[float, float]) -> tuple[float, float]:
    from wspd_design.analysis.slip_pole import largest_slip_pole

    return largest_slip_pole(load_vehicle(vehicle), load_rail(rail), slip=slip, speeds=speeds)
