"""A certificate, its file, and what forgers make of it: shared by the tests of all checks."""

import json
from dataclasses import dataclass
from typing import Any
from unittest import mock

from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.replay import replay

WORDS = {
    "claim": "Every stop is stable.",
    "explanation": "All is well.",
    "assumptions": ["none"],
    "varied": ["everything"],
    "held": ["nothing"],
    "margin": {"low": 1.0, "high": 99.0, "unit": "-"},
    "hypotheses": [],
    "witness": [{"name": "slip", "value": 0.9, "unit": "-"}],
    "model_sha256": "0" * 64,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Kept:
    """A certificate with its file."""

    problem: Problem
    certificate: Certificate
    content: dict[str, Any]


def keep(check, problem):
    """Run a check, write the file, and see that it is accepted word for word."""
    made = check.run(problem)
    text = certificate_text(made)
    found = replay(problem, text)
    assert found.accepted, found.reason
    assert found.certificate.status is made.status
    return Kept(problem=problem, certificate=made, content=json.loads(text))


def refused(kept, **changes):
    """Whether a file with other entries is refused."""
    return not replay(kept.problem, json.dumps(kept.content | changes)).accepted


def forgeries(kept):
    """Yield all single entries that a forger may change."""
    yield from ({"status": status.name} for status in Status if status is not kept.certificate.status)
    yield from ({name: entry} for name, entry in WORDS.items() if kept.content[name] != entry)


def no_word_can_be_changed(kept):
    """Refuse every other status, claim, margin, hypothesis, assumption, scope, witness and hash.

    The findings of the file stay as they are, so that they are decided about only once, in :func:`keep`.
    """
    with mock.patch("wspd_design.certificates.replay._findings", return_value=kept.certificate.findings):
        assert not refused(kept)
        for changes in forgeries(kept):
            assert refused(kept, **changes), changes


def no_proof_can_be_missed(kept):
    """Without a proof, or with one under the name of another, nothing of the same strength is accepted."""
    findings = kept.content["findings"]
    with_proof = [key for key, finding in findings.items() if "proof" in finding]
    for key in (with_proof[0], with_proof[-1]):
        less = {name: each for name, each in findings.items() if name != key}
        assert refused(kept, findings=less), key
        stripped = {name: entry for name, entry in findings[key].items() if name != "proof"}
        assert refused(kept, findings=findings | {key: stripped}), key


def not_for(kept, problem):
    """Whether the file is refused for another problem."""
    return not replay(problem, json.dumps(kept.content)).accepted
