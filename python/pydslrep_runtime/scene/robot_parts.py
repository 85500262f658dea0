"""The objects of a robot: body, wheels on their joints, casters, sensors.

The body is the object with the robot's name. It moves by itself: its x axis points ahead, its z axis up. Each wheel
turns about a joint with the wheel's name, below the body.
"""

import math

from ..facts import ROBOT_TYPES
from .description import RobotDescription, SensorDescription, WheelDescription
from .frames import Frame, Vector, frame, planar
from .maker import Maker, Matter, Place

DENSITY = 40.0  # kg per square metre of a robot's outline
# Masses to that of the body. Engines solve joints the worse, the more a part carries for its mass.
WHEEL_SHARE = 0.05
CASTER_SHARE = 0.02
HUB_SHARE = 0.125  # of a mecanum wheel
ROLLER_SHARE = 0.05
GRAVITY = 9.81  # m/s²
WHEEL_FRICTION = 1.0
HUB_SIZE = 0.9  # the radius of a hub to that of the wheel
ROLLERS = 8  # of a mecanum wheel
# The radius of a roller to that of the wheel: the larger, the less the wheel bumps from one roller to the next. Rollers
# of a wheel overlap.
ROLLER_SIZE = 0.8
GAP = 0.001  # m between a robot's outline and what its sensors see
FLOOR_GAP = 0.01  # m between the floor and what they see
MAX_TILT = math.radians(45.0)  # of a sensor: above, it would look over obstacles

# The parts of a robot overlap: the lower eight bits of a mask are for objects with a common parent, the upper ones for
# all others. No part has a bit of the lower ones in common with another.
BODY_MASK, WHEEL_MASK, CASTER_MASK, ROLLER_MASK = 0xFF01, 0xFF02, 0xFF04, 0xFF00


def build_robot(maker: Maker, robot: RobotDescription) -> list[str]:
    """Makes a robot; returns what is worth knowing. Raises SimulatorError."""
    height = max(wheel.radius for wheel in robot.wheels)
    mass = body_mass(robot)
    body = maker.cuboid(
        (robot.length, robot.width, height),
        Matter(mass, BODY_MASK, detectable=True),
    )
    start = planar(robot.x, robot.y, height, robot.heading)
    more = {
        "type": robot.type,
        "grip": robot.grip,
        "rim_speed": robot.rim_speed,
        "rim_acceleration": robot.rim_acceleration,
    }
    maker.put(body, robot.name, Place(start), "robot", more)
    kind = ROBOT_TYPES[robot.type]
    for wheel, push in zip(robot.wheels, kind.pushes, strict=True):
        # More than friction passes on: a wheel carries a share of its robot's weight.
        torque = mass * GRAVITY * wheel.radius
        axle = wheel_frame(wheel, height)
        joint = maker.put(maker.joint(torque), wheel.name, Place(axle, body), "joint")
        if kind.mecanum:
            # Seen from the axle of its wheel, the axis of a roller points to the other side.
            _build_mecanum_wheel(maker, wheel, joint, mass, -push)
        else:
            _build_wheel(maker, wheel, joint, mass * WHEEL_SHARE)
    if kind.one_axle:
        _build_casters(maker, robot, body, height, mass * CASTER_SHARE)
    notes = []
    for sensor in robot.sensors:
        tilt = tilt_of(sensor, height)
        if tilt > MAX_TILT:
            notes.append(
                f"sensor {sensor.name} of {robot.name} sees the floor, if that is detectable: its cone is too wide"
            )
        _build_sensor(maker, robot, sensor, body, min(tilt, MAX_TILT))
    return notes


def tilt_of(sensor: SensorDescription, height: float) -> float:
    """How far a sensor at a height must look up to see nothing of a floor, in radians.

    The lower edge of its cone may fall as far as the floor is below it over the whole range.
    """
    fall = (height - FLOOR_GAP) / sensor.range
    return max(sensor.cone / 2.0 - math.asin(max(min(fall, 1.0), 0.0)), 0.0)


def body_mass(robot: RobotDescription) -> float:
    """The mass of a robot's body in kg.

    Hubs and rollers are so heavy that they are a part of the mass that the outline asks for.
    """
    mass = DENSITY * robot.length * robot.width
    if not ROBOT_TYPES[robot.type].mecanum:
        return mass
    return mass / (1.0 + len(robot.wheels) * (HUB_SHARE + ROLLERS * ROLLER_SHARE))


def wheel_frame(wheel: WheelDescription, height: float) -> Frame:
    """A joint on its robot's body, whose middle is at a height: it turns about its z axis."""
    side = -1.0 if wheel.mirrored else 1.0
    return frame((wheel.x, wheel.y, wheel.radius - height), z=(0.0, side, 0.0))


