"""The instructions of a CasADi function on arrays of intervals, with forward derivatives."""

from dataclasses import dataclass
from fractions import Fraction
from math import inf, nextafter
from typing import TYPE_CHECKING, NamedTuple

from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.search.doubles import Doubles, is_whole
from wspd_design.certificates.search.intervals import Backend, Intervals
from wspd_design.codegen.graph import operation_names

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


class Instruction(NamedTuple):
    """One operation: the numbers of its operands and of its result."""

    operation: str
    operands: tuple[int, ...]
    result: int


class Enclosure(NamedTuple):
    """Enclosure of a function on boxes, and of its slopes along each free variable, scaled to [0, 1]."""

    value: Intervals  # (boxes,)
    gradient: Intervals | None  # (free variables, boxes)


class Jet(NamedTuple):
    """A value with its derivatives; ``None`` stands for derivatives that are all zero."""

    value: Intervals
    slope: Intervals | None


def enclosing(number: Fraction) -> tuple[float, float]:
    """Return the tightest doubles around a rational."""
    near = float(number)
    below = near if Fraction(near) <= number else nextafter(near, -inf)
    above = near if Fraction(near) >= number else nextafter(near, inf)
    return below, above


@dataclass(frozen=True, slots=True)
class Tape:
    """A claim's expression on intervals, over a box that is scaled to [0, 1] in every free variable."""

    claim: Claim
    backend: Backend
    known: dict[int, Jet]  # results that do not depend on the box
    instructions: tuple[Instruction, ...]  # the others
    output: int

    def evaluate(self, low: "Array", high: "Array", *, derivatives: bool = True) -> Enclosure:
        """Enclose the expression on boxes.

        Parameters
        ----------
        low, high : ndarray
            Corners (free variables, boxes), in [0, 1].
        derivatives : bool
            Whether to enclose the slopes as well.
        """
        inputs = self._inputs(low, high, derivatives)
        ring, work = Ring(self.backend), dict(self.known)
        for operation, operands, result in self.instructions:
            if operation == "OP_INPUT":
                work[result] = inputs[operands[0]]
            else:
                work[result] = ring.apply(operation, [work[k] for k in operands])
        found = work[self.output]
        return Enclosure(_filled(found.value, low.shape[1:]), found.slope)

    def sample(self, points: "Array") -> "Array":
        """Evaluate the expression in doubles, which proves nothing.

        Parameters
        ----------
        points : ndarray
            Coordinates (free variables, points), in [0, 1].
        """
        import numpy as np

        places = {
            k: float(v.low) + float(v.high - v.low) * points[row]
            for row, (k, v) in enumerate((k, v) for k, v in enumerate(self.claim.variables) if v.free)
        }
        plain = Doubles(self.backend)
        work = {k: np.asarray(0.5 * (jet.value.lo + jet.value.hi)) for k, jet in self.known.items()}
        with np.errstate(all="ignore"):
            for operation, operands, result in self.instructions:
                if operation == "OP_INPUT":
                    work[result] = places[operands[0]]
                else:
                    work[result] = plain.apply(operation, [work[k] for k in operands])
        return np.broadcast_to(work[self.output], points.shape[1:])

    def _inputs(self, low: "Array", high: "Array", derivatives: bool) -> dict[int, Jet]:
        """Return the free variables on the boxes, by their numbers among all variables."""
        import numpy as np

        found, count = {}, len(self.claim.free)
        free = [(k, v) for k, v in enumerate(self.claim.variables) if v.free]
        for row, (k, v) in enumerate(free):
            width = thin(self.backend, enclosing(v.high - v.low))
            place = self.backend.Interval(low[row], high[row])
            slope = None
            if derivatives:
                along = np.zeros((2, count, 1))
                along[0, row], along[1, row] = width.lo, width.hi
                slope = self.backend.Interval(along[0], along[1])
            found[k] = Jet(thin(self.backend, enclosing(v.low)) + width * place, slope)
        return found


def thin(backend: Backend, ends: tuple[float, float]) -> Intervals:
    """Return an interval for all boxes."""
    import numpy as np

    return backend.Interval(np.array([ends[0]]), np.array([ends[1]]))


def trace(claim: Claim, backend: Backend) -> Tape:
    """Record the instructions of a claim's CasADi function, and do those that no free variable enters.

    Raises
    ------
    ValueError
        If it contains an operation that has no interval form.
    """
    names = operation_names()
    function = claim.function()
    ring = Ring(backend)
    place: dict[
        int, int
    ] = {}  # CasADi uses the places of its work vector again; here each result has its own
    known: dict[int, Jet] = {}
    instructions = []
    output = -1
    for k in range(function.n_instructions()):
        operation = names[function.instruction_id(k)]
        operands, results = function.instruction_input(k), function.instruction_output(k)
        if operation == "OP_OUTPUT":
            output = place[operands[0]]
            continue
        if operation == "OP_CONST":
            known[k] = Jet(thin(backend, enclosing(Fraction(function.instruction_constant(k)))), None)
        elif operation == "OP_INPUT":
            v = claim.variables[operands[1]]
            if v.free:
                instructions.append(Instruction(operation, (operands[1],), k))
            else:
                known[k] = Jet(thin(backend, enclosing(v.low)), None)
        elif operation in OPERATIONS:
            sources = tuple(place[operand] for operand in operands)
            if all(source in known for source in sources):
                known[k] = ring.apply(operation, [known[source] for source in sources])
            else:
                instructions.append(Instruction(operation, sources, k))
        else:
            raise ValueError(f"{claim.name}: the operation {operation} has no interval form")
        place[results[0]] = k
    return Tape(claim, backend, known, tuple(instructions), output)


