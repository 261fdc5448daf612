"""A search as plain data, in the form of the vocabulary."""

from dataclasses import asdict
from typing import Any

from wspd_design.design.finding import Found
from wspd_design.design.search.score import plain_score
from wspd_design.exchange.search_forms import SEARCH
from wspd_design.exchange.version import program_version


def search_object(found: Found, name: str) -> dict[str, Any]:
    """Return what was varied, tried, chosen and reached, with the name of what was found."""
    task, tried = found.task, list(found.tried)
    places = {each.point: place for place, each in reversed(list(enumerate(tried)))}
    return {
        "schema": SEARCH.schema,
        "design": name,
        "law": found.space.law,
        "vehicle": task.vehicle,
        "rail": task.design_rail,
        "sample_time_s": task.specification.sample_time,
        "rails": list(task.requirements.rails),
        "method": task.effort.method,
        "evaluations": len(tried),
        "search_sets": asdict(task.effort.sets),
        "variables": [asdict(variable) for variable in found.space.variables],
        "limits": {limit.criterion: limit.value for limit in found.limits},
        "points": [{"values": list(each.values), "score": plain_score(each.score)} for each in tried],
        "chosen": tried.index(found.chosen),
        "reason": found.reason,
        "final_sets": None if task.effort.final is None else asdict(task.effort.final),
        "finalists": [
            {"point": places[each.point], "score": plain_score(each.score)} for each in found.finalists
        ],
        "front": [tried.index(each) for each in found.front],
        "sensitivities": [asdict(each) for each in found.sensitivities],
        "held_out_sets": asdict(task.requirements.held_out),
        "held_out_start": plain_score(found.held_out_start),
        "held_out": plain_score(found.held_out),
        "held_out_by_rail": {rail: plain_score(each) for rail, each in found.held_out_by_rail.items()},
        "requirements": [asdict(each) for each in found.judged],
        "unproved": list(found.unproved),
        "version": program_version(),
    }
