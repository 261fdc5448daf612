"""The certificate as a text that can be kept and checked again."""

from collections.abc import Sequence
from typing import Any

from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.invariant_sets.search import Found
from wspd_design.certificates.setting.fingerprint import model_hash
from wspd_design.certificates.theorems.invariant_sets.runs import FORMAT


def write(problem: Problem, found: Sequence[Found]) -> dict[str, Any]:
    """Write sets of all windows, given the slowest first, as the JSON object that the checker reads."""
    windows = [
        {
            "low": each.cells.window.low,
            "high": each.cells.window.high,
            "tilt": each.cells.window.tilt,
            "per_unit": each.cells.per_unit,
            "steps": each.steps,
            "columns": _columns(each),
        }
        for each in reversed(found)
    ]
    return {"format": FORMAT, "claim_sha256": model_hash(problem), "windows": windows}


def _columns(found: Found) -> dict[str, list[int]]:
    """For each index of slip where runs of members start and end along the level."""
    import numpy as np

    columns = {}
    for row, members in enumerate(found.cells.members):
        changes = np.flatnonzero(np.diff(members.astype(np.int8), prepend=0, append=0))
        if len(changes):
            columns[str(found.cells.first[0] + row)] = (changes + found.cells.first[1]).tolist()
    return columns
