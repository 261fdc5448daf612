"""Pulses of the valve that bring the braking torque to a wanted value, and the torque that they leave behind."""

from dataclasses import dataclass
from typing import NamedTuple

from wspd_design.controllers.protocol import Command
from wspd_design.model.brake import flow_rates
from wspd_design.model.generated import valve_inversion as generated
from wspd_design.model.number import Number, maximum, minimum, where
from wspd_design.parameters.records import Brake

_LEAST = 1e-3  # of the torque at full pressure: what a logarithm may be asked for


class ValveTimes(NamedTuple):
    """Time constants of filling and venting at a torque [s]."""

    fill: Number
    vent: Number


class Pulses(NamedTuple):
    """What a command makes of the torque within its sample."""

    torque: Number  # N m, at the end
    mean: Number  # N m


@dataclass(frozen=True, slots=True, kw_only=True)
class ValveInversion:
    """The valve of a wheelset as a law models it, and its inversion.

    ``time_share`` is the valve that the inversion assumes: 1 for the nominal one. A smaller share goes only a part of
    the way, but does not go beyond the wanted torque with a valve that is faster than the nominal one.
    """

    brake: Brake  # nominal
    sample_time: float  # s
    time_share: float  # -
    least_pulse: float  # s, shorter ones are left out

    def command(
        self, torque: Number, target: Number, available: Number, dead_band: Number, full_torque: Number
    ) -> Command:
        """Return the pulse that leads from a torque towards a target.

        Parameters
        ----------
        torque, target : number
            Braking torque of the wheelset as it is and as it is wanted [N m].
        available : number
            Torque of the pressure that the demand allows [N m]; no target is above it.
        dead_band : number
            Distance from the target within which the valve holds [N m].
        full_torque : number
            Torque of the wheelset at full pressure [N m].
        """
        least = _LEAST * full_torque + _LEAST
        target = minimum(maximum(target, 0.0), available)
        times = self.times(torque, full_torque)
        room, left = maximum(available - torque, least), maximum(available - target, least)
        from_torque, to_target = maximum(torque, least), maximum(target, least)
        filling = generated.fill_share(0.0, room - left, room, self.sample_time, times.fill)
        fill = self._share(filling, target - torque, dead_band)
        venting = generated.vent_share(from_torque, to_target, self.sample_time, times.vent)
        return Command(fill=fill, vent=self._share(venting, torque - target, dead_band))

    def _share(self, nominal: Number, way: Number, dead_band: Number) -> Number:
        """Share of the sample that is commanded: none within the dead band, and no pulse that is too short."""
        share = minimum(self.time_share * nominal, 1.0)
        long_enough = share * self.sample_time >= self.least_pulse
        return where(way > dead_band, where(long_enough, share, 0.0), 0.0)

    def after(self, command: Command, torque: Number, available: Number, full_torque: Number) -> Pulses:
        """Return what a command makes of a torque, by the nominal valve."""
        times = self.times(torque, full_torque)
        # A cylinder above the demand keeps its pressure while it fills.
        supply = maximum(available, torque)
        torque, mean = generated.torque_after(
            torque, supply, command.fill, command.vent, self.sample_time, times.fill, times.vent
        )
        return Pulses(torque, mean)

    def times(self, torque: Number, full_torque: Number) -> ValveTimes:
        """Time constants of the nominal valve; those of an orifice are the ones that it has at this torque."""
        brake = self.brake
        if brake.valve == "lag":
            return ValveTimes(brake.fill_time, brake.vent_time)
        share = minimum(maximum(torque / maximum(full_torque, _LEAST), _LEAST), 1.0 - _LEAST)
        pressure = share * brake.max_pressure
        filling, venting = flow_rates(brake, pressure)
        return ValveTimes((brake.max_pressure - pressure) / filling, pressure / venting)
