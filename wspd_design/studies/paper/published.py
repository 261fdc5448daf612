"""Stops that the paper publishes, to stand beside our own."""

from dataclasses import dataclass

from wspd_design.parameters.files import data_file, read_toml


@dataclass(frozen=True, slots=True, kw_only=True)
class PublishedStop:
    """One row of Table 10 of the paper, on one rail."""

    controller: str
    rail: str
    distance_m: float
    stopping_time_s: float
    torque_integral_kNms: float  # sum over the wheelsets

    def lag(self, initial_speed: float) -> float:
        """Dead time that with a constant deceleration gives distance and time, 2 d / v0 - t [s]."""
        return 2.0 * self.distance_m / initial_speed - self.stopping_time_s

    def plateau(self, initial_speed: float) -> float:
        """Deceleration that with a dead time gives distance and time [m/s2]."""
        return initial_speed / (2.0 * (self.stopping_time_s - self.distance_m / initial_speed))


@dataclass(frozen=True, slots=True, kw_only=True)
class PublishedStops:
    """Table 10 of the paper."""

    initial_speed_kmh: float
    stops: tuple[PublishedStop, ...]

    def on(self, rail: str) -> dict[str, PublishedStop]:
        """Return the stops on a rail by the name of their controller."""
        return {stop.controller: stop for stop in self.stops if stop.rail == rail}


def load_table10() -> PublishedStops:
    """Return the stopping distances, times and torque integrals of Table 10."""
    document = read_toml(data_file("table10.toml"), "table10.toml")
    return PublishedStops(
        initial_speed_kmh=float(document["initial_speed_kmh"]),
        stops=tuple(PublishedStop(**row) for row in document["stop"]),
    )
