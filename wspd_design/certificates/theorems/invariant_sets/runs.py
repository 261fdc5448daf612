"""The certificate of invariant sets as the checker reads it: everything in it is suspect."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.fingerprint import model_hash
from wspd_design.certificates.theorems.invariant_sets.ball_slopes import Ball

FORMAT = "wspd-invariant-sets/1"
MOST_WINDOWS, MOST_CELLS, MOST_COLUMNS, MOST_STEPS = 500, 1_000_000, 4096, 64


@dataclass(frozen=True, slots=True)
class CellRuns:
    """One window with its cells: for every column of slip the runs of level."""

    low: float
    high: float
    tilt: float
    per_unit: int
    steps: int
    columns: dict[int, list[tuple[int, int]]]

    def covers(self, low: Ball, high: Ball, level: Ball) -> bool:
        """Whether the set has all cells that a box of slip and level touches; indices are rounded outwards."""
        if not (low.is_finite() and high.is_finite() and level.is_finite()):
            return False
        n, slack = self.per_unit, 1e-9
        first = math.floor(float(level.lower()) * n - slack)
        last = math.ceil(float(level.upper()) * n + slack)
        columns = range(math.floor(float(low) * n - slack), math.ceil(float(high) * n + slack))
        return all(any(a <= first and last <= b for a, b in self.columns.get(i, ())) for i in columns)


def read(problem: Problem, document: Mapping[str, Any]) -> list[CellRuns]:
    """Understand the document, or refuse it."""
    try:
        if document["format"] != FORMAT or document["claim_sha256"] != model_hash(problem):
            raise Refused("the certificate speaks about another model")
        entries = document["windows"]
        if not isinstance(entries, list) or not 1 <= len(entries) <= MOST_WINDOWS:
            raise Refused("no windows, or too many")
        sets = [_one_set(entry) for entry in entries]
    except Refused:
        raise
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise Refused(f"the certificate cannot be read: {error!r}") from error
    if sum(b - a for each in sets for runs in each.columns.values() for a, b in runs) > MOST_CELLS:
        raise Refused("too many cells")
    return sets


def _one_set(entry: dict[str, Any]) -> CellRuns:
    numbers = [float(entry[name]) for name in ("low", "high", "tilt")]
    per_unit, steps = entry["per_unit"], entry["steps"]
    columns: dict[int, list[tuple[int, int]]] = {}
    for key, flat in entry["columns"].items():
        runs = list(zip(flat[::2], flat[1::2], strict=True))
        if (
            not all(type(each) is int for each in flat)
            or flat != sorted(set(flat))
            or len(columns) >= MOST_COLUMNS
        ):
            raise Refused("runs of cells out of order")
        columns[int(key)] = runs
    if type(per_unit) is not int or type(steps) is not int or not 1 <= steps <= MOST_STEPS:
        raise Refused("cells or steps out of range")
    if not 1 <= per_unit <= 4096 or per_unit & (per_unit - 1) or not all(map(math.isfinite, numbers)):
        raise Refused("cells or window out of range")
    low, high, tilt = numbers
    return CellRuns(low, high, tilt, per_unit, steps, columns)
