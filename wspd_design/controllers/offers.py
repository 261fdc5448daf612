"""What a law may offer beyond :class:`Controller`, each found by its attributes: nothing has to be registered.

Certificates, metrics and figures ask for an offer (``isinstance(law, Surface)``), never for a class of laws. An offer
is a statement of the law about itself; whether ``step`` keeps it is decided by
:mod:`wspd_design.certificates.setting.traced_law`.
"""

from collections.abc import Mapping
from typing import NamedTuple, Protocol, runtime_checkable

from wspd_design.controllers.protocol import Controller, Law
from wspd_design.model.number import Number
from wspd_design.parameters.records import Rail, Vehicle


class SlipModel(NamedTuple):
    """Eq. (19) near a point: e' = p e - G (T - T0) for the slip error e."""

    pole: Number  # 1/s, p
    gain: Number  # 1/(N m s), G


class Feedback(NamedTuple):
    """Gains of a law near its reference: u = u0 + P e + I (integral of e) + J (twice integrated) - K (T - T0)."""

    proportional: Number  # N m per slip, P
    integral: Number  # N m/s per slip, I
    torque: Number  # -, K
    twice: Number = 0.0  # N m/s2 per slip, J: of a law that adapts to its error


@runtime_checkable
class SlipReference(Protocol):
    """A law that holds a slip."""

    @property
    def slip_reference(self) -> float:
        """Slip that the law holds [-]."""


@runtime_checkable
class Memory(Protocol):
    """A law that names what it remembers."""

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of the elements of its state, in their order."""


@runtime_checkable
class Surface(SlipReference, Controller, Protocol):
    """A law with a sliding surface in the slip: e + c (integral of e) = 0.

    The integral of the slip error is the first element of its state.
    """

    @property
    def surface_gains(self) -> tuple[float, float]:
        """K_I [1/s] and K_P [-], which is 1 where the surface is stated by its rate."""

    @property
    def surface_rate(self) -> float:
        """Rate c = K_I / K_P of the error on the surface [1/s]."""

    @property
    def layer(self) -> float:
        """Width Phi / K_P of the boundary layer, in slip [-]."""

    @property
    def max_torque(self) -> float:
        """Torque that a duty of one stands for [N m]."""


@runtime_checkable
class Linear(SlipReference, Controller, Protocol):
    """A law that is linear near its reference as long as nothing saturates."""

    @property
    def wheel_radius(self) -> float:
        """Radius from which the law works out its slip [m]."""

    @property
    def max_torque(self) -> float:
        """Torque that a duty of one stands for [N m]."""

    @property
    def linear_model(self) -> tuple[Vehicle, Rail] | None:
        """Design model whose pole and gain the linear form contains, None if it contains none."""

    def linear_numbers(self, zero: Number) -> Mapping[str, Number]:
        """Work out the numbers of the linear form that no speed changes.

        Parameters
        ----------
        zero : number
            0 in the arithmetic of the result: a float, a ball or an interval.

        Returns
        -------
        mapping
            Numbers by name; empty if there are none.
        """

    def linear_form(
        self, speed: Number, *, model: SlipModel | None = None, numbers: Mapping[str, Number] | None = None
    ) -> Feedback:
        """Return the gains at the reference and a train speed.

        Parameters
        ----------
        speed : number
            Of the train [m/s].
        model : SlipModel, optional
            Of ``linear_model`` at the reference; worked out from the kernels by default.
        numbers : mapping, optional
            Those of :meth:`linear_numbers`; worked out by default.
        """


@runtime_checkable
class LinearSurface(Surface, Linear, Protocol):
    """A law with a sliding surface that is linear near its reference."""


def slip_reference_of(law: Law) -> float | None:
    """Slip that a law holds, None if it does not say [-].

    A law of a user may say it by the attribute ``slip``, the name under which it can ask for the option.
    """
    for name in ("slip_reference", "slip"):
        held = getattr(law, name, None)
        if isinstance(held, int | float) and not isinstance(held, bool) and 0.0 < held < 1.0:
            return float(held)
    return None
