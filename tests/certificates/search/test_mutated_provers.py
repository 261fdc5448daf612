"""A prover that is wrong "proves" a false bound; the checker refuses each such proof."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from wspd_design.certificates.search import prover
from wspd_design.certificates.search.tape import Tape

FALSE_BOUND = Fraction("25.09")  # the supremum is above 25.093, at the lowest speed and the largest mass
SPEED, MASS = 1, 2  # among the free variables


@pytest.fixture
def false_claim(reference_claim):
    assert [reference_claim.free[k].name for k in (SPEED, MASS)] == ["speed", "mass"]
    return replace(reference_claim, bound=FALSE_BOUND)


def _evaluates(monkeypatch, change):
    """Let the prover look at other boxes than it should; points are looked at nowhere near the extreme."""
    honest = Tape.evaluate

    def mutated(self, low, high, *, derivatives=True):
        return honest(self, *change(low, high), derivatives=derivatives)

    monkeypatch.setattr(Tape, "evaluate", mutated)
    monkeypatch.setattr(prover._Search, "_look_around", _one_look)
    # The mutant would otherwise stumble over a counterexample among the centers of its boxes.
    monkeypatch.setattr(prover._Search, "_keep", lambda *_: None)


def _one_look(self, size):
    self.best, self.best_place = -float("inf"), np.full(size, 0.5)


def _middle(low, high):
    middle = 0.5 * (low + high)
    return middle, middle


def _fast(low, high):
    """A speed below a tenth of its range is hidden."""
    low, high = low.copy(), high.copy()
    low[SPEED], high[SPEED] = low[SPEED].clip(min=0.1), high[SPEED].clip(min=0.1)
    return low, high


def _cut(low, high):
    """A mass above nine tenths of its range is hidden."""
    low, high = low.copy(), high.copy()
    low[MASS], high[MASS] = low[MASS].clip(max=0.9), high[MASS].clip(max=0.9)
    return low, high


@pytest.mark.parametrize("change", [_middle, _fast, _cut])
def test_prover_that_looks_away(monkeypatch, false_claim, refusal, change):
    _evaluates(monkeypatch, change)
    outcome = prover.prove(false_claim)
    assert outcome.tree
    assert refusal(false_claim, outcome.tree)


def test_prover_with_slack(false_claim, refusal):
    outcome = prover.prove(replace(false_claim, bound=FALSE_BOUND + Fraction(3, 2)))
    assert outcome.tree
    assert refusal(false_claim, outcome.tree)


def test_prover_with_the_wrong_sign(monkeypatch, false_claim, refusal):
    honest = prover._Search.__post_init__

    def mutated(self):
        honest(self)
        self.sign = -self.sign

    monkeypatch.setattr(prover._Search, "__post_init__", mutated)
    outcome = prover.prove(false_claim)
    assert outcome.tree
    assert refusal(false_claim, outcome.tree)


def test_honest_prover_does_not_prove_it(false_claim):
    outcome = prover.prove(false_claim)
    assert not outcome.tree
    assert outcome.low > FALSE_BOUND