OPERATIONS = frozenset(
    f"OP_{name}"
    for name in (
        *("ADD", "SUB", "MUL", "DIV", "NEG", "TWICE", "SQ", "INV", "SQRT", "EXP", "LOG", "ATAN"),
        *("FABS", "POW", "CONSTPOW", "ASSIGN"),
    )
)


class Ring:
    """Arithmetic of values with derivatives."""

    def __init__(self, backend: Backend) -> None:
        self.backend = backend
        self.zero, self.half, self.one = (thin(backend, (x, x)) for x in (0.0, 0.5, 1.0))

    def apply(self, operation: str, operands: list[Jet]) -> Jet:
        """Do one CasADi operation."""
        name = operation.removeprefix("OP_").lower()
        if name in ("pow", "constpow"):
            return self.power(*operands)
        found: Jet = getattr(self, name)(*operands)
        return found

    def assign(self, x: Jet) -> Jet:
        """Copy."""
        return x

    def add(self, x: Jet, y: Jet) -> Jet:
        """Sum."""
        return Jet(x.value + y.value, _sum(x.slope, y.slope))

    def neg(self, x: Jet) -> Jet:
        """Opposite."""
        return Jet(-x.value, None if x.slope is None else -x.slope)

    def sub(self, x: Jet, y: Jet) -> Jet:
        """Difference."""
        return Jet(x.value - y.value, _sum(x.slope, self.neg(y).slope))

    def twice(self, x: Jet) -> Jet:
        """Double."""
        return self.add(x, x)

    def mul(self, x: Jet, y: Jet) -> Jet:
        """Product."""
        return Jet(x.value * y.value, _sum(_scaled(x.slope, y.value), _scaled(y.slope, x.value)))

    def inv(self, x: Jet) -> Jet:
        """Reciprocal."""
        value = self.one / x.value
        return Jet(value, _scaled(x.slope, -self.backend.sqr(value)))

    def div(self, x: Jet, y: Jet) -> Jet:
        """Quotient; its slope as that of a product, which is how the checker sees it."""
        inverse = self.inv(y)
        slope = _sum(_scaled(x.slope, inverse.value), _scaled(inverse.slope, x.value))
        return Jet(x.value / y.value, slope)

    def sq(self, x: Jet) -> Jet:
        """Square."""
        return Jet(self.backend.sqr(x.value), _scaled(x.slope, x.value + x.value))

    def sqrt(self, x: Jet) -> Jet:
        """Square root."""
        value = self.backend.sqrt(x.value)
        return Jet(value, _scaled(x.slope, self.half / value))

    def exp(self, x: Jet) -> Jet:
        """Exponential function."""
        value = self.backend.exp(x.value)
        return Jet(value, _scaled(x.slope, value))

    def log(self, x: Jet) -> Jet:
        """Natural logarithm."""
        return Jet(self.backend.log(x.value), _scaled(x.slope, self.one / x.value))

    def atan(self, x: Jet) -> Jet:
        """Inverse tangent."""
        slope = self.one / (self.one + self.backend.sqr(x.value))
        return Jet(self.backend.atan(x.value), _scaled(x.slope, slope))

    def fabs(self, x: Jet) -> Jet:
        """Magnitude; where the sign is open its slope may be any of Clarke's."""
        import numpy as np

        low, high = x.value.lo, x.value.hi
        value = self.backend.Interval(np.maximum(0.0, np.maximum(low, -high)), np.maximum(-low, high))
        positive, negative = low >= 0.0, (high <= 0.0) & (low < 0.0)
        sign = self.backend.Interval(np.where(positive, 1.0, -1.0), np.where(negative, -1.0, 1.0))
        return Jet(value, _scaled(x.slope, sign))

    def power(self, x: Jet, y: Jet) -> Jet:
        """Power with a constant exponent; a broken one needs a positive base."""
        exponent = float(y.value.lo[0])
        if y.slope is None and exponent == y.value.hi[0] and is_whole(exponent):
            whole = self.integer_power(x, int(abs(exponent)))
            return whole if exponent >= 0.0 else self.inv(whole)
        return self.exp(self.mul(y, self.log(x)))

    def integer_power(self, x: Jet, n: int) -> Jet:
        """Power with a natural exponent by squaring."""
        if n == 0:
            return Jet(self.one, None)
        half = self.integer_power(x, n // 2)
        square = self.sq(half) if n > 1 else Jet(self.one, None)
        return self.mul(square, x) if n % 2 else square


def _sum(x: Intervals | None, y: Intervals | None) -> Intervals | None:
    if x is None or y is None:
        return y if x is None else x
    return x + y


def _scaled(slope: Intervals | None, factor: Intervals) -> Intervals | None:
    return None if slope is None else slope * factor


def _filled(found: Intervals, shape: tuple[int, ...]) -> Intervals:
    """Repeat a value that does not depend on the box."""
    import numpy as np

    return type(found)(np.broadcast_to(found.lo, shape).copy(), np.broadcast_to(found.hi, shape).copy())
