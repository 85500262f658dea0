"""The objects of a robot: body, wheels on their joints, casters, sensors.

The body is the object with the robot's name. It moves by itself: its x axis points ahead, its z axis up. Each wheel
turns about a joint with the wheel's name, below the body.
"""

import math

from .description import RobotDescription, SensorDescription, WheelDescription
from .frames import Frame, frame, planar
from .maker import Maker, Matter, Place

DENSITY = 40.0  # kg of a body per square metre of its outline
WHEEL_SHARE = 0.05  # the mass of a wheel to that of its robot's body
CASTER_SHARE = 0.02
GRAVITY = 9.81  # m/s²
WHEEL_FRICTION = 1.0
ROLLERS = 12  # of a mecanum wheel
ROLLER_SIZE = 0.25  # their radius to that of the wheel
GAP = 0.001  # m between a robot's outline and what its sensors see

# The parts of a robot overlap: the lower eight bits of a mask are for objects with a common parent, the upper ones for
# all others. No part has a bit of the lower ones in common with another.
BODY_MASK, WHEEL_MASK, CASTER_MASK = 0xFF01, 0xFF02, 0xFF04

# Where a roller's axis points, to the axis of its wheel, in the order of the wheels.
ROLLER_SIGNS = (1.0, -1.0, -1.0, 1.0)


def build_robot(maker: Maker, robot: RobotDescription) -> None:
    """Makes a robot; raises SimulatorError."""
    height = max(wheel.radius for wheel in robot.wheels)
    mass = DENSITY * robot.length * robot.width
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
    for wheel, sign in zip(robot.wheels, ROLLER_SIGNS, strict=False):
        # Friction cannot pass on more than the whole robot's weight.
        torque = mass * GRAVITY * wheel.radius
        axle = wheel_frame(wheel, height)
        joint = maker.put(maker.joint(torque), wheel.name, Place(axle, body), "joint")
        if robot.type == "fwh":
            _build_mecanum_wheel(maker, wheel, joint, mass * WHEEL_SHARE, sign)
        else:
            _build_wheel(maker, wheel, joint, mass * WHEEL_SHARE)
    if robot.type == "tw":
        _build_casters(maker, robot, body, height, mass * CASTER_SHARE)
    for sensor in robot.sensors:
        _build_sensor(maker, robot, sensor, body)


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
    maker: Maker, wheel: WheelDescription, joint: int, mass: float, sign: float
) -> None:
    """A hub with spheres around it, each of which turns freely about an axis at 45° to that of the wheel."""
    roller = ROLLER_SIZE * wheel.radius
    hub = maker.cylinder(
        wheel.radius - 2.0 * roller, 0.5 * wheel.radius, Matter(mass / 2.0, mask=None)
    )
    maker.put(hub, f"{wheel.name}_wheel", Place(frame((0.0, 0.0, 0.0)), joint), "wheel")
    matter = Matter(mass / 2.0 / ROLLERS, WHEEL_MASK, friction=WHEEL_FRICTION)
    for index in range(ROLLERS):
        angle = math.tau * index / ROLLERS
        out = (math.cos(angle), math.sin(angle), 0.0)
        # Halfway between the rim's direction and the axis of the wheel.
        half = math.sqrt(0.5)
        axis = (-half * out[1], half * out[0], half * sign)
        distance = wheel.radius - roller
        middle = (distance * out[0], distance * out[1], 0.0)
        pin = maker.put(
            maker.joint(None),
            f"{wheel.name}_roller_joint",
            Place(frame(middle, x=out, z=axis), hub),
            "roller joint",
        )
        maker.put(
            maker.sphere(roller, matter),
            f"{wheel.name}_roller",
            Place(frame((0.0, 0.0, 0.0)), pin),
            "roller",
        )


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
    maker: Maker, robot: RobotDescription, sensor: SensorDescription, body: int
) -> None:
    offset = min(_way_out(robot, sensor) + GAP, 0.9 * sensor.range)
    made = maker.sensor(sensor.range, sensor.cone, offset)
    ahead = (math.cos(sensor.bearing), math.sin(sensor.bearing), 0.0)
    down = (0.0, 0.0, -1.0)
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
