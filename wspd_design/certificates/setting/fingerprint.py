"""Fingerprint of all that a verdict rests on: the problem with its law, and the constants of the model."""

from wspd_design.certificates.records import Problem
from wspd_design.parameters.fingerprint import fingerprint
from wspd_design.parameters.loading import constants


def model_hash(problem: Problem) -> str:
    """Return the SHA-256 of all numbers that a verdict rests on, and of the code of a law of one's own.

    Raises
    ------
    UserError
        If the law holds something that has no fingerprint.
    """
    return fingerprint([problem, constants()])
