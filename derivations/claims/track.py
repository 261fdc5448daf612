"""Claims on track irregularity and on the results, eq. (49), Tables 9 and 10."""

import sympy as sp

from derivations import torque_balance, track
from derivations.equation_map import Claim
from derivations.printing import Form, form

_TRACK = "test_equations_track.py"
_BALANCE = "test_equations_torque_balance.py"
_wrong = track.disagreements()
_beta2 = track.DERIVED["Lateral"]["beta2"]
_spread, _spread_time = (float(100 * torque_balance.spread(column)) for column in (1, 0))
_inertias = torque_balance.wheelset_inertias().values()

CLAIMS = (
    Claim(
        number="49",
        title="Spectrum of the track irregularity",
        derivation=track,
        functions=("track.irregularity_spectrum",),
        test=f"{_TRACK}::test_expansion_of_the_published_spectra",
        printed=form("spectral_density", track.spectrum),
        residual=sum(sp.Abs(residual) for residual in track.expansion_residual),
        remark="The form of the ERRI B176 spectra; one-sided in the wavenumber.",
    ),
    Claim(
        number="Table 9",
        title="Coefficients of the spectra",
        derivation=track,
        test=f"{_TRACK}::test_table_9",
        printed=Form("β2 = 0.305533e-6 (lateral row)"),
        corrected=Form(f"β2 = {float(_beta2) * 1e6:.6f}e-6 (cross-level row)"),
        residual=sum(_wrong.values(), sp.Integer(0)).evalf(6),
        corrected_residual=sp.Integer(len(_wrong.keys() - {("Lateral", "beta2")})),
        remark="ERRI B176, level high. As read in the text at hand; every other legible digit is reproduced. "
        "The third row is the cross-level spectrum.",
    ),
    Claim(
        number="Table 10",
        title="Torque integral as a measure of air consumption",
        derivation=torque_balance,
        test=f"{_BALANCE}::test_identity_on_a_simulated_stop",
        printed=Form("Σ∫T dt measures the air consumption"),
        corrected=form("torque_integral", torque_balance.torque_integral),
        residual=torque_balance.torque_integral_derived,
        corrected_residual=torque_balance.identity_residual,
        assumption="None would do: the integral is the initial momentum less what resistance and "
        "damping took.",
        remark=f"The eight integrals spread by {_spread:.2f} %, the stopping times by "
        f"{_spread_time:.0f} %. They "
        f"imply {min(_inertias):.0f} to {max(_inertias):.0f} kg m2 per wheelset (no running resistance).",
    ),
)
