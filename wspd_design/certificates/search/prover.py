"""Branch and bound on a claim: fast, in doubles, and trusted by nobody.

All boxes are tried many at a time, those with the highest upper bound first. A box is decided if its enclosure
lies below the threshold; otherwise it is reduced to a face where the expression is monotone, or halved where the
slope matters most. Internally every claim is an upper bound; one from below is turned around.
"""

from dataclasses import dataclass, field
from fractions import Fraction
from math import inf
from typing import TYPE_CHECKING

from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.search.boxes import Boxes, joined
from wspd_design.certificates.search.budget import budget
from wspd_design.certificates.search.intervals import Backend, Intervals, default_backend
from wspd_design.certificates.search.progress import tell
from wspd_design.certificates.search.tape import Tape, enclosing, trace

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

BATCH = 512
DENIED_BOXES = 2048  # that are looked at when a claim is known to be false
SAMPLES = 2048  # of a round that looks for a good point
POLISH = 12  # rounds of narrowing around the best sample


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What the prover found, all of it hearsay until the checker agrees."""

    low: float  # the extreme value lies between low and high
    high: float
    point: dict[str, Fraction]  # where the end that a point attains was found
    undecided: float  # share of the box
    boxes: int
    cut: bool  # whether the budget ended the search
    tree: str  # split tree in preorder, empty if some box is undecided


def extreme(
    claim: Claim, *, tolerance: float, denied: bool = False, backend: Backend | None = None
) -> Outcome:
    """Enclose the supremum of a claim's expression, or the infimum for ``>=``; the bound does not matter.

    Parameters
    ----------
    claim : Claim
        Expression, box and direction.
    tolerance : float
        Width of the enclosure, in the unit of the claim.
    denied : bool
        Whether to stop soon once a point denies the claim: the enclosure is wide then.
    backend : Backend, optional
        Interval arithmetic.

    Returns
    -------
    Outcome
        When the budget is used up, the enclosure is wider and a share of the box undecided.
    """
    search = _Search(claim, backend or default_backend())
    search.run(None, tolerance, _beyond(claim) if denied else inf)
    return search.outcome()


def prove(claim: Claim, *, backend: Backend | None = None) -> Outcome:
    """Split the box until the claim is shown everywhere, or a point denies it, or the budget is used up."""
    search = _Search(claim, backend or default_backend())
    low, high = enclosing(claim.bound)
    search.run(low if claim.relation == "<=" else -high, 0.0)
    return search.outcome()


def _beyond(claim: Claim) -> float:
    """Return the bound as an upper bound, rounded up: what exceeds it denies the claim."""
    low, high = enclosing(claim.bound)
    return high if claim.relation == "<=" else -low


@dataclass(slots=True)
class _Node:
    """A box of the tree: letters of the faces it was reduced to, then a leaf's mark or a halving."""

    faces: str = ""
    mark: str = ""
    children: tuple[int, int] | None = None


