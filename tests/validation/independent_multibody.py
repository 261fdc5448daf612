"""Small vibrations of a multibody vehicle by another method: screws and direct stiffness, with NumPy alone.

Every body hangs on a chain of elementary moves and turns. To second order in their sizes a_i the displacement of a
point x is the sum of a_i s_i(x), half of a_i^2 s_i(s_i(x)), and a_i a_j s_i(s_j(x)) for i above j in the chain, where
s(x) = e x (x - c) for a turn about the axis e through c. So the matrices are sums over the elements: no energy is
differentiated, no symbol needed, and of the package only the record of topology and numbers is used.
"""

from dataclasses import dataclass

import numpy as np

X, Y, Z = np.eye(3)
GRAVITY = 9.81  # m/s2


@dataclass(frozen=True)
class Screw:
    coordinate: int
    axis: np.ndarray
    through: np.ndarray | None  # None: a move along the axis

    def of_point(self, point):
        return self.axis if self.through is None else np.cross(self.axis, point - self.through)

    def of_vector(self, vector):
        return np.zeros(3) if self.through is None else np.cross(self.axis, vector)


@dataclass(frozen=True)
class GroundSprings:
    """Springs between the ground and the axle above each wheel, and one against the turning of the wheelset."""

    along: tuple[float, float, float]  # N/m, at each of the two points
    turn: float  # N m/rad


