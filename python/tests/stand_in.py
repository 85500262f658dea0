"""A robot in the same process, with what makes physical ones hard to drive: late steps, weak motors, floors that slope.

It shares no code with the parts under test, and needs no simulator: a minute of driving takes a few hundredths of a second.
"""

import asyncio
import math
import random
from collections.abc import Callable, Coroutine, Sequence
from dataclasses import dataclass
from typing import Any

from driving import ROBOTS
from pydslrep_runtime import Backend, Pose, Robot, movements
from pydslrep_runtime.checked_backend import CheckedBackend
from pydslrep_runtime.event_loop import SimulationLoop
from pydslrep_runtime.movements import Movement
from pydslrep_runtime.trace import Trace

TRACK, WHEELBASE, RADIUS = 0.30, 0.25, 0.045  # m
SUBSTEPS = 10
SCRUB = 1.0 + (WHEELBASE / TRACK) ** 2  # docs/kinematics.md

WHEELS = {
    "two-wheel": ("left", "right"),
    "four-wheel": ("left_front", "left_rear", "right_front", "right_rear"),
    "mecanum": ("left_front", "left_rear", "right_front", "right_rear"),
}


@dataclass
class Physics:
    """What a robot's motors and its floor do, and how long steps take."""

    step: float = 0.05  # s that a step should take
    late: float = 0.0  # by which steps take longer, as a share
    jitter: float = 0.0  # by which that varies, evenly to both sides, as a share
    lag: float = 0.0  # s after which a motor has made 63 % of a change
    bounce: float = (
        0.0  # s; the body follows its wheels as a spring does, and overshoots
    )
    droop: float = 0.0  # m/s by which rims are slower than told where wheels scrub
    scrub: float = SCRUB  # by how much less four plain wheels turn the body
    slide: float = 0.0  # m along y per radian that the body turns, wherever it faces
    wall: float = math.inf  # the x that its middle cannot exceed
    seed: int = 1


class World:
    """The clock of a robot."""

    def __init__(self, robot: "StandIn") -> None:
        self.time, self.time_step = 0.0, robot.physics.step
        self._robot = robot
        self._dice = random.Random(robot.physics.seed)

    def advance(self) -> None:
        """Takes a step, which may be late."""
        physics = self._robot.physics
        off = physics.jitter * self._dice.uniform(-1.0, 1.0)
        seconds = self.time_step * (1.0 + physics.late + off)
        for _ in range(SUBSTEPS):
            self._robot.move_on(seconds / SUBSTEPS)
        self.time += seconds