def _build_wheel(
    maker: Maker, wheel: WheelDescription, joint: int, mass: float
) -> None:
    matter = Matter(mass, WHEEL_MASK, friction=WHEEL_FRICTION)
    shape = maker.cylinder(wheel.radius, 0.5 * wheel.radius, matter)
    maker.put(
        shape, f"{wheel.name}_wheel", Place(frame((0.0, 0.0, 0.0)), joint), "wheel"
    )


def _build_mecanum_wheel(
    maker: Maker, wheel: WheelDescription, joint: int, body: float, sign: float
) -> None:
    """A hub with spheres around it, each of which turns freely about an axis at 45° to that of the wheel.

    `body` is the mass of the robot's body in kg.
    """
    matter = Matter(body * HUB_SHARE, mask=None)
    hub = maker.cylinder(HUB_SIZE * wheel.radius, 0.5 * wheel.radius, matter)
    maker.put(hub, f"{wheel.name}_wheel", Place(frame((0.0, 0.0, 0.0)), joint), "wheel")
    radius = ROLLER_SIZE * wheel.radius
    matter = Matter(body * ROLLER_SHARE, ROLLER_MASK, friction=WHEEL_FRICTION)
    for index in range(ROLLERS):
        # One of them stands on the floor at the start.
        angle = math.tau * index / ROLLERS - math.pi / 2.0
        out = (math.cos(angle), math.sin(angle), 0.0)
        distance = wheel.radius - radius
        middle = (distance * out[0], distance * out[1], 0.0)
        pin = maker.put(
            maker.joint(None),
            f"{wheel.name}_roller_joint",
            Place(frame(middle, x=out, z=roller_axis(angle, sign)), hub),
            "roller joint",
        )
        maker.put(
            maker.sphere(radius, matter),
            f"{wheel.name}_roller",
            Place(frame((0.0, 0.0, 0.0)), pin),
            "roller",
        )


def roller_axis(angle: float, sign: float) -> Vector:
    """The axis of the roller at an angle of its wheel, which turns about z.

    Seen from above, it is at 45° to that of the wheel on average while the roller stands on the floor: before and after
    the lowest point, an axis rises from the floor, and looks shorter along the rim.
    """
    half_arc = math.pi / ROLLERS
    along = half_arc / math.sin(half_arc)
    length = math.hypot(along, 1.0)
    along, across = along / length, sign / length
    return (-along * math.sin(angle), along * math.cos(angle), across)


def _build_casters(
    maker: Maker, robot: RobotDescription, body: int, height: float, mass: float
) -> None:
    """Spheres without friction, ahead of the wheels and behind them."""
    radius = 0.5 * min(wheel.radius for wheel in robot.wheels)
    distance = max(robot.length / 2.0 - radius, 0.0)
    matter = Matter(mass, CASTER_MASK, friction=0.0)
    for name, side in (("front", 1.0), ("rear", -1.0)):
        place = Place(frame((side * distance, 0.0, radius - height)), body)
        link = maker.put(maker.link(radius), f"{name}_caster_link", place, "link")
        maker.put(
            maker.sphere(radius, matter),
            f"{name}_caster",
            Place(frame((0.0, 0.0, 0.0)), link),
            "caster",
        )


def _build_sensor(
    maker: Maker,
    robot: RobotDescription,
    sensor: SensorDescription,
    body: int,
    tilt: float,
) -> None:
    """Makes a sensor that looks up by an angle."""
    level, up = math.cos(tilt), math.sin(tilt)
    offset = min((_way_out(robot, sensor) + GAP) / level, 0.9 * sensor.range)
    made = maker.sensor(sensor.range, sensor.cone, offset)
    cos, sin = math.cos(sensor.bearing), math.sin(sensor.bearing)
    ahead = (level * cos, level * sin, up)
    down = (up * cos, up * sin, -level)
    place = Place(frame((sensor.x, sensor.y, 0.0), x=down, z=ahead), body)
    more = {"sensor": sensor.kind, "range": sensor.range, "cone": sensor.cone}
    maker.put(made, sensor.name, place, "sensor", more)


def _way_out(robot: RobotDescription, sensor: SensorDescription) -> float:
    """How far it is from a sensor to its robot's outline: it must not see its own body."""
    half_length, half_width = robot.length / 2.0, robot.width / 2.0
    if abs(sensor.x) > half_length or abs(sensor.y) > half_width:
        return 0.0
    ways = [
        (math.copysign(half, direction) - at) / direction
        for at, half, direction in (
            (sensor.x, half_length, math.cos(sensor.bearing)),
            (sensor.y, half_width, math.sin(sensor.bearing)),
        )
        if abs(direction) > 1e-9
    ]
    return max(min(ways), 0.0)