class SmallVibrations:
    """Mass and stiffness of a vehicle on ground springs, at rest under its weight."""

    def __init__(self, model, ground):
        self.model, self.ground = model, ground
        self.places = {name: place for place, name in enumerate(model.coordinates)}
        self.size = len(self.places)
        self.bodies = {body.name: body for body in model.bodies}
        self.centers = {body.name: np.array(model.place(body.at), dtype=float) for body in model.bodies}
        self.preloads = self._preloads()

    # Kinematics

    def chain(self, name, *, spinning=True):
        """Moves and turns of a body, outermost first; a body on a wheelset does not spin with it."""
        body, center = self.bodies[name], self.centers[name]
        if body.joint in ("free", "wheelset"):
            place = {key: self.places[f"{name}.{key}"] for key in ("x", "y", "z", "roll", "pitch", "yaw")}
            moves = [Screw(place[key], axis, None) for key, axis in zip("xyz", (X, Y, Z), strict=True)]
            turns = [Screw(place["yaw"], Z, center), Screw(place["roll"], X, center)]
            spin = [Screw(place["pitch"], Y, center)] if spinning or body.joint == "free" else []
            return moves + turns + spin
        axis = center if body.joint == "rotor" else self.centers[body.on]
        if body.axis is not None:
            axis = np.array(self.model.place(body.axis), dtype=float)
        return [*self.chain(body.on, spinning=False), Screw(self.places[f"{name}.turn"], Y, axis)]

    def moves(self, chain, point):
        """First-order displacement of a point, (3, n)."""
        found = np.zeros((3, self.size))
        for screw in chain:
            found[:, screw.coordinate] += screw.of_point(point)
        return found

    def turns(self, chain):
        """First-order turn, (3, n)."""
        found = np.zeros((3, self.size))
        for screw in chain:
            if screw.through is not None:
                found[:, screw.coordinate] += screw.axis
        return found

    def second_order_height(self, chain, point):
        """Matrix H (n, n) so that a point rises by q'Hq/2 beyond the first order."""
        found = np.zeros((self.size, self.size))
        for i, outer in enumerate(chain):
            for inner in chain[i:]:
                rise = outer.of_vector(inner.of_point(point))[2]
                found[outer.coordinate, inner.coordinate] += rise
                if inner is not outer:
                    found[inner.coordinate, outer.coordinate] += rise
        return found

    def axle_points(self, wheelset):
        """Chain of the frame of a wheelset that does not spin, and its points above the two wheels."""
        chain, half = self.chain(wheelset, spinning=False), self.model.numbers["wheel_half_spacing"]
        return chain, [self.centers[wheelset] + side * half * Y for side in (1.0, -1.0)]

    # Equilibrium

    def _preloads(self):
        """Vertical forces of least norm that carry the weight: of springs up on the second body, of wheels."""
        weight = np.zeros(self.size)
        for name, center in self.centers.items():
            weight += self.mass_of(name) * GRAVITY * self.moves(self.chain(name), center)[2]
        rows = {}
        for spring in self.model.springs:
            if spring.carries:
                rows[spring.name] = self.relative(spring.between, self.place(spring))[2]
        for wheelset in self.model.wheelset_names:
            chain, points = self.axle_points(wheelset)
            for side, point in zip(("left", "right"), points, strict=True):
                rows[f"{wheelset}.{side}"] = self.moves(chain, point)[2]
        forces, *_ = np.linalg.lstsq(np.array(list(rows.values())).T, weight, rcond=None)
        self.residual = np.abs(np.array(list(rows.values())).T @ forces - weight).max()
        return dict(zip(rows, forces, strict=True))

    def mass_of(self, name):
        model = self.model
        if name != model.remainder:
            return float(model.numbers[f"{self.bodies[name].kind}.mass"])
        return float(model.numbers["mass"]) - sum(
            self.mass_of(other) for other in self.bodies if other != name
        )

    def place(self, element):
        return np.array(self.model.place(element.at), dtype=float)

    def relative(self, between, point):
        """Displacement of the second body against the first at a point, (3, n)."""
        first, second = between
        return self.moves(self.chain(second), point) - self.moves(self.chain(first), point)

    # Matrices

    def inertia_of(self, name):
        numbers, kind = self.model.numbers, self.bodies[name].kind
        if f"{kind}.inertia_axial" in numbers:
            return np.diag(
                [numbers[f"{kind}.inertia_{key}"] for key in ("transverse", "axial", "transverse")]
            )
        if f"{kind}.gyration_x" in numbers:
            return self.mass_of(name) * np.diag([numbers[f"{kind}.gyration_{axis}"] ** 2 for axis in "xyz"])
        return np.diag([numbers[f"{kind}.inertia_{axis}"] for axis in "xyz"])

    def mass(self):
        found = np.zeros((self.size, self.size))
        for name, center in self.centers.items():
            chain = self.chain(name)
            moves, turns = self.moves(chain, center), self.turns(chain)
            found += self.mass_of(name) * moves.T @ moves + turns.T @ self.inertia_of(name) @ turns
        for gear in self.model.gears:
            pinion = self.pinion(gear)
            found += self.model.numbers[f"{gear.kind}.pinion_inertia"] * np.outer(pinion, pinion)
        return found

    def pinion(self, gear):
        """Turn of a pinion that rolls on the wheel of the axle, (n,): that of the housing, and more by the ratio."""
        ratio = self.model.numbers[f"{gear.kind}.ratio"]
        housing = self.turns(self.chain(gear.housing))[1]
        return (1.0 + ratio) * housing - ratio * self.turns(self.chain(self.bodies[gear.housing].on))[1]

    def torsion(self, gear):
        """Turn of a rotor against its pinion, (n,)."""
        return self.turns(self.chain(gear.rotor))[1] - self.pinion(gear)

    def suspension(self, property_="stiffness"):
        """Stiffness, or damping, of springs, rods and gears."""
        numbers, found = self.model.numbers, np.zeros((self.size, self.size))
        for spring in self.model.springs:
            first, second = spring.between
            moved = self.relative(spring.between, self.place(spring))
            turned = self.turns(self.chain(second)) - self.turns(self.chain(first))
            for key, row in zip(("x", "y", "z", "roll", "pitch", "yaw"), (*moved, *turned), strict=True):
                found += numbers.get(f"{spring.kind}.{property_}_{key}", 0.0) * np.outer(row, row)
        for rod in self.model.rods:
            start, end = (np.array(self.model.place(place), dtype=float) for place in rod.ends)
            first, second = rod.between
            along = (end - start) / np.linalg.norm(end - start)
            row = along @ (self.moves(self.chain(second), end) - self.moves(self.chain(first), start))
            found += numbers.get(f"{rod.kind}.{property_}", 0.0) * np.outer(row, row)
        for gear in self.model.gears:
            row = self.torsion(gear)
            found += numbers[f"{gear.kind}.{property_}"] * np.outer(row, row)
        return found

    def geometric(self):
        """Stiffness of weight and preloads: what they do when their points move to second order."""
        found = np.zeros((self.size, self.size))
        for name, center in self.centers.items():
            found += self.mass_of(name) * GRAVITY * self.second_order_height(self.chain(name), center)
        for spring in self.model.springs:
            if spring.carries:
                point, (first, second) = self.place(spring), spring.between
                heights = [self.second_order_height(self.chain(name), point) for name in (first, second)]
                found -= self.preloads[spring.name] * (heights[1] - heights[0])
        for wheelset in self.model.wheelset_names:
            chain, points = self.axle_points(wheelset)
            for side, point in zip(("left", "right"), points, strict=True):
                found -= self.preloads[f"{wheelset}.{side}"] * self.second_order_height(chain, point)
        return found + self.tilting()

    def tilting(self):
        """Stiffness from preloads that tilt with the bodies that they stand on, half with each.

        A force P that leans by a turn over a displacement does the work P (turn x displacement) on the two bodies: its
        points of attack part, and its pair must not turn both.
        """
        found = np.zeros((self.size, self.size))
        for spring in self.model.springs:
            if spring.carries:
                moved = self.relative(spring.between, self.place(spring))
                turned = 0.5 * sum(self.turns(self.chain(name)) for name in spring.between)
                cross = np.outer(turned[0], moved[1]) - np.outer(turned[1], moved[0])
                found += self.preloads[spring.name] * (cross + cross.T)
        return found

    def ground_stiffness(self):
        found = np.zeros((self.size, self.size))
        for wheelset in self.model.wheelset_names:
            chain, points = self.axle_points(wheelset)
            for point in points:
                for stiffness, row in zip(self.ground.along, self.moves(chain, point), strict=True):
                    found += stiffness * np.outer(row, row)
            spin = self.places[f"{wheelset}.pitch"]
            found[spin, spin] += self.ground.turn
        return found

    def stiffness(self):
        return self.suspension() + self.geometric() + self.ground_stiffness()