@dataclass(slots=True)
class _Search:
    claim: Claim
    backend: Backend
    tape: Tape = field(init=False)
    sign: float = field(init=False)
    nodes: list[_Node] = field(default_factory=lambda: [_Node()])
    best: float = -inf  # reached at a point, for certain
    best_place: "Array | None" = None
    ceiling: float = -inf  # largest upper bound of a decided box
    pending: "Boxes | None" = None
    count: int = 0
    cut: bool = False

    def __post_init__(self) -> None:
        self.tape = trace(self.claim, self.backend)
        self.sign = 1.0 if self.claim.relation == "<=" else -1.0

    def run(self, bound: float | None, tolerance: float, denying: float = inf) -> None:
        """Decide boxes against the bound, or against the best point plus the tolerance.

        A point beyond ``denying`` leaves only a few boxes to be looked at.
        """
        import numpy as np

        allowed = budget().boxes
        size = len(self.claim.free)
        self._look_around(size)
        waiting = Boxes(
            np.zeros((size, 1)), np.ones((size, 1)), np.array([inf]), np.zeros(1, dtype=int), np.ones(1)
        )
        while waiting.upper.size:
            threshold = self.best + tolerance if bound is None else bound
            # The box as a whole is looked at whatever the budget, so that some enclosure is known.
            self.cut = self.count > 0 and self.count >= allowed
            known = self.best > denying and self.count >= DENIED_BOXES
            if self.best > threshold or self.cut or known:
                break
            order = np.argsort(-waiting.upper)
            batch, rest = waiting.take(order[:BATCH]), waiting.take(order[BATCH:])
            fresh = self._advance(batch, threshold)
            waiting = joined(rest, fresh)
            tell(1.0 - float(waiting.share.sum()))
        self.pending = waiting

    def outcome(self) -> Outcome:
        """Sum up."""
        assert self.pending is not None
        assert self.best_place is not None
        high = max(self.ceiling, self.best, float(self.pending.upper.max(initial=-inf)))
        ends = (self.best, high) if self.sign > 0.0 else (-high, -self.best)
        places = {v.name: float(t) for v, t in zip(self.claim.free, self.best_place, strict=True)}
        decided = self.pending.upper.size == 0
        return Outcome(
            low=ends[0],
            high=ends[1],
            point={v.name: v.low + (v.high - v.low) * Fraction(places[v.name]) for v in self.claim.free},
            undecided=float(self.pending.share.sum()),
            boxes=self.count,
            cut=self.cut,
            tree=self._tree() if decided else "",
        )

    def _look_around(self, size: int) -> None:
        """Find a good point by sampling and narrowing, so that most boxes are decided at first sight.

        Doubles choose a point in each round; intervals say at the end what is reached there.
        """
        import numpy as np

        generator = np.random.default_rng(0)
        best, reached, width = np.full((size, 1), 0.5), -inf, 0.5
        tried = [best]
        for _ in range(POLISH):
            points = best + width * generator.uniform(-1.0, 1.0, (size, SAMPLES))
            # A third of the samples keeps each coordinate or goes to an end of the box, where extremes like to be.
            choice = generator.integers(0, 6, (size, SAMPLES))
            points = np.where(choice == 0, best, np.clip(points, 0.0, 1.0))
            points = np.where(choice == 1, np.round(best), points)
            found = self.sign * self.tape.sample(points)
            found = np.where(np.isfinite(found), found, -inf)
            winner = int(np.argmax(found))
            if found[winner] > reached:
                best, reached = points[:, [winner]], float(found[winner])
                tried.append(best)
            width *= 0.45
        self._try(np.hstack(tried))

    def _try(self, points: "Array") -> None:
        """Keep the best of some points."""
        self._keep(points, self._value(self.tape.evaluate(points, points, derivatives=False).value))

    def _keep(self, points: "Array", found: Intervals) -> None:
        """Keep the best of some points, given what the expression is there."""
        import numpy as np

        reached = np.where(np.isnan(found.lo), -inf, found.lo)
        winner = int(np.argmax(reached))
        if self.best_place is None or reached[winner] > self.best:
            self.best, self.best_place = float(reached[winner]), points[:, winner].copy()

    def _value(self, found: Intervals) -> Intervals:
        return found if self.sign > 0.0 else -found

    def _advance(self, boxes: Boxes, threshold: float) -> Boxes:
        """Decide, reduce or halve each box; return the new ones."""
        import numpy as np

        self.count += boxes.upper.size
        found = self.tape.evaluate(boxes.low, boxes.high)
        plain = _upper(self._value(found.value))
        middle = 0.5 * (boxes.low + boxes.high)
        center = self._value(self.tape.evaluate(middle, middle, derivatives=False).value)
        self._keep(middle, center)
        gradient = found.gradient
        if gradient is None:  # the expression is constant
            gradient = self.backend.Interval(np.zeros_like(boxes.low), np.zeros_like(boxes.low))
        gradient = self._value(gradient)
        low = np.where(np.isnan(gradient.lo), -inf, gradient.lo)
        high = np.where(np.isnan(gradient.hi), inf, gradient.hi)
        low, high = np.broadcast_to(low, boxes.low.shape), np.broadcast_to(high, boxes.low.shape)
        centered = self._mean_value(boxes, middle, center, low, high)
        decided = (plain <= threshold) | (centered <= threshold)
        shown = np.where(plain <= threshold, plain, centered)
        for k in np.flatnonzero(decided):
            self.nodes[boxes.node[k]].mark = "." if plain[k] <= threshold else "~"
        # What a leaf shows is what the checker will see there, even if its parent knew better.
        self.ceiling = max(self.ceiling, float(shown[decided].max(initial=-inf)))
        boxes.upper = np.minimum(np.minimum(plain, centered), boxes.upper)
        keep = np.flatnonzero(~decided)
        return self._divide(boxes.take(keep), low[:, keep], high[:, keep])

    def _mean_value(
        self, boxes: Boxes, middle: "Array", center: Intervals, low: "Array", high: "Array"
    ) -> "Array":
        """Upper bound by the mean value form."""
        found = center
        for row in range(len(low)):
            reach = self.backend.Interval(boxes.low[row] - middle[row], boxes.high[row] - middle[row])
            found = found + self.backend.Interval(low[row], high[row]) * reach
        return _upper(found)

    def _divide(self, boxes: Boxes, low: "Array", high: "Array") -> Boxes:
        """Reduce to a face where the sign of a slope is known, else halve where it matters most."""
        import numpy as np

        wide = boxes.high > boxes.low
        rising, falling = (low >= 0.0) & wide, (high <= 0.0) & wide
        falling &= ~rising
        reduced = (rising | falling).any(axis=0)
        corner_low = np.where(rising, boxes.high, boxes.low)
        corner_high = np.where(falling, boxes.low, boxes.high)
        for k in np.flatnonzero(reduced):
            rows = np.flatnonzero(rising[:, k] | falling[:, k])
            self.nodes[boxes.node[k]].faces += "".join(chr(ord("A") + row) for row in rows)
        faces = Boxes(
            corner_low[:, reduced],
            corner_high[:, reduced],
            boxes.upper[reduced],
            boxes.node[reduced],
            boxes.share[reduced],
        )
        return joined(
            faces, self._halve(boxes.take(np.flatnonzero(~reduced)), low[:, ~reduced], high[:, ~reduced])
        )

    def _halve(self, boxes: Boxes, low: "Array", high: "Array") -> Boxes:
        import numpy as np

        if boxes.upper.size == 0:
            return boxes
        width = boxes.high - boxes.low
        influence = np.minimum(np.maximum(-low, high), 1e300) * width
        axis = np.argmax(np.where(width > 0.0, influence, -1.0), axis=0)
        which = np.arange(axis.size)
        middle = 0.5 * (boxes.low[axis, which] + boxes.high[axis, which])
        lower_high, upper_low = boxes.high.copy(), boxes.low.copy()
        lower_high[axis, which] = upper_low[axis, which] = middle
        first = len(self.nodes)
        for k in which:
            node = self.nodes[boxes.node[k]]
            node.mark, node.children = (
                chr(ord("a") + int(axis[k])),
                (first + 2 * int(k), first + 2 * int(k) + 1),
            )
            self.nodes += [_Node(), _Node()]
        numbers = first + 2 * which
        half = 0.5 * boxes.share
        return joined(
            Boxes(boxes.low, lower_high, boxes.upper, numbers, half),
            Boxes(upper_low, boxes.high, boxes.upper, numbers + 1, half),
        )

    def _tree(self) -> str:
        steps, stack = [], [0]
        while stack:
            node = self.nodes[stack.pop()]
            steps.append(node.faces + node.mark)
            if node.children is not None:
                stack += reversed(node.children)
        return "".join(steps)


def _upper(found: Intervals) -> "Array":
    """Upper ends; what is not a number may be anything."""
    import numpy as np

    return np.where(np.isnan(found.hi), inf, found.hi)
