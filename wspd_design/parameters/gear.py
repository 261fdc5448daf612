"""What a vehicle stands on: supports at equal distances, bogies or single axles, and how bodies rest and pitch on them.

Supports and axles are numbered from the front. One body rests on all supports; a train of n bodies rests on n + 1
supports, the inner ones shared by neighbouring bodies. Where more than two supports carry one body, or more than two
axles one bogie, their springs are alike, so that a pitch moment loads each in proportion to its distance from the
middle; on two the moments alone decide.
"""

from dataclasses import dataclass
from fractions import Fraction

from wspd_design.parameters.records import Vehicle

AXLES_OF_A_BOGIE = (1, 2, 3)

_MASS_TOLERANCE = 1e-3  # body and bogies are often rounded to whole kilograms or to 0.1 t


@dataclass(frozen=True, slots=True)
class Gear:
    """The running gear of a vehicle, in counts and shares."""

    axles: int  # of one support
    supports: int
    bodies: int

    @property
    def resting(self) -> tuple[Fraction, ...]:
        """Bodies that rest on each support; their sum is the number of bodies."""
        if self.bodies == 1:
            return (Fraction(1, self.supports),) * self.supports
        return (Fraction(1, 2), *(Fraction(1),) * (self.supports - 2), Fraction(1, 2))

    @property
    def body_shares(self) -> tuple[Fraction, ...]:
        """Load of each support from the pitch moment of a body, over moment by spacing.

        Bodies that are slowed down alike pitch alike: what one takes from a shared support, the next one gives it.
        """
        if self.bodies == 1:
            return _linear(self.supports)
        return (Fraction(1), *(Fraction(0),) * (self.supports - 2), Fraction(-1))

    @property
    def axle_shares(self) -> tuple[int, ...]:
        """Load of each axle of a bogie from its pitch moment, over moment by wheelbase, first to last axle."""
        return tuple(int((self.axles - 1) * share) for share in _linear(self.axles))


def gear_of(vehicle: Vehicle) -> Gear:
    """Return the running gear of a vehicle without contradictions."""
    axles = vehicle.axles_per_bogie
    return Gear(axles=axles, supports=vehicle.wheelsets // axles, bodies=vehicle.bodies)


def static_shares(vehicle: Vehicle) -> tuple[float, ...]:
    """Static load of each axle over the mean of all: shared supports carry more of the bodies."""
    gear = gear_of(vehicle)
    beyond = [float(resting * gear.supports - gear.bodies) for resting in gear.resting]
    by_support = [1.0 + more * (vehicle.body_mass / vehicle.mass) if more else 1.0 for more in beyond]
    return tuple(share for share in by_support for _ in range(gear.axles))


def contradiction(vehicle: Vehicle) -> str:
    """Say what contradicts itself in the running gear of a vehicle and what to change, or nothing."""
    return wrong_counts(vehicle) or _wrong_numbers(vehicle)


def masses_contradict(vehicle: Vehicle) -> str:
    """Say that bodies and bogies do not weigh what the vehicle does, or nothing."""
    gear = gear_of(vehicle)
    parts = gear.bodies * vehicle.body_mass + gear.supports * vehicle.bogie_mass
    if abs(parts - vehicle.mass) <= _MASS_TOLERANCE * vehicle.mass:
        return ""
    bodies = "body_mass" if gear.bodies == 1 else f"{gear.bodies} body_mass"
    return (
        f"mass = {vehicle.mass:g} kg in vehicle {vehicle.name} must equal {bodies} + {gear.supports} bogie_mass "
        f"= {parts:g} kg"
    )


def wrong_counts(vehicle: Vehicle) -> str:
    """Say why supports and bodies cannot be so many, or nothing."""
    axles, wheelsets, bodies = vehicle.axles_per_bogie, vehicle.wheelsets, vehicle.bodies
    if axles not in AXLES_OF_A_BOGIE:
        return f"axles_per_bogie = {axles} must be 1 (single axles), 2 or 3"
    if wheelsets % axles:
        return f"wheelsets = {wheelsets} must be a multiple of axles_per_bogie = {axles}"
    supports = wheelsets // axles
    what = "single axles" if axles == 1 else "bogies"
    if bodies > 1 and supports != bodies + 1:
        return (
            f"bodies = {bodies} of an articulated train must stand on {bodies + 1} {what}, the inner ones shared; "
            f"wheelsets = {wheelsets} and axles_per_bogie = {axles} make {supports}"
        )
    if bodies == 1 and supports == 1 and axles > 1:
        return (
            f"wheelsets = {wheelsets} and axles_per_bogie = {axles} make one bogie, on which no body stands; "
            "write axles_per_bogie = 1 where single axles carry the body"
        )
    return ""


def _wrong_numbers(vehicle: Vehicle) -> str:
    axles, wheelsets = vehicle.axles_per_bogie, vehicle.wheelsets
    if axles > 1 and not 0.0 < vehicle.wheelbase < vehicle.bogie_spacing:
        return (
            f"wheelbase = {vehicle.wheelbase:g} m of a bogie must be above 0 and below "
            f"bogie_spacing = {vehicle.bogie_spacing:g} m"
        )
    if axles > 1 and not vehicle.bogie_pitch_frequency > 0.0:
        return "bogie_pitch_frequency is missing; bogies have one"
    shares = vehicle.brake.axle_shares
    if shares and len(shares) != wheelsets:
        return f"brake.axle_shares has {len(shares)} numbers; write one for each of the {wheelsets} wheelsets"
    if shares and not any(shares):
        return "brake.axle_shares leaves no axle with a brake; write a number above 0 for one at least"
    return ""


def _linear(number: int) -> tuple[Fraction, ...]:
    """Loads of supports at equal distances from a moment, over moment by distance; none on a single one."""
    places = [Fraction(number - 1, 2) - each for each in range(number)]
    squares = sum(place * place for place in places)
    return tuple(place / squares if squares else Fraction(0) for place in places)
