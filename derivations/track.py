"""Track irregularity, eq. (49) and Table 9: the expansion of the ERRI B176 spectra, level "high".

Claims: expanding the spectra with their constants reproduces every printed digit, except beta_2 of the
third row (0.305533 in the text at hand, 1.305533 computed); that row is the cross-level spectrum, not a
lateral one.
"""

import sympy as sp

from derivations.notation import Generated, symbol, symbols

W, b0, b2, g0, g2, g4, g6 = symbols("wavenumber beta0 beta2 gamma0 gamma2 gamma4 gamma6")
spectrum = (b0 + b2 * W**2) / (g0 + g2 * W**2 + g4 * W**4 + g6 * W**6)

cross_spectrum = b2 * W**2 / (g0 + g2 * W**2 + g4 * W**4 + W**6)  # the third row

# --- ERRI B176, level "high": wavenumbers in rad/m, amplitudes in m2 rad/m --------------------------------
W_c, W_r, W_s = sp.Rational("0.8246"), sp.Rational("0.0206"), sp.Rational("0.4380")
half_gauge = sp.Rational("0.75")  # m, half distance of the running circles
amplitude = {"Horizontal": sp.Rational("6.125e-7"), "Vertical": sp.Rational("1.080e-6")}

displacement = {row: A * W_c**2 / ((W**2 + W_r**2) * (W**2 + W_c**2)) for row, A in amplitude.items()}
cross_level = (
    amplitude["Vertical"]
    / half_gauge**2
    * (W_c**2 * W**2)
    / ((W**2 + W_r**2) * (W**2 + W_c**2) * (W**2 + W_s**2))
)
ROWS = {**displacement, "Lateral": cross_level}


def coefficients(density: sp.Expr) -> dict[str, sp.Rational]:
    """Expand a spectrum into the coefficients of (49), the highest one of the denominator being 1."""
    numerator, denominator = (sp.Poly(part, W) for part in sp.fraction(sp.cancel(density)))
    scale = denominator.LC()
    named = {f"beta{n}": numerator.coeff_monomial(W**n) / scale for n in (0, 2)}
    return named | {f"gamma{n}": denominator.coeff_monomial(W**n) / scale for n in (0, 2, 4, 6)}


DERIVED = {row: coefficients(density) for row, density in ROWS.items()}
expansion_residual = tuple(
    sp.simplify(spectrum.subs({symbol(name): value for name, value in DERIVED[row].items()}) - density)
    for row, density in ROWS.items()
)

# --- Table 9 as printed -----------------------------------------------------------------------------------
# Digits and power of ten of the column. Cells that the text at hand has lost are left out.
PRINTED = {
    "Horizontal": {"beta0": ("4.164787", -7), "gamma0": ("2.8855", -4), "gamma2": ("0.68038", 0)},
    "Vertical": {"beta0": ("7.343623", -7), "gamma0": ("2.8855", -4), "gamma2": ("0.68038", 0)},
    "Lateral": {
        "beta2": ("0.305533", -6),
        "gamma0": ("0.55356", -4),
        "gamma2": ("0.13081", 0),
        "gamma4": ("0.8722335", 0),
    },
}


def disagreements() -> dict[tuple[str, str], sp.Rational]:
    """Printed minus derived, where they differ by more than one unit of the last printed digit."""
    found = {}
    for row, cells in PRINTED.items():
        for name, (digits, power) in cells.items():
            last_digit = sp.Rational(10) ** (power - len(digits.partition(".")[2]))
            difference = sp.Rational(digits) * sp.Rational(10) ** power - DERIVED[row][name]
            if abs(difference) > last_digit:
                found[row, name] = difference
    return found


FUNCTIONS = (
    Generated(
        name="irregularity_spectrum",
        arguments=(W, b0, b2, g0, g2, g4, g6),
        value=spectrum,
        summary="Power spectral density of the track irregularity, one-sided in the wavenumber",
        returns="Power spectral density [m2/(rad/m); rad2/(rad/m) for the cross level]",
        equation="49",
    ),
)
