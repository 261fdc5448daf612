"""Which variables a claim depends on, read from its symbols and never typed."""

from wspd_design.certificates.kernel.claim import formula


def used(claim):
    """Names of the variables that matter, in the order of the claim.

    A variable whose symbol is missing in the expression or in its arranged form does not matter, since the two are
    the same function.
    """
    symbols = _symbols(claim.expression, claim)
    if claim.form is not None:
        symbols &= _symbols(claim.form, claim)
    return tuple(v.name for v in claim.variables if v.name in symbols)


def _symbols(expression, claim):
    return {step[1] for step in formula(expression, claim.variables) if step[0] == "x"}
