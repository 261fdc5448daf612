"""Inside the boundary layer the slip error has an ultimate bound: abs(e) <= 2 Phi/K_P plus what decays."""

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.checks.sliding.reaching import search
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.theorems.sliding import BOUNDARY_LAYER

PLOT_TIMES = 121


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - the certificate says it all
    """Bound on the error over time since the entry."""
    import numpy as np

    ultimate, transient, rate = (each.value for each in certificate.worst_point)
    if rate <= 0.0:
        return Figures()
    times = np.linspace(0.0, 5.0 / rate, PLOT_TIMES)
    axes = ("time since the entry [s]", "slip error [-]")
    return Figures(
        series=(
            series("bound", *axes, times, ultimate + transient * np.exp(-rate * times)),
            level("2 Phi/K_P", *axes, times, ultimate),
        )
    )


CHECK = Check(theorem=BOUNDARY_LAYER, search=search, figures=figures)
