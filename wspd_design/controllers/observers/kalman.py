from typing import NamedTuple
from wspd_design.model.number import Number


class Belief(NamedTuple):
    mean: tuple[Number, ...]
    covariance: tuple[Number, ...]  # upper triangle, row by row


def at(m, i, j):
    i, j = min(i, j), max(i, j)
    return i * m - i * (i - 1) // 2 + j - i


def predicted(belief, mean, F, noise):
    m = len(mean)
    P = belief.covariance
    full = [[P[at(m, i, j)] for j in range(m)] for i in range(m)]
    FP = [[_dot(F[i], [full[k][j] for k in range(m)]) for j in range(m)] for i in range(m)]
    out = []
    for i in range(m):
        for j in range(i, m):
            x = _dot(F[j], FP[i])
            out.append(x + noise[i] if i == j else x)
    return Belief(mean, tuple(out))


def _dot(a, b):
    s = 0.0
    for x, y in zip(a, b):
        if isinstance(x, float) and x == 0.0:
            continue
        s = s + (y if isinstance(x, float) and x == 1.0 else x * y)
    return s


def corrected(belief, row, innovation, variance, use, cross=None):
    m = len(belief.mean)
    P = belief.covariance
    PH = [_dot(row, [P[at(m, i, j)] for j in range(m)]) for i in range(m)]
    S = _dot(row, PH) + variance
    if cross is not None:
        PH[0] = PH[0] + cross
    K = [use * x / S for x in PH]
    mean = tuple(x + k * innovation for x, k in zip(belief.mean, K))
    out = tuple(P[at(m, i, j)] - K[i] * PH[j] for i in range(m) for j in range(i, m))
    return Belief(mean, out)
