"""Several controllers on the same stop."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from wspd_design.controllers.offers import slip_reference_of
from wspd_design.controllers.protocol import Law
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.later import later
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.names import DEFAULT_PLANT
from wspd_design.simulation.metrics import Metrics, metrics
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Run
from wspd_design.simulation.self_check import StepCheck, simulate_checked
from wspd_design.simulation.taken import check_several, check_stop

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from wspd_design.parameters.table import Table


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Trial:
    """A stop, its figures and how far the integration can be trusted.

    Attributes
    ----------
    run : Run
    metrics : Metrics
    check : StepCheck
    slip_reference : float [-]
        That the slip figures are about, unless the law holds slips of its own.
    """

    run: Run
    metrics: Metrics
    check: StepCheck
    slip_reference: float

    def __repr__(self) -> str:
        """Say in one line what became of the stop."""
        return f"<Trial {self.run.controller} on {self.run.rail}: {self.metrics.brief}>"

    def _repr_html_(self) -> str:
        return str(later("notebook.stops", "trial_card")(self))

    def table(self) -> "Table":
        """Return the figures of the stop with their units."""
        table: Table = later("notebook.stops", "trial_table")(self)
        return table

    def plot(self, what: str = "slip", *, ax: "Axes | None" = None) -> "Axes":  # noqa: D102 - that of a run
        axes: Axes = later("plotting.stops", "plot_trial")(self, what, ax=ax)
        return axes

    plot.__doc__ = Run.plot.__doc__


class Comparison(tuple[Trial, ...]):
    """The same stop with several laws: a tuple of trials that shows itself as a table."""

    __slots__ = ()

    def __repr__(self) -> str:
        """Name the laws with their distances."""
        said = ", ".join(f"{each.run.controller} {each.metrics.distance:.1f} m" for each in self)
        return f"<Comparison of {len(self)} stops: {said}>"

    def _repr_html_(self) -> str:
        return str(later("notebook.stops", "comparison_card")(self))

    def table(self) -> "Table":
        """Return a row for each stop: distance, efficiency, slip, locks, air."""
        table: Table = later("notebook.stops", "comparison_table")(self)
        return table

    def to_pandas(self) -> Any:
        """Return a row for each stop with all figures as a ``pandas.DataFrame``; needs the extra ``frames``."""
        return later("notebook.frames", "frame_of_trials")(self)

    def plot(self, what: str = "slip", *, wheelset: int = 1, ax: "Axes | None" = None) -> "Axes":
        """Plot the distances, or a trace of one wheelset, of every law.

        Parameters
        ----------
        what : {"distance", "slip", "speed", "torque", "pressure", "load"}
            The stopping distances as bars, or a trace over time.
        wheelset : int
            Whose trace, from 1 at the front.
        ax : Axes, optional
            Where to draw; new axes by default.

        Returns
        -------
        Axes
            With units at its axes; nothing is shown or saved.

        Raises
        ------
        UserError
            If there is no such trace or wheelset.
        """
        axes: Axes = later("plotting.stops", "plot_comparison")(self, what, wheelset=wheelset, ax=ax)
        return axes


def trial(
    vehicle: Vehicle,
    controller: Law,
    scenario: Scenario,
    *,
    slip_reference: float | None = None,
    plant: str = DEFAULT_PLANT,
) -> Trial:
    """Simulate one stop, check its steps and judge it; parameters as of :func:`compare`."""
    check_stop(vehicle, controller, scenario, plant, by="trial")
    if slip_reference is None:
        slip_reference = _first_held([controller])
    run, check = simulate_checked(vehicle, controller, scenario, plant=plant)
    figures = metrics(run, vehicle, scenario, slip_reference=slip_reference)
    return Trial(run=run, metrics=figures, check=check, slip_reference=slip_reference)


def compare(
    vehicle: Vehicle,
    controllers: Sequence[Law],
    scenario: Scenario,
    *,
    slip_reference: float | None = None,
    plant: str = DEFAULT_PLANT,
    progress: Callable[[str], object] = str,
) -> Comparison:
    """Simulate the same stop with each controller.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    controllers : sequence of Law
        Laws to compare.
    scenario : Scenario
        Rail and initial speed.
    slip_reference : float, optional
        Reference of ``slip_rms`` for the laws that hold none of their own [-]; by default that of the first law that
        holds one.
    plant : {"planar", "quarter", "locomotive", "locomotive-linear"}
        With load transfer, without, or with all degrees of freedom.
    progress : callable, optional
        Told the name of each controller before its stop.

    Returns
    -------
    Comparison
        A tuple of trials in the order of the controllers.
    """
    check_several(controllers, by="compare")
    if slip_reference is None:
        slip_reference = _first_held(controllers)
    trials = []
    for controller in controllers:
        progress(controller.name)
        held = slip_reference_of(controller)
        reference = slip_reference if held is None else held
        trials.append(trial(vehicle, controller, scenario, slip_reference=reference, plant=plant))
    return Comparison(trials)


def _first_held(controllers: Sequence[Law]) -> float:
    """Return the slip of the first law that holds one [-]."""
    for controller in controllers:
        held = slip_reference_of(controller)
        if held is not None:
            return held
    raise UserError(
        "no law here holds a slip of its own, so that nothing says what the slip is judged about; give "
        "slip_reference=0.14 for example"
    )
