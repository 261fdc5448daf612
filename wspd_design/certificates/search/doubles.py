"""The operations of a CasADi function on doubles, for hints: nothing is enclosed, nothing is proved."""

from math import prod
from typing import TYPE_CHECKING

from wspd_design.certificates.search.intervals import Backend

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

MOST_FACTORS = 16  # of a power with a whole exponent


class Doubles:
    """Arithmetic of doubles; functions are those of the intervals, so that every machine finds the same."""

    def __init__(self, backend: Backend) -> None:
        self.backend = backend

    def apply(self, operation: str, operands: "list[Array]") -> "Array":
        """Do one CasADi operation."""
        import numpy as np

        x, y = operands[0], operands[-1]
        match operation.removeprefix("OP_"):
            case "ADD" | "TWICE":
                return x + y
            case "SUB":
                return x - y
            case "MUL" | "SQ":
                return x * y
            case "DIV":
                return x / y
            case "INV":
                return 1.0 / x
            case "NEG":
                return -x
            case "SQRT":
                return np.sqrt(x)
            case "FABS":
                return np.abs(x)
            case "ASSIGN":
                return x
            case "POW" | "CONSTPOW":
                return self._power(x, y)
            case name:
                return self._function(name.lower(), x)

    def _power(self, x: "Array", y: "Array") -> "Array":
        import numpy as np

        exponent = float(y.flat[0])
        if y.size == 1 and is_whole(exponent):
            product = prod([x] * int(abs(exponent)), start=np.ones(1))
            return product if exponent >= 0.0 else 1.0 / product
        return self._function("exp", y * self._function("log", x))

    def _function(self, name: str, x: "Array") -> "Array":
        found: Array = getattr(self.backend, name)(self.backend.Interval(x, x)).lo
        return found


def is_whole(exponent: float) -> bool:
    """Whether a power is a product of few factors."""
    return exponent.is_integer() and abs(exponent) <= MOST_FACTORS
