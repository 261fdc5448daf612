"""A ratio with its goal, and the CPU time of a process."""

import os
import statistics
import subprocess
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One ratio with its goal."""

    what: str
    goal: float
    at_least: bool
    ratios: list[float]
    note: str = ""
    judged: bool = True
    unit: str = "times"

    @property
    def median(self) -> float:
        return statistics.median(self.ratios)

    @property
    def met(self) -> bool:
        return self.median >= self.goal if self.at_least else self.median <= self.goal

    @property
    def verdict(self) -> str:
        return ("met" if self.met else "**missed**") if self.judged else "not judged"

    def cells(self) -> tuple[str, ...]:
        low, high = min(self.ratios), max(self.ratios)
        if len(self.ratios) > 3:
            low, _, high = statistics.quantiles(self.ratios, n=4)
        goal = f"{'at least' if self.at_least else 'at most'} {self.goal:g} {self.unit}"
        spread = (
            f"{self.median:.3g} ({low:.3g} to {high:.3g})" if len(self.ratios) > 1 else f"{self.median:.3g}"
        )
        return self.what, goal, spread, self.verdict, self.note


def process_cpu(*command: str, **environment: str) -> float:
    """CPU time of a process and its children [s]."""
    clean = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    before = os.times()
    subprocess.run(command, env={**clean, **environment}, check=True, stdout=subprocess.DEVNULL)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system
