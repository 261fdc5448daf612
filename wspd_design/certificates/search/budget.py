"""How much work a search may do: counted, so that a busy machine comes to the same verdict."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Budget:
    """When a search gives up. ``effort`` scales all limits; 1 is about 20 s of a search that cannot decide."""

    effort: float = 1.0

    @property
    def boxes(self) -> int:
        """Boxes that the prover may look at."""
        return max(1, round(60_000 * self.effort))


DEFAULT_BUDGET = Budget()
_budget: ContextVar[Budget] = ContextVar("budget", default=DEFAULT_BUDGET)


def budget() -> Budget:
    """Return what a search may use."""
    return _budget.get()


@contextmanager
def within(allowed: Budget) -> Iterator[None]:
    """Give every search inside the block this budget."""
    token = _budget.set(allowed)
    try:
        yield
    finally:
        _budget.reset(token)
