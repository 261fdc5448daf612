"""Verdicts on what a simulation supports, and a place of it can deny."""

from wspd_design.certificates.kernel.finding import Finding
from wspd_design.certificates.records import Status


def supported(denial: Finding, samples: Finding) -> Status:
    """Refuted by a place that is evaluated again, else what the samples give: evidence, or nothing."""
    return Status.REFUTED if denial.status is Status.REFUTED else samples.status