class StandIn(Backend):
    """The robot; `here` is its pose."""

    def __init__(self, drive: str, physics: Physics | None = None) -> None:
        self.physics = physics or Physics()
        self.kind = drive
        self.clock = World(self)
        self.here = Pose(0.0, 0.0, 0.0)
        self.rims = [0.0] * len(WHEELS[drive])
        self.told = list(self.rims)  # m/s
        self.sensors: dict[str, Callable[[], float | None]] = {}
        # Of the body: ahead, to the left, and in a turn.
        self._twist = [0.0, 0.0, 0.0]
        self._change = [0.0, 0.0, 0.0]

    def wheel_mounts(self) -> Sequence[tuple[float, float]]:
        """Where its wheels are."""
        y, x = TRACK / 2.0, WHEELBASE / 2.0
        if self.kind == "two-wheel":
            return [(0.0, y), (0.0, -y)]
        return [(x, y), (-x, y), (x, -y), (-x, -y)]

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        """What its motors are told."""
        self.told = [rate * RADIUS for rate in rates]

    def pose(self) -> Pose:
        """Exactly where it is."""
        return self.here

    def distance(self, sensor: str) -> float | None:
        """What a sensor measures."""
        return self.sensors[sensor]()

    def move_on(self, dt: float) -> None:
        """Lets a part of a step pass."""
        share = (
            1.0 if self.physics.lag == 0.0 else 1.0 - math.exp(-dt / self.physics.lag)
        )
        loses = self.physics.droop if self._scrubs() else 0.0
        for wheel, told in enumerate(self.told):
            wanted = math.copysign(max(0.0, abs(told) - loses), told)
            self.rims[wheel] += share * (wanted - self.rims[wheel])
        self._follow_wheels(dt)
        ahead, left, turn = self._twist
        middle = self.here.theta + turn * dt / 2.0
        x = self.here.x + dt * (math.cos(middle) * ahead - math.sin(middle) * left)
        y = self.here.y + dt * (math.sin(middle) * ahead + math.cos(middle) * left)
        y += self.physics.slide * abs(turn) * dt
        theta = math.remainder(self.here.theta + turn * dt, math.tau)
        self.here = Pose(min(x, self.physics.wall), y, theta)

    def _follow_wheels(self, dt: float) -> None:
        """The body moves as its wheels roll, at once or as if it hung on a spring."""
        wanted = self._rolled()
        if self.physics.bounce == 0.0:
            self._twist = wanted
            return
        rate = 1.0 / self.physics.bounce
        for axis, goal in enumerate(wanted):
            pull = rate * rate * (goal - self._twist[axis]) - rate * self._change[axis]
            self._change[axis] += dt * pull
            self._twist[axis] += dt * self._change[axis]

    def _rolled(self) -> list[float]:
        if self.kind == "mecanum":
            lf, lr, rf, rr = self.rims
            across = (TRACK + WHEELBASE) / 2.0
            turn = (rf + rr - lf - lr) / 4.0 / across
            return [(lf + lr + rf + rr) / 4.0, (lr + rf - lf - rr) / 4.0, turn]
        half = len(self.rims) // 2
        left, right = sum(self.rims[:half]) / half, sum(self.rims[half:]) / half
        scrub = self.physics.scrub if self.kind == "four-wheel" else 1.0
        return [(left + right) / 2.0, 0.0, (right - left) / TRACK / scrub]

    def _scrubs(self) -> bool:
        """Whether four plain wheels are told to turn the body."""
        return self.kind == "four-wheel" and abs(self.told[0] - self.told[-1]) > 1e-9


def drive(
    robot: StandIn,
    actions: Callable[[Robot], Coroutine[Any, Any, None]],
    trace: Trace | None = None,
    bumpers: Sequence[str] = (),
) -> float:
    """Drives a robot; returns the seconds that it has taken, and raises what ends it early."""
    wheels = {name: (name, RADIUS) for name in WHEELS[robot.kind]}
    sensors = tuple(sensor for sensor in robot.sensors if sensor not in bumpers)
    declared = ROBOTS[robot.kind](
        "r",
        port=1,
        sensors=sensors,
        bumpers=bumpers,
        **wheels,  # type: ignore[arg-type]
    )
    spec = declared.spec("", 1)
    loop = SimulationLoop()
    declared.connect(spec, CheckedBackend(robot, spec), loop, 0, trace or Trace())

    async def main() -> None:
        movements.current.set(Movement("m"))
        await actions(declared)

    with asyncio.Runner(loop_factory=lambda: loop) as runner:
        loop.use_clock(robot.clock)
        try:
            runner.run(main())
        finally:
            loop.use_clock(None)
    return robot.clock.time


def planned(kind: str, *actions: tuple[str, float] | tuple[str, float, float]) -> float:
    """How long a plan says that moves in metres and turns in degrees take, at m/s: docs/kinematics.md."""
    acceleration, rest = 0.5, 0.15
    arms = {"two-wheel": TRACK / 2.0, "four-wheel": SCRUB * TRACK / 2.0}
    arm = arms.get(kind, (TRACK + WHEELBASE) / 2.0)
    total = 0.0
    for what, amount, *speed in actions:
        way = abs(amount) if what == "move" else math.radians(abs(amount)) * arm
        peak = min(speed[0] if speed else 0.09, math.sqrt(acceleration * way))
        total += way / peak + peak / acceleration + rest
    return total
