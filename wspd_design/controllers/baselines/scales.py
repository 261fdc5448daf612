"""Scale factors of the tables of the industry: the few numbers by which a table is tuned without losing its form."""

from dataclasses import dataclass, replace

from wspd_design.parameters.records import KnorrBremseTable, MitsubishiTable, TrenitaliaTable


@dataclass(frozen=True, slots=True, kw_only=True)
class KnorrBremseScales:
    """Factors on the table of Knorr-Bremse."""

    slide_limits: float = 1.0  # on slopes, offsets and caps of the slide regions
    acceleration_limits: float = 1.0
    pulses: float = 1.0  # each pulse at most a whole sample


@dataclass(frozen=True, slots=True, kw_only=True)
class TrenitaliaScales:
    """Factors on the table of Trenitalia."""

    slip_limits: float = 1.0  # on 1 - V_min/v and 1 - V_max/v
    acceleration_limits: float = 1.0  # on ACC and DEC
    fill_pulse: float = 1.0  # at most a whole sample
    vent_pulse: float = 1.0  # likewise


@dataclass(frozen=True, slots=True, kw_only=True)
class MitsubishiScales:
    """Factors on the table of Mitsubishi, and a shift."""

    slide_centres: float = 1.0
    rate_centres: float = 1.0
    duty_gain: float = 1.0
    duty_shift: float = 0.0  # is added to the offset of the duty


def scaled_knorr_bremse(table: KnorrBremseTable, scales: KnorrBremseScales) -> KnorrBremseTable:
    """Return the table of Knorr-Bremse with its factors."""
    return replace(
        table,
        slide_slopes=_times(scales.slide_limits, table.slide_slopes),
        slide_offsets=_times(scales.slide_limits, table.slide_offsets),
        slide_caps=_times(scales.slide_limits, table.slide_caps),
        acceleration_limits=_times(scales.acceleration_limits, table.acceleration_limits),
        pulses=tuple(min(share, 1.0) for share in _times(scales.pulses, table.pulses)),
    )


def scaled_trenitalia(table: TrenitaliaTable, scales: TrenitaliaScales) -> TrenitaliaTable:
    """Return the table of Trenitalia with its factors."""
    return replace(
        table,
        lower_speed_ratio=1.0 - scales.slip_limits * (1.0 - table.lower_speed_ratio),
        upper_speed_ratio=1.0 - scales.slip_limits * (1.0 - table.upper_speed_ratio),
        acceleration_limit=scales.acceleration_limits * table.acceleration_limit,
        deceleration_limit=scales.acceleration_limits * table.deceleration_limit,
        fill_pulse=min(scales.fill_pulse * table.fill_pulse, 1.0),
        vent_pulse=min(scales.vent_pulse * table.vent_pulse, 1.0),
    )


def scaled_mitsubishi(table: MitsubishiTable, scales: MitsubishiScales) -> MitsubishiTable:
    """Return the table of Mitsubishi with its factors."""
    return replace(
        table,
        slide_centres=_times(scales.slide_centres, table.slide_centres),
        rate_centres=_times(scales.rate_centres, table.rate_centres),
        duty_gain=scales.duty_gain * table.duty_gain,
        duty_offset=table.duty_offset + scales.duty_shift,
    )


def _times(factor: float, values: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(factor * value for value in values)
