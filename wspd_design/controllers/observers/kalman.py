"""A Kalman filter whose unknowns but the first stay as they are: prediction and correction without branches.

The covariance is kept as its upper triangle, row by row, so that it is symmetric whatever is rounded. Measurements come
one by one; the variance V > 0 of each keeps the covariance positive (``derivations/wheel_filter.py``).
"""

from collections.abc import Sequence
from typing import NamedTuple

from wspd_design.model.number import Number


class Belief(NamedTuple):
    """What is known about some unknowns."""

    mean: tuple[Number, ...]
    covariance: tuple[
        Number, ...
    ]  # upper triangle, row by row; the first is the variance of the first unknown

    @property
    def spread(self) -> Number:
        """Variance of the first unknown."""
        return self.covariance[0]

    def between(self, row: int, column: int) -> Number:
        """Covariance of two unknowns."""
        low, high = min(row, column), max(row, column)
        return self.covariance[low * len(self.mean) - low * (low - 1) // 2 + high - low]

    def with_spread(self, more: Number) -> "Belief":
        """Return the same with more variance of the first unknown."""
        return self._replace(covariance=(self.covariance[0] + more, *self.covariance[1:]))


def independent(mean: Sequence[Number], deviations: Sequence[Number]) -> Belief:
    """Return what is known about unknowns that have nothing to do with each other."""
    count, zero = len(mean), 0.0 * mean[0]
    covariance = [
        deviations[row] * deviations[row] + zero if row == column else zero
        for row in range(count)
        for column in range(row, count)
    ]
    return Belief(tuple(mean), tuple(covariance))


def predicted(belief: Belief, first: Number, slopes: Sequence[Number], noise: Sequence[Number]) -> Belief:
    """Return what is known a sample later.

    Parameters
    ----------
    belief : Belief
        What is known now.
    first : number
        The first unknown a sample later.
    slopes : sequence of number
        Its derivatives with respect to all unknowns now.
    noise : sequence of number
        Variances that the sample adds to the unknowns.
    """
    count = len(belief.mean)
    row = [_product(slopes, [belief.between(k, j) for k in range(count)]) for j in range(count)]
    covariance = [_product(slopes, row) + noise[0], *row[1:]]
    for i in range(1, count):
        covariance += [belief.between(i, j) + (noise[i] if i == j else 0.0) for j in range(i, count)]
    return Belief((first, *belief.mean[1:]), tuple(covariance))


def corrected(
    belief: Belief,
    slopes: Sequence[Number],
    innovation: Number,
    variance: Number,
    *,
    use: Number = 1.0,
    common: Number = 0.0,
) -> Belief:
    """Return what is known after a measurement.

    Parameters
    ----------
    belief : Belief
        What is known before.
    slopes : sequence of number
        Derivatives of what is measured with respect to the unknowns; the first is 0 where ``common`` is not.
    innovation : number
        What is measured less what was expected.
    variance : number
        Of the noise of the measurement.
    use : number
        1, or 0 to leave the measurement out.
    common : number
        Covariance of the error of the first unknown and that noise.
    """
    count = len(belief.mean)
    shared = [_product(slopes, [belief.between(i, j) for j in range(count)]) for i in range(count)]
    total = _product(slopes, shared) + variance
    shared[0] = shared[0] + common
    gains = [use * each / total for each in shared]
    mean = [x + gain * innovation for x, gain in zip(belief.mean, gains, strict=True)]
    covariance = [belief.between(i, j) - gains[i] * shared[j] for i in range(count) for j in range(i, count)]
    return Belief(tuple(mean), tuple(covariance))


def _product(left: Sequence[Number], right: Sequence[Number]) -> Number:
    """Scalar product of two rows."""
    first, *others = (x * y for x, y in zip(left, right, strict=True))
    for each in others:
        first = first + each
    return first
