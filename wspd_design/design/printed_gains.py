"""The gains that Section 7 of the paper prints for its adaptive fuzzy sliding-mode controller."""

from wspd_design.design.records import Gain
from wspd_design.parameters.loading import load_entries, load_paper_gains

_AS_PRINTED = (
    ("dead_zone", "eqs. (41), (42) adapt with s itself"),
    ("hold_when_saturated", "the paper adapts at all times"),
    ("scheduled_rates", "the rates of eqs. (41), (42) are constant"),
)


def printed_gains() -> tuple[Gain, ...]:
    """Return the printed gains, each with its place in the paper."""
    printed = load_paper_gains()
    numbers = tuple(
        Gain(
            name=name,
            value=getattr(printed, name),
            unit="N m" if name == "torque_unit" else entry.unit,
            why=f"{entry.status}: {entry.at}",
        )
        for name, entry in load_entries("controller", "afsmc").entries.items()
    )
    return numbers + tuple(
        Gain(name=name, value=False, unit="-", why=f"printed: {text}") for name, text in _AS_PRINTED
    )
