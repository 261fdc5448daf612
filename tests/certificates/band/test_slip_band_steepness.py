"""Parts of the steepness, in each of which a proof bounds the friction: all of it, and with bounds that are proved."""

from dataclasses import replace

import pytest

from tests.certificates.band.conftest import refused
from tests.certificates.band.forging import told_with
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting.creep_slope import STEEPNESS
from wspd_design.certificates.theorems.band import CELLS, covered
from wspd_design.certificates.theorems.slip_band.friction import NAMES, PARTS
from wspd_design.certificates.theorems.slip_band.proof import read
from wspd_design.certificates.theorems.slip_band.statement import windows_of

pytestmark = pytest.mark.slow


def parts_in(proof, window=0):
    """Numbers of the parts of a window: the range of the steepness, then the bounds."""
    numbers = proof["friction"][window]
    count = len(numbers) // PARTS
    assert count == 2 * (1 + len(NAMES))
    return [numbers[k * count : (k + 1) * count] for k in range(PARTS)]


def with_parts(proof, parts, window=0):
    """Return a proof that states other parts in a window."""
    friction = list(proof["friction"])
    friction[window] = [number for each in parts for number in each]
    return {**proof, "friction": friction}


def test_parts_of_the_steepness_that_leave_some_out_are_refused(half, proof):
    """Exchanged ones among them, with their bounds."""
    first, second, *others = parts_in(proof)
    *before, last = parts_in(proof)
    low, high = map(float, second[:2])
    middle = repr(0.5 * (low + high))
    for parts in (
        [second, first, *others],
        [first, *others[::-1], second],
        [first, [second[0], middle, *second[2:]], *others],
        [first, [middle, *second[1:]], *others],
        [[repr(1.001 * float(first[0])), *first[1:]], second, *others],
        [*before, [last[0], repr(0.999 * float(last[1])), *last[2:]]],
    ):
        assert "leave out some of a cell" in refused(half, with_parts(proof, parts))


def test_part_that_is_no_range_of_doubles_is_refused(half, proof):
    first, *others = parts_in(proof)
    for forged, reason in (
        ([*first[1::-1], *first[2:]], "is none"),
        (["1/3", *first[1:]], "is not a double"),
    ):
        assert reason in refused(half, with_parts(proof, [forged, *others]))
    assert "lacks" in refused(half, with_parts(proof, others))


@pytest.mark.parametrize("window", [0, -1])
def test_parts_for_which_other_bounds_are_proved_prove_nothing(half, proved, proof, window):
    """Whatever the checker says: a part must lie in the one for which something is proved, and hold what is."""
    finding = proved.findings[CELLS]
    assert covered(half, proved.findings, CELLS) is finding
    first, second, *others = parts_in(proof, window)
    for parts in (
        [[*first[:2], *second[2:]], [*second[:2], *first[2:]], *others],  # bounds of another part
        [second, first, *others],
        [[first[0], second[1], *first[2:]], second, *others],  # a part that reaches into the next one
        [first, [first[0], *second[1:]], *others],
    ):
        forged = with_parts(proof, parts, window)
        assert told_with(half, proved, {CELLS: forged}).status is Status.UNDECIDED
        stated = {
            f"{name} {k} {window % len(windows_of(half))} {end}": value
            for k, each in enumerate(read(forged, len(windows_of(half))).friction[window])
            for name, ends in ((STEEPNESS, each.steepness), *each.friction.named.items())
            for end, value in zip(("low", "high"), ends, strict=True)
        }
        assert stated.keys() <= finding.numbers.keys()
        other = replace(finding, numbers={**finding.numbers, **stated})
        assert covered(half, {**proved.findings, CELLS: other}, CELLS).status is Status.UNDECIDED
