"""A simulated motor driver of a two-wheel robot, for docs/physical-robot.md.

It replaces the system's clock, and its motors have inertia. When the script ends, it writes the robot's actual pose to
`truth.json`. `MOTOR_DRIVER` selects a fault or a room: `stuck`, `missing`, `room` for a room around the robot, `broken`
for a room and a sensor that stops replying.
"""

import atexit
import json
import math
import os
import pathlib
import time

TRACK, RADIUS, SUBSTEP = 0.30, 0.045, 0.001
DELAY = 0.03  # s, time constant of the motors
TROUBLE = os.environ.get("MOTOR_DRIVER")

motors: list["Motor"] = []
truth = {"x": 0.0, "y": 0.0, "theta": 0.0}
now = 0.0


class Motor:
    """A motor with its encoder."""

    def __init__(self, name: str) -> None:
        if TROUBLE == "missing":
            raise OSError(f"no motor {name} on the bus")
        self.wanted = self.rate = self.rolled = 0.0
        self.closed = False
        motors.append(self)

    def set_speed(self, rate: float) -> None:
        self.wanted = rate

    def angle(self) -> float:
        return self.rolled

    def close(self) -> None:
        self.closed = True


ROOM = (-0.5, -0.5, 1.7, 0.5)  # minimum x and y, maximum x and y
MOUNTS = {  # positions of sensors, and their bearings in degrees
    "front": (0.15, 0.0, 0),
    "front_left": (0.15, 0.15, 45),
    "front_right": (0.15, -0.15, -45),
    "side_left": (0.0, 0.15, 90),
    "side_right": (0.0, -0.15, -90),
}


def distance(sensor: str) -> float:
    """A wall is ahead until the robot has turned by a third of a right angle."""
    if TROUBLE == "broken" and now > 5.0:
        raise OSError(f"no reply from sensor {sensor}")
    if TROUBLE in ("room", "broken"):
        x, y, bearing = MOUNTS[sensor]
        return min(to_wall(x, y, bearing + side) for side in range(-10, 11, 2))
    return 0.2 if abs(truth["theta"]) < math.pi / 6 else 3.0


def to_wall(x: float, y: float, bearing: float) -> float:
    """The distance to the room's walls from a position on the robot."""
    cos, sin = math.cos(truth["theta"]), math.sin(truth["theta"])
    x, y = truth["x"] + cos * x - sin * y, truth["y"] + sin * x + cos * y
    angle = truth["theta"] + math.radians(bearing)
    cos, sin = math.cos(angle), math.sin(angle)
    left, low, right, high = ROOM
    across = ((right if cos >= 0.0 else left) - x) / (cos or 1e-9)
    along = ((high if sin >= 0.0 else low) - y) / (sin or 1e-9)
    return min(across, along)


def sleep(seconds: float) -> None:
    """Replaces `time.sleep`: advances the world."""
    global now
    for _ in range(round(seconds / SUBSTEP)):
        now += SUBSTEP
        for motor in motors:
            wanted = 0.0 if TROUBLE == "stuck" else motor.wanted
            motor.rate += (wanted - motor.rate) * SUBSTEP / DELAY
            motor.rolled += motor.rate * SUBSTEP
        left, right = (motor.rate * RADIUS * SUBSTEP for motor in motors)
        truth["theta"] += (right - left) / TRACK
        truth["x"] += (left + right) / 2 * math.cos(truth["theta"])
        truth["y"] += (left + right) / 2 * math.sin(truth["theta"])


def write_down() -> None:
    state = {"wanted": [motor.wanted for motor in motors]}
    closed = all(motor.closed for motor in motors)
    report = json.dumps({**truth, **state, "closed": closed})
    pathlib.Path("truth.json").write_text(report, encoding="utf-8")


time.sleep = sleep  # type: ignore[assignment]
time.monotonic = lambda: now
atexit.register(write_down)
