"""Claims on track irregularity and on the results, eq. (49), Tables 9 and 10."""

import sympy as sp

from derivations import baselines, torque_balance, track
from derivations.claim import Claim
from derivations.printing import Form, form
from derivations.unit_check import check

_TRACK = "test_equations_track.py"
_BALANCE = "test_equations_torque_balance.py"
_wrong = track.disagreements()
_beta2 = track.DERIVED["Lateral"]["beta2"]
_spread, _spread_time = (float(100 * torque_balance.spread(column)) for column in (1, 0))
_inertias = torque_balance.wheelset_inertias().values()

_CROSS_LEVEL = ("beta2", "gamma0", "gamma2", "gamma4")
_cross = check(
    (sp.Symbol("cross_level_density"), track.cross_spectrum),
    _CROSS_LEVEL,
    keep_angles=True,
).solved

CLAIMS = (
    Claim(
        number="49",
        title="Spectrum of the track irregularity",
        derivation=track,
        functions=("track.irregularity_spectrum",),
        test=f"{_TRACK}::test_expansion_of_the_published_spectra",
        printed=form("spectral_density", track.spectrum),
        residual=sum(sp.Abs(residual) for residual in track.expansion_residual),
        domain="wavelengths 3 to 25 m",
        sides=(
            sp.Symbol("spectral_density"),
            track.spectrum,
            track.spectrum.subs(track.g4, 1),
        ),
        unknown=("beta0", "beta2", "gamma0", "gamma2", "gamma4", "gamma6"),
        keep_angles=True,
        remark="The form of the ERRI B176 spectra; one-sided in the wavenumber. Units for gamma4 = 1, the rows of "
        f"displacements; in the cross-level row, gamma6 = 1 and S in m/rad, beta2 is in {_cross['beta2']}, "
        f"gamma0 in {_cross['gamma0']}, gamma2 in {_cross['gamma2']}, gamma4 in {_cross['gamma4']}.",
    ),
    Claim(
        number="Table 9",
        title="Coefficients of the spectra",
        derivation=track,
        test=f"{_TRACK}::test_table_9",
        printed=Form("β2 = 0.305533e-6 (lateral row)"),
        corrected=Form(f"β2 = {float(_beta2) * 1e6:.6f}e-6 (cross-level row)"),
        residual=sum(_wrong.values(), sp.Integer(0)).evalf(6),
        certainty=("inferred", "scan"),
        domain="ERRI B176, level high",
        sides=(sp.Symbol("cross_level_density"), track.cross_spectrum),
        unknown=_CROSS_LEVEL,
        keep_angles=True,
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
        gap=torque_balance.torque_integral_derived,
        corrected_residual=torque_balance.identity_residual,
        certainty=("proved",),
        assumption="None would do: the integral is the initial momentum less what resistance and "
        "damping took.",
        domain="from v0 to standstill; no wheel is locked",
        sides=(torque_balance.torque_symbol, torque_balance.torque_integral),
        remark=f"The eight integrals spread by {_spread:.2f} %, the stopping times by "
        f"{_spread_time:.0f} %. They "
        f"imply {min(_inertias):.0f} to {max(_inertias):.0f} kg m2 per wheelset (no running resistance). A locked "
        "wheel breaks the identity: the brake then holds with less than T.",
    ),
    Claim(
        number="T_d",
        title="Disturbing torque of the pads (Section 7)",
        derivation=baselines,
        test="test_equations_baselines.py::test_disturbing_torque",
        printed=form("disturbing_torque", baselines.disturbing_torque_printed),
        domain="t >= 0 since the brake was applied",
        sides=(sp.Symbol("disturbing_torque"), baselines.disturbing_torque),
        remark="4 is in 1/s, 10 pi in rad/s: 5 Hz. It is added to the braking torque of (2).",
    ),
)
