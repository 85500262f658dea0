"""Makes objects in a simulator's scene, and takes them away again if something goes wrong."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..remote_api import Connection
from .frames import Frame, Vector
from .marks import Marks

EVERYTHING = 0xFFFF  # the respondable mask of what collides with everything

# The parameters of CoppeliaSim's engines for the friction of a shape; a version may lack some.
FRICTIONS = (
    "bullet_body_oldfriction",
    "bullet_body_friction",
    "ode_body_friction",
    "vortex_body_primlinearaxisfriction",
    "newton_body_staticfriction",
    "newton_body_kineticfriction",
    "mujoco_body_friction1",
)


@dataclass(frozen=True)
class Matter:
    """How a shape behaves."""

    mass: float | None = None  # kg; None: it is static
    mask: int | None = EVERYTHING  # what it collides with; None: with nothing
    friction: float | None = None  # None: as the engine has it
    detectable: bool = False  # by proximity sensors


@dataclass(frozen=True)
class Place:
    """Where an object goes."""

    frame: Frame  # relative to its parent
    parent: int = -1  # -1: none


class Maker:
    """Makes objects for one environment; every method raises SimulatorError."""

    def __init__(self, connection: Connection, marks: Marks, environment: str) -> None:
        self.made: list[int] = []
        self._connection, self._sim = connection, connection.sim
        self._marks, self._environment = marks, environment

    def cuboid(self, size: Vector, matter: Matter) -> int:
        """A box; x, y and z in metres."""
        return self._primitive(self._sim.primitiveshape_cuboid, size, matter)

    def cylinder(self, radius: float, height: float, matter: Matter) -> int:
        """A cylinder along its z axis."""
        size = (2.0 * radius, 2.0 * radius, height)
        return self._primitive(self._sim.primitiveshape_cylinder, size, matter)

    def sphere(self, radius: float, matter: Matter) -> int:
        """A sphere."""
        size = (2.0 * radius, 2.0 * radius, 2.0 * radius)
        return self._primitive(self._sim.primitiveshape_spheroid, size, matter)

    def mesh(
        self, vertices: Sequence[Vector], triangles: Sequence[int], matter: Matter
    ) -> int:
        """A shape of triangles: the indices of three vertices each, counter-clockwise from outside."""
        numbers = [number for vertex in vertices for number in vertex]
        create = self._sim.createShape
        return self._shape(
            self._connection.call(create, 0, 0.0, numbers, list(triangles)), matter
        )

    def joint(self, torque: float | None) -> int:
        """A revolute joint about its z axis, whose motor is controlled by velocity; without torque, it turns freely."""
        sim, call = self._sim, self._connection.call
        joint = self._keep(
            call(sim.createJoint, sim.joint_revolute_subtype, sim.jointmode_dynamic, 0)
        )
        motor = sim.jointdynctrl_free if torque is None else sim.jointdynctrl_velocity
        call(sim.setObjectInt32Param, joint, sim.jointintparam_dynctrlmode, motor)
        if torque is not None:
            call(sim.setJointTargetForce, joint, torque)
            call(sim.setJointTargetVelocity, joint, 0.0)
        return joint

    def link(self, size: float) -> int:
        """What holds one dynamic shape to another: a force sensor that does not break."""
        create = self._sim.createForceSensor
        return self._keep(
            self._connection.call(
                create, 0, [0, 1, 1, 0, 0], [size, 0.0, 0.0, 0.0, 0.0]
            )
        )

    def sensor(self, reach: float, angle: float, offset: float) -> int:
        """A proximity sensor that looks along its z axis, into a cone that begins at an offset."""
        sim = self._sim
        faces = [16, 16, 1, 1, 1, 1, 0, 0]
        volume = [0.0] * 15
        volume[0], volume[1], volume[9] = offset, reach - offset, angle
        volume[12] = 0.01  # the size that it is drawn with
        kind = sim.proximitysensor_cone_subtype
        create = sim.createProximitySensor
        # 16 is what every type of sensor has; the other ones are deprecated.
        return self._keep(self._connection.call(create, kind, 16, 0, faces, volume))

    def put(
        self,
        handle: int,
        alias: str,
        place: Place,
        kind: str,
        more: Mapping[str, Any] | None = None,
    ) -> int:
        """Names, places and marks an object, with more for `pull` to know; returns its handle."""
        sim, call = self._sim, self._connection.call
        call(sim.setObjectAlias, handle, alias)
        if place.parent >= 0:
            call(sim.setObjectParent, handle, place.parent, False)
        call(sim.setObjectMatrix, handle, place.frame, place.parent)
        mark = {"kind": kind, "environment": self._environment, **(more or {})}
        self._marks.write(handle, mark)
        return handle

    def frame(self, handle: int) -> Frame:
        """Where an object is in the world."""
        return list(self._connection.call(self._sim.getObjectMatrix, handle))

    def undo(self) -> None:
        """Removes everything that was made, even after an error."""
        if self.made:
            self._connection.last_call("sim.removeObjects", self.made)
        self.made = []

    def _primitive(self, kind: int, size: Vector, matter: Matter) -> int:
        create = self._sim.createPrimitiveShape
        return self._shape(self._connection.call(create, kind, list(size), 0), matter)

    def _shape(self, handle: int, matter: Matter) -> int:
        self._keep(handle)
        sim, call = self._sim, self._connection.call
        static, respondable = matter.mass is None, matter.mask is not None
        call(sim.setObjectInt32Param, handle, sim.shapeintparam_static, int(static))
        call(
            sim.setObjectInt32Param,
            handle,
            sim.shapeintparam_respondable,
            int(respondable),
        )
        if matter.mask is not None:
            mask = sim.shapeintparam_respondable_mask
            call(sim.setObjectInt32Param, handle, mask, matter.mask)
        if matter.mass is not None:
            call(sim.setShapeMass, handle, matter.mass)
        if matter.friction is not None:
            self._set_friction(handle, matter.friction)
        seen = sim.objectspecialproperty_detectable if matter.detectable else 0
        special = sim.objectspecialproperty_collidable | seen
        call(sim.setObjectSpecialProperty, handle, special)
        return handle

    def _set_friction(self, handle: int, friction: float) -> None:
        for name in FRICTIONS:
            parameter = getattr(self._sim, name, None)
            if parameter is not None:
                set_parameter = self._sim.setEngineFloatParam
                self._connection.call(set_parameter, parameter, handle, friction)

    def _keep(self, handle: int) -> int:
        self.made.append(handle)
        return handle
