"""What the valves of a wheelset make of a command: pulses that are too short do not open them."""

from wspd_design.controllers.protocol import Command

_WHOLE = 1e-12  # share of the sample time that is nothing
_SHORTEST = 1e-9  # s: times closer together than this are one
CLOSED = Command(fill=0.0, vent=0.0)
"""What the valves follow before the first command."""


def followed(command: Command, before: Command, *, sample_time: float, shortest_pulse: float) -> Command:
    """Return the command without the pulses that are shorter than the shortest one.

    Parameters
    ----------
    command : Command
        Shares of the sample time, as commanded.
    before : Command
        What the valves followed in the sample time before: a pulse that goes on needs no length of its own.
    sample_time : float
        Of the controller [s].
    shortest_pulse : float
        Least duration of a pulse that opens a valve [s].

    Returns
    -------
    Command
        Shares of the sample time, as followed.
    """
    least = shortest_pulse - _SHORTEST
    filling = 1.0 - before.fill < _WHOLE
    venting = not filling and 1.0 - before.fill - before.vent < _WHOLE
    fill = 0.0 if command.fill * sample_time < least and not filling else command.fill
    short = command.vent * sample_time < least and not (venting and fill == 0.0)
    return Command(fill=fill, vent=0.0 if short else command.vent)
