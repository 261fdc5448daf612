"""Numbers in sentences: a few digits, rounded to the side on which the sentence stays true."""

from decimal import ROUND_CEILING, ROUND_FLOOR, Context

DIGITS = 4


def few_digits(value: float, *, up: bool, digits: int = DIGITS) -> str:
    """Write a number that is not smaller, or not larger, than the one given.

    Parameters
    ----------
    value : float
        Finite number.
    up : bool
        Whether the text may only be larger; else only smaller.
    digits : int
        Number of significant digits.
    """
    rounded = Context(prec=digits, rounding=ROUND_CEILING if up else ROUND_FLOOR).create_decimal(value)
    return f"{float(rounded):.{digits}g}"
