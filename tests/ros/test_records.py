"""Records of runs: rclpy reads those of `--trace`, and `pydslrep replay` what has been recorded on topics."""

from __future__ import annotations

import pathlib
import subprocess
import sys
import threading
from typing import Any

import pytest
import rclpy
from conftest import Start
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from nav_msgs.msg import Odometry, Path
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import Range
from test_world import TIMEOUT, start_world
from until import until

TYPES = {
    "/rover/odom": Odometry,
    "/rover/range/front": Range,
    "/rover/plan": Path,
}


def drive(command: str, program: pathlib.Path, *options: object) -> str:
    """Runs a program in a world in lockstep; returns its table."""
    run = subprocess.run(
        [
            *(command, "run", program, "--target", "ros2", "--sim-time"),
            *("--python", sys.executable, "--no-progress", *options),
        ],
        capture_output=True,
        text=True,
        timeout=TIMEOUT,
    )
    assert run.returncode == 0, run.stdout + run.stderr
    return run.stdout


def replay(command: str, bag: pathlib.Path, program: pathlib.Path) -> str:
    done = subprocess.run(
        [command, "replay", bag, program], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def ends(table: str) -> list[float]:
    """Where the robot ended: metres and degrees."""
    row = next(line for line in table.splitlines() if "driven" in line)
    return [float(word) for word in row.split()[1:4]]


def test_rclpy_reads_a_trace(
    command: str, start: Start, short: pathlib.Path, tmp_path: pathlib.Path
) -> None:
    start_world(start, command, short, "--lockstep")
    bag = tmp_path / "run.mcap"
    table = drive(command, short, "--trace", bag)
    found: dict[str, list[Any]] = {topic: [] for topic in TYPES}
    with bag.open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            kind = TYPES[channel.topic]
            assert schema is not None
            assert schema.name == f"{kind.__module__.split('.')[0]}/msg/{kind.__name__}"
            found[channel.topic].append(deserialize_message(message.data, kind))
    assert len(found["/rover/odom"]) > 100
    last = found["/rover/odom"][-1].pose.pose.position
    assert [last.x, last.y] == pytest.approx(ends(table)[:2], abs=0.001)
    # It looks ahead while it approaches the wall, and stops when that is half a metre away.
    ranges = [message.range for message in found["/rover/range/front"]]
    assert min(ranges) < 0.5 < ranges[0]
    (plan,) = found["/rover/plan"]
    assert plan.header.frame_id == "odom"
    assert replay(command, bag, short).splitlines()[:4] == table.splitlines()[:4]


def test_what_is_recorded_on_topics_is_replayed(
    command: str, start: Start, short: pathlib.Path, tmp_path: pathlib.Path
) -> None:
    """As the recorder of ROS 2 does it: the bytes of messages as they come."""
    start_world(start, command, short, "--lockstep")
    bag = tmp_path / "lap.mcap"
    with Recorder(bag, "/rover/odom", "/rover/range/front") as recorder:
        until("the recorder has messages", lambda: recorder.count > 0)
        table = drive(command, short)
    assert recorder.count > 100
    assert ends(replay(command, bag, short)) == pytest.approx(ends(table), abs=0.01)


class Recorder:
    """Writes what is published on topics into a bag."""

    def __init__(self, bag: pathlib.Path, *topics: str) -> None:
        self.count = 0
        self._bag, self._topics = bag, topics

    def __enter__(self) -> Recorder:
        self._context = rclpy.Context()
        rclpy.init(context=self._context)
        self._node = Node("recorder", context=self._context)
        self._file = self._bag.open("wb")
        self._writer = Writer(self._file, compression=CompressionType.ZSTD)
        self._writer.start(profile="ros2")
        for topic in self._topics:
            self._subscribe(topic)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._executor.spin)
        self._thread.start()
        return self

    def _subscribe(self, topic: str) -> None:
        kind = TYPES[topic]
        name = f"{kind.__module__.split('.')[0]}/msg/{kind.__name__}"
        schema = self._writer.register_schema(name, "ros2msg", b"")
        channel = self._writer.register_channel(topic, "cdr", schema)

        def write(message: bytes) -> None:
            self.count += 1
            now = self._node.get_clock().now().nanoseconds
            self._writer.add_message(channel, now, message, now)

        self._node.create_subscription(
            kind, topic, write, qos_profile_sensor_data, raw=True
        )

    def __exit__(self, *_: object) -> None:
        self._executor.shutdown()
        self._thread.join()
        self._node.destroy_node()
        rclpy.shutdown(context=self._context)
        self._writer.finish()
        self._file.close()
