"""A multibody vehicle in exudyn, as a tree of moves and turns whose equations exudyn sets up by its own recursions.

Of this package only the record of topology and numbers is used; masses, preloads and ground springs are given. What a
pinion adds is a matrix over its coordinates, since exudyn has no such gear.
"""

import warnings

import numpy as np

GRAVITY = 9.81  # m/s2
_LINE = 1.0  # m
_ROWS = ("x", "y", "z", "roll", "pitch", "yaw")
_ORDER = ("x", "y", "z", "yaw", "roll", "pitch")  # of moves and turns of a free body, from the ground on


def eigenfrequencies(model, vibrations):
    """Eigenfrequencies [Hz] at rest under the weight, lowest first.

    Parameters
    ----------
    model : Multibody
        Topology and numbers.
    vibrations : SmallVibrations
        Masses, inertias, preloads and ground springs; none of its matrices is used.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return _Build(model, vibrations).frequencies()


class _Build:
    def __init__(self, model, vibrations):
        import exudyn
        from exudyn import itemInterface

        self.exudyn, self.joints, self.items = exudyn, exudyn.JointType, itemInterface
        self.container = exudyn.SystemContainer()
        self.system = self.container.AddSystem()
        self.ground = self.system.CreateGround()
        self.model, self.numbers, self.given = model, model.numbers, vibrations
        self.centers = {body.name: np.array(model.place(body.at), dtype=float) for body in model.bodies}
        self.links, self.frames = {}, {}  # of a body: its link, and the one that children of it turn on
        self.tree = self._tree()
        for spring in model.springs:
            self._spring(spring)
        for rod in model.rods:
            self._rod(rod)
        for name in model.wheelset_names:
            self._on_ground(name)
        for gear in model.gears:
            self._gear(gear)

    def frequencies(self):
        self.system.Assemble()
        values = np.sort(np.asarray(self.system.ComputeODE2Eigenvalues()[0]))
        return np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi)

    def _tree(self):
        kinds = {
            "x": self.joints.PrismaticX,
            "y": self.joints.PrismaticY,
            "z": self.joints.PrismaticZ,
            "yaw": self.joints.RevoluteZ,
            "roll": self.joints.RevoluteX,
            "pitch": self.joints.RevoluteY,
            "turn": self.joints.RevoluteY,
        }
        types, parents, offsets, places = [], [], [], []
        masses, inertias, arms = [], [], []

        def link(kind, parent, offset, place):
            types.append(kinds[kind])
            parents.append(parent)
            offsets.append(offset)
            places.append(place)
            masses.append(0.0)
            inertias.append(np.zeros((3, 3)))
            arms.append(np.zeros(3))
            return len(types) - 1

        for body in self.model.bodies:
            center = self.centers[body.name]
            if body.on:
                axis = center if body.joint == "rotor" else self.centers[body.on]
                if body.axis is not None:
                    axis = np.array(self.model.place(body.axis), dtype=float)
                last = link("turn", self.frames[body.on], axis - self.centers[body.on], axis)
                self.frames[body.name] = last
            else:
                parent, offset = -1, center
                for key in _ORDER:
                    parent = link(key, parent, offset, center)
                    offset = np.zeros(3)
                last = parent
                self.frames[body.name] = last - 1 if body.joint == "wheelset" else last
            self.links[body.name] = last
            masses[last] = self.given.mass_of(body.name)
            inertias[last] = self.given.inertia_of(body.name)
            arms[last] = center - places[last]
        self.places = places
        size = len(types)
        self.node = self.system.AddNode(
            self.items.NodeGenericODE2(
                numberOfODE2Coordinates=size,
                referenceCoordinates=[0.0] * size,
                initialCoordinates=[0.0] * size,
                initialCoordinates_t=[0.0] * size,
            )
        )
        return self.system.AddObject(
            self.items.ObjectKinematicTree(
                nodeNumber=self.node,
                jointTypes=types,
                linkParents=parents,
                jointTransformations=self.exudyn.Matrix3DList([np.eye(3)] * size),
                jointOffsets=self.exudyn.Vector3DList([list(map(float, each)) for each in offsets]),
                linkInertiasCOM=self.exudyn.Matrix3DList(inertias),
                linkCOMs=self.exudyn.Vector3DList([list(map(float, each)) for each in arms]),
                linkMasses=masses,
                baseOffset=[0.0, 0.0, 0.0],
                gravity=[0.0, 0.0, -GRAVITY],
            )
        )

    def _marker(self, link, point):
        if link is None:
            return self.system.AddMarker(
                self.items.MarkerBodyRigid(bodyNumber=self.ground, localPosition=[float(x) for x in point])
            )
        return self.system.AddMarker(
            self.items.MarkerKinematicTreeRigid(
                objectNumber=self.tree,
                linkNumber=link,
                localPosition=[float(x) for x in point - self.places[link]],
            )
        )

    def _spring(self, spring):
        """Springs in the axes of the first body, and the preload as a tension, half along the vertical of each body.

        The one line comes from a point below on the first body, the other from one above on the second. A tension T
        over lines of a length l adds T/l across them, which the springs give back.
        """
        point = np.array(self.model.place(spring.at), dtype=float)
        first, second = (self.links[name] for name in spring.between)
        tension = -self.given.preloads.get(spring.name, 0.0)
        stiffness = np.array([self.numbers.get(f"{spring.kind}.stiffness_{key}", 0.0) for key in _ROWS])
        stiffness[:2] -= tension / _LINE
        self.system.AddObject(
            self.items.RigidBodySpringDamper(
                markerNumbers=[self._marker(first, point), self._marker(second, point)],
                stiffness=np.diag(stiffness),
                damping=np.zeros((6, 6)),
            )
        )
        if tension:
            away = np.array([0.0, 0.0, _LINE])
            for ends in ((first, point - away, second), (second, point + away, first)):
                link, anchor, other = ends
                self.system.AddObject(
                    self.items.SpringDamper(
                        markerNumbers=[self._marker(link, anchor), self._marker(other, point)],
                        stiffness=0.0,
                        referenceLength=_LINE,
                        force=0.5 * float(tension),
                    )
                )

    def _rod(self, rod):
        ends = [np.array(self.model.place(place), dtype=float) for place in rod.ends]
        self.system.AddObject(
            self.items.SpringDamper(
                markerNumbers=[
                    self._marker(self.links[name], end) for name, end in zip(rod.between, ends, strict=True)
                ],
                stiffness=self.numbers[f"{rod.kind}.stiffness"],
                referenceLength=float(np.linalg.norm(ends[1] - ends[0])),
            )
        )

    def _gear(self, gear):
        wheelset = next(body.on for body in self.model.bodies if body.name == gear.housing)
        motor = next(body.on for body in self.model.bodies if body.name == gear.rotor)
        ratio, size = self.numbers[f"{gear.kind}.ratio"], len(self.places)
        pinion, rotor = np.zeros(size), np.zeros(size)
        pinion[self.links[gear.housing]] = 1.0 + ratio
        pinion[self.links[wheelset]] = -ratio
        rotor[[self.links[motor], self.links[gear.rotor]]] = 1.0
        self.system.AddObject(
            self.items.ObjectGenericODE2(
                nodeNumbers=[self.node],
                massMatrix=self.numbers[f"{gear.kind}.pinion_inertia"] * np.outer(pinion, pinion),
                stiffnessMatrix=self.numbers[f"{gear.kind}.stiffness"]
                * np.outer(rotor - pinion, rotor - pinion),
            )
        )

    def _on_ground(self, wheelset):
        half, center, frame = (
            self.numbers["wheel_half_spacing"],
            self.centers[wheelset],
            self.frames[wheelset],
        )
        for name, side in (("left", 1.0), ("right", -1.0)):
            point = center + np.array([0.0, side * half, 0.0])
            marker, load = self._marker(frame, point), self.given.preloads[f"{wheelset}.{name}"]
            self.system.AddObject(
                self.items.CartesianSpringDamper(
                    markerNumbers=[self._marker(None, point), marker],
                    stiffness=list(self.given.ground.along),
                    damping=[0.0, 0.0, 0.0],
                )
            )
            self.system.AddLoad(self.items.Force(markerNumber=marker, loadVector=[0.0, 0.0, float(load)]))
        turn = np.zeros(len(self.places))
        turn[self.links[wheelset]] = 1.0
        self.system.AddObject(
            self.items.ObjectGenericODE2(
                nodeNumbers=[self.node],
                massMatrix=np.zeros((len(turn), len(turn))),
                stiffnessMatrix=self.given.ground.turn * np.outer(turn, turn),
            )
        )
