"""The same design where something fails or the rail changes: one sensor lost, one valve stuck, patches of leaves."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from wspd_design.controllers.protocol import Law
from wspd_design.design.stop_requirements import LONGEST_LOCK
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.gear import static_shares
from wspd_design.parameters.loading import load_rail, load_rail_profile
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.quarter import Quarter
from wspd_design.simulation.locked import locked
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.peak import peak_adhesion
from wspd_design.simulation.records import FAULT_KINDS, Fault, Patch, Scenario
from wspd_design.simulation.runs import Ending, Run
from wspd_design.simulation.stop import simulate

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

SINCE = 3.0  # s, after the brake was applied: it is built up, and the wheels slide where they will

PATCHES = "patchy"
_STUCK_FULL = "valve-fills"


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultedStop:
    """A stop in which something is not as it was designed for."""

    fault: Fault | None  # None for a stop on patches
    stopped: bool
    distance: float  # m
    locks: tuple[float, ...]  # s, longest of each wheelset above the judging speed
    run: Run | None = field(default=None, repr=False)  # for its traces

    @property
    def own_lock(self) -> float:
        """Longest lock of the wheelset with the fault [s]; 0 where none has one."""
        return 0.0 if self.fault is None else self.locks[self.fault.axle - 1]

    @property
    def other_lock(self) -> float:
        """Longest lock of the wheelsets without a fault [s]."""
        own = 0 if self.fault is None else self.fault.axle
        return max(lock for axle, lock in enumerate(self.locks, start=1) if axle != own)


@dataclass(frozen=True, slots=True, kw_only=True)
class Robustness:
    """What becomes of a design where something fails, each fault at the axle where it does most harm."""

    plain: float  # m, distance of the same stop without a fault
    faults: tuple[FaultedStop, ...]
    patches: FaultedStop | None  # on PATCHES; None where the stop has changes of rail of its own
    full_torque: float  # N m, of a filled brake, largest of the wheelsets
    most_adhesion: tuple[float, float]  # N m, that the rail can take from a wheelset, over the judged speeds

    @property
    def stops(self) -> tuple[FaultedStop, ...]:
        """All of them."""
        return (*self.faults, *((self.patches,) if self.patches else ()))

    @property
    def fills_lock(self) -> bool:
        """Whether a filled brake locks its wheels on this rail at some judged speed, whatever a law does."""
        return self.full_torque > self.most_adhesion[0]

    def forced(self, stop: FaultedStop) -> bool:
        """Tell whether no law could keep the wheelset with the fault from locking."""
        return stop.fault is not None and stop.fault.kind == _STUCK_FULL and self.fills_lock

    def holds(self, stop: FaultedStop) -> bool:
        """Tell whether the train stops and no wheel that a law could keep turning is locked for too long."""
        own = 0.0 if self.forced(stop) else stop.own_lock
        return stop.stopped and max(own, stop.other_lock) <= LONGEST_LOCK


def robustness(
    vehicle: Vehicle,
    law: Law,
    scenario: Scenario,
    *,
    plant: str,
    progress: Callable[[str], None] = lambda _stage: None,
) -> Robustness | None:
    """Stop with each fault at each axle that has a friction brake, and on patches.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    law : Law
        As it was designed; nothing of it is changed.
    scenario : Scenario
        The stop without these faults.
    plant : {"planar", "quarter", "locomotive", "locomotive-linear"}
        Faults belong to single axles, which the quarter plant does not have.
    progress : callable, optional
        Told each kind of fault before its stops.

    Returns
    -------
    Robustness or None
        None for a plant on which one wheelset stands for all, or a vehicle with one.
    """
    if plant == Quarter.name or vehicle.wheelsets == 1:
        return None
    plain = replace(scenario, faults=())

    def stop(with_what: Scenario, fault: Fault | None = None) -> FaultedStop:
        run = simulate(vehicle, law, with_what, plant=plant)
        return FaultedStop(
            fault=fault,
            stopped=run.ending is Ending.STOPPED,
            distance=run.totals.distance,
            locks=longest_locks(run),
            run=run,
        )

    found = []
    for kind in FAULT_KINDS:
        progress(f"faults: {kind}")
        faults = [
            Fault(axle=axle, kind=kind, since=SINCE)
            for axle, share in enumerate(vehicle.brake_shares, start=1)
            if share > 0.0
        ]
        found.append(_worst([stop(replace(plain, faults=(fault,)), fault) for fault in faults]))
    changes = bool(plain.patches or plain.axle_rails)
    return Robustness(
        plain=stop(plain).distance,
        faults=tuple(found),
        patches=None if changes else stop(_on_patches(plain)),
        full_torque=vehicle.brake.max_torque * max(vehicle.brake_shares),
        most_adhesion=_most_adhesion(vehicle, plain),
    )


def longest_locks(run: Run) -> tuple[float, ...]:
    """Longest time above the judging speed for which each wheelset is locked, to the interval of the traces [s]."""
    import numpy as np

    judged = run.speed > JUDGING_SPEED
    return tuple(_longest(run.time, np.asarray(judged & column)) for column in locked(run).T)


def _longest(time: "NDArray[np.float64]", flags: "NDArray[np.bool_]") -> float:
    import numpy as np

    edges = np.flatnonzero(np.diff(flags.astype(int), prepend=0, append=0))
    return max((float(time[end - 1] - time[begin]) for begin, end in edges.reshape(-1, 2)), default=0.0)


def _worst(stops: Sequence[FaultedStop]) -> FaultedStop:
    """Return the stop that does not end, or with the longest lock of a wheelset that obeys, or the longest way."""
    return max(stops, key=lambda each: (not each.stopped, each.other_lock > LONGEST_LOCK, each.distance))


def _on_patches(plain: Scenario) -> Scenario:
    profile = load_rail_profile(PATCHES)
    first, *rest = map(load_rail, profile.rails)
    patches = tuple(
        Patch(start=start, rail=rail) for start, rail in zip(profile.starts[1:], rest, strict=True)
    )
    return replace(plain, rail=first, patches=patches)


def _most_adhesion(vehicle: Vehicle, stop: Scenario) -> tuple[float, float]:
    """Range over the judged speeds of the torque that the rail takes from a wheelset at its adhesion peak [N m]."""
    import numpy as np

    speeds = np.linspace(min(JUDGING_SPEED, 0.5 * stop.initial_speed), stop.initial_speed, 50)
    load = max(static_shares(vehicle))
    rails = (stop.rail, *(stop.axle_rails or ()), *(patch.rail for patch in stop.patches))
    torques = [
        2.0 * vehicle.wheel_radius * load * float(static_wheel_load(vehicle)) * peak
        for rail in dict.fromkeys(rails)
        for peak in peak_adhesion(vehicle, rail, speeds, load_share=load)[1].tolist()
    ]
    return min(torques), max(torques)
