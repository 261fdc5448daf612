"""A proof that asks for more work than the checker may do is left out; what comes after it is still decided."""

from dataclasses import replace
from fractions import Fraction

from wspd_design.certificates.checks import frame
from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.kernel.claim import Claim, variable
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Inequality, proof_of
from wspd_design.certificates.records import Status


def claimed(bound):
    return Claim(
        name="x",
        variables=(variable("x", (0.0, 1.0), "-"),),
        expression=lambda x: x["x"],
        relation=">=",
        bound=Fraction(bound),
        unit="-",
    )


def halved(times):
    return "." if times == 0 else "a" + halved(times - 1) * 2


def test_what_comes_after_a_proof_that_is_too_long_is_decided(monkeypatch):
    monkeypatch.setattr(frame, "Work", lambda: Work(5_000))
    long, short = (
        Stated(proof=proof_of(claimed(-1), halved(levels)), place={"x": 0.5}) for levels in (12, 2)
    )
    wanted = tuple(
        Inequality(key=key, claim=claimed(bound)) for key, bound in (("a", -1), ("b", -1), ("c", 1))
    )
    found = frame.accepted(wanted, {"a": long, "b": short, "c": replace(short, proof=None)})
    assert found["a"].status is Status.UNDECIDED
    assert found["a"].stated.proof is None
    assert found["b"].status is Status.PROVED
    assert found["c"].status is Status.REFUTED
