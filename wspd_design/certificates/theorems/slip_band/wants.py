"""What the law wants of the torque, with the pull k e and on its braking curve, and what of it it leaves out."""

from typing import NamedTuple, TypeAlias

from wspd_design.certificates.kernel.arb import Ball, ends_of, least_of, most_of, point
from wspd_design.certificates.setting.slip_loop import Pair, wanted
from wspd_design.certificates.theorems.slip_band.proof import Choice
from wspd_design.certificates.theorems.slip_band.pulses import loop_law
from wspd_design.certificates.theorems.slip_band.statement import BandLaw
from wspd_design.model.generated.slip_loop import share_left

Row: TypeAlias = tuple[Ball, ...]


class Wants(NamedTuple):
    """What the law wants of the torque, for a pull over k e."""

    row: Row
    beside: Pair  # rad/s, what it wants beside what the state asks for


class Curve(NamedTuple):
    """Braking curve of the law."""

    error: Ball  # rad/s, predicted one at which it begins
    times: Ball  # -, of that, that is predicted at most
    beside: Pair  # rad/s, of the predicted error beside that of the state

    @property
    def left(self) -> Ball:
        """Pull at the largest predicted error, over that at the beginning of the curve."""
        return (2 * self.times - 1).sqrt()

    def predicted(self, law: BandLaw) -> Row:
        """Return the row that gives the predicted error from the state."""
        ahead = point(law.ahead)
        return point(1), point(0), ahead, -ahead, ahead


def wants_of(law: BandLaw, curve: Curve | None, known: Ball, misread: Ball) -> tuple[Wants, ...]:
    """Return what the law wants for the pull k e, and for the least share of it that the braking curve leaves.

    Parameters
    ----------
    law : BandLaw
        Its numbers.
    curve : Curve, optional
        With the errors that are predicted on it.
    known : ball
        Error of the acceleration of the reference in the law, beside the lag of its filter, times h [rad/s].
    misread : ball
        Error of the error of the wheel speed in the law, that from which errors are counted among it [rad/s].
    """
    pulls = [point(1)]
    if curve is not None and curve.times > 1:
        pulls.append(share_left(curve.left, curve.times, 0))
    rows = [wanted(loop_law(law), pull) for pull in pulls]
    return tuple(Wants(row, ends_of(row[4] * known + row[0] * misread)) for row in rows)


def curve_of(law: BandLaw, choice: Choice, known: Ball, misread: Ball) -> Curve | None:
    """Return the braking curve of the law; the rest as :func:`wants_of`."""
    if law.torque_slew is None:
        return None
    begins = point(law.torque_slew) / point(law.inertia) / point(law.approach_rate) ** 2
    return Curve(begins, point(choice.curve), ends_of(misread + point(law.ahead) * known))


def dead_band_of(law: BandLaw, sliding: Ball) -> Ball:
    """Largest wanted change of the torque that the law leaves out [N m]."""
    narrowed = point(law.dead_band_share) * sliding * point(law.inertia) * point(law.approach_rate)
    shortest = -point(law.least_pulse) / point(min(law.fill_time, law.vent_time))
    return most_of([least_of([point(law.dead_band), narrowed]), -point(law.full_torque) * shortest.expm1()])
