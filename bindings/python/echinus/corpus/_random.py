"""Random numbers that are the same on every machine: they use the integers of Philox, and + - * / sqrt of doubles."""

from __future__ import annotations

import hashlib

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]


class Random:
    """A stream of random numbers for each key. NumPy's own distributions may change from version to version."""

    def __init__(self, key: bytes) -> None:
        words = np.frombuffer(hashlib.sha256(key).digest()[:16], "<u8")
        self._bits = np.random.Philox(key=words)

    def uniform(self, *shape: int) -> Doubles:
        """Evenly distributed multiples of 2^-53 in [0, 1)."""
        raw = np.asarray(self._bits.random_raw(int(np.prod(shape))), np.uint64)
        raw >>= np.uint64(11)
        return raw.reshape(shape) * 2.0**-53

    def normal(self, *shape: int) -> Doubles:
        """Normally distributed numbers with mean 0 and variance 1."""
        return normal_quantile(self.uniform(*shape) + 2.0**-54)


def normal_quantile(p: Doubles) -> Doubles:
    """The inverse of the normal distribution function, with a relative error of at most 1.2e-9, for 0 < p < 1.

    Acklam's rational approximations (2003): one for the middle and one for the tails, which one number in twenty needs.
    """
    middle = p - 0.5
    r = middle * middle
    result = middle * _polynomial(r, _A) / _polynomial(r, (*_B, 1.0))
    tail = np.minimum(p, 1 - p)
    far = tail < 0.02425
    q = np.sqrt(-2 * _log(tail[far]))
    outer = _polynomial(q, _C) / _polynomial(q, (*_D, 1.0))
    result[far] = np.where(middle[far] < 0, outer, -outer)
    return result


def _polynomial(x: Doubles, coefficients: tuple[float, ...]) -> Doubles:
    """Evaluates a polynomial; the coefficient of the highest power is the first."""
    result = np.full_like(x, coefficients[0])
    for c in coefficients[1:]:
        result *= x
        result += c
    return result


def _log(x: Doubles) -> Doubles:
    """The logarithm, by the series of atanh, since the logarithms of C libraries differ in the last bit."""
    mantissa, exponent = np.frexp(x)
    low = mantissa < 0.7071067811865476
    mantissa, exponent = np.where(low, 2 * mantissa, mantissa), exponent - low
    s: Doubles = (mantissa - 1) / (mantissa + 1)  # at most 0.172
    series = _polynomial(s * s, tuple(2.0 / k for k in range(23, 0, -2)))
    result: Doubles = exponent * 0.6931471805599453 + s * series
    return result


_A = (-39.69683028665376, 220.9460984245205, -275.9285104469687, 138.3577518672690, -30.66479806614716, 2.506628277459239)
_B = (-54.47609879822406, 161.5858368580409, -155.6989798598866, 66.80131188771972, -13.28068155288572)
_C = (-0.007784894002430293, -0.3223964580411365, -2.400758277161838, -2.549732539343734, 4.374664141464968, 2.938163982698783)
_D = (0.007784695709041462, 0.3224671290700398, 2.445134137142996, 3.754408661907416)
