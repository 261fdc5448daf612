"""Where a loop is real or of magnitude one, and its balanced disk margin, over all frequencies.

For a strictly proper loop the sensitivity is S = o/c, with the characteristic polynomials o of the open and c of the
closed loop, and the loop itself is L = (c - o)/o. With z = (1 + s)/(1 - s) the same holds for a sampled loop in s,
where it is excited at s = i w, w >= 0, too. The square of abs(S - 1/2) is then a ratio of polynomials in w^2. Its slope
vanishes at the zeros of a polynomial, which finds peaks that are narrower than the steps of any grid: the closed loop
may be hardly damped.
"""

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.floating]


def disk_margin(
    opened: "NDArray[np.complex128]", closed: "NDArray[np.complex128]", *, sampled: bool
) -> float:
    """Reciprocal of the largest abs(S - 1/2) over all frequencies [-].

    Parameters
    ----------
    opened : array
        Poles of a strictly proper loop.
    closed : array
        As many poles after negative feedback, all stable.
    sampled : bool
        Whether the poles are those of a sampled loop.
    """
    import numpy as np

    denominator = _in_s(closed, sampled=sampled)
    numerator = _in_s(opened, sampled=sampled) - 0.5 * denominator
    top, bottom = _squared(numerator), _squared(denominator)
    slope: Array = np.polysub(np.polymul(np.polyder(top), bottom), np.polymul(top, np.polyder(bottom)))
    turning = np.roots(slope).real
    at = 1j * np.sqrt([0.0, *turning[turning > 0.0]])
    peaks = np.abs(np.polyval(numerator, at) / np.polyval(denominator, at))
    highest = abs(numerator[0] / denominator[0])  # w to infinity, half the sampling frequency if sampled
    return float(1.0 / max(highest, *peaks))


class Crossings(NamedTuple):
    """Of a loop at s = i w; a sampled one has w = tan(frequency sample time/2)."""

    real: "Array"  # the loop where it is real
    angles: "Array"  # its argument where its magnitude is one [rad]
    frequencies: "Array"  # w there


def crossings(
    opened: "NDArray[np.complex128]", closed: "NDArray[np.complex128]", *, sampled: bool
) -> Crossings:
    """Find all crossings for w >= 0; parameters as in :func:`disk_margin`.

    Imaginary part and squared magnitude are ratios of polynomials in w^2, but for a factor w.
    """
    import numpy as np

    below = _in_s(opened, sampled=sampled)
    above = _in_s(closed, sampled=sampled) - below

    def loop(w: "Array") -> "NDArray[np.complex128]":
        return np.asarray(np.polyval(above, 1j * w) / np.polyval(below, 1j * w), dtype=np.complex128)

    turned = np.polymul(above, _mirrored(below))[
        ::-1
    ]  # real part: even powers of s; imaginary part: odd ones
    odd = _mirrored(turned[1::2][::-1])
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.array([loop(np.zeros(1))[0].real, above[0] / below[0]])  # w = 0 and infinity
    real = np.array([*loop(_positive(odd)).real, *ends])
    frequencies = _positive(np.polysub(_squared(above), _squared(below)))
    return Crossings(
        real=real[np.isfinite(real)], angles=np.angle(loop(frequencies)), frequencies=frequencies
    )


def _positive(polynomial: "Array") -> "Array":
    """Roots of the positive zeros of a polynomial in w^2."""
    import numpy as np

    zeros = np.roots(polynomial)
    real = zeros.real[zeros.imag == 0.0]
    found: Array = np.sqrt(real[real > 0.0])
    return found


def _in_s(poles: "NDArray[np.complex128]", *, sampled: bool) -> "Array":
    """Multiply s - pole, or what z - pole is a multiple of in s."""
    import numpy as np

    product: NDArray[np.complexfloating] = np.ones(1, dtype=np.complex128)
    for pole in poles:
        product = np.polymul(product, (1.0 + pole, 1.0 - pole) if sampled else (1.0, -pole))
    return product.real


def _squared(polynomial: "Array") -> "Array":
    """Square of the magnitude of a polynomial at i w, as a polynomial in w^2."""
    import numpy as np

    in_s_squared = np.polymul(polynomial, _mirrored(polynomial))[::2]
    return _mirrored(in_s_squared)


def _mirrored(polynomial: "Array") -> "Array":
    """Polynomial with the sign of its argument turned."""
    import numpy as np

    return polynomial * (-1.0) ** np.arange(len(polynomial))[::-1]
