"""Traces as bags of ROS 2, which tools of others open, and `pydslrep replay`, which reads those of others."""

from __future__ import annotations

import json
import math
import pathlib
import re
import shutil
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

sys.path.append(str(pathlib.Path(__file__).parents[1] / "support"))

from program_runs import command_line, lines

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples"
STORE = get_typestore(Stores.ROS2_KILTED)
PROGRAM = """\
wheel a with radius 4
wheel b with radius 4
sensor front : distance
sensor skirt : bumper
robot rover with port 18363 has { a b } wheels with sensors { front, skirt }
movement m of rover {
  move 60 centimeters until { skirt, front } detect
  turn left 90
  move 20 centimeters
}
environment yard has { rover } robots with { m } moves
"""
SCENE = """\
[robots.rover.ros2]
namespace = "/"
odom = "odometry/filtered"
ranges = "ir/{sensor}"
base-frame = "base_footprint"
odom-frame = "world"

[[box]]
name = "wall"
at = [1.5, 0.0]
size = [0.1, 2.0]
"""
START = 1_750_000_000.5  # s, as the clock of a physical robot shows it


@pytest.fixture
def folder(tmp_path: pathlib.Path) -> pathlib.Path:
    (tmp_path / "yard.pyr").write_text(PROGRAM, encoding="utf-8")
    return tmp_path


def say(command: str, folder: pathlib.Path, *words: str) -> str:
    """What the command prints; it must succeed."""
    done = command_line(command, folder, *words)
    assert done.returncode == 0, done.stderr
    return done.stdout


def refuse(command: str, folder: pathlib.Path, *words: str) -> str:
    """What the command says that it cannot do, in one line."""
    done = command_line(command, folder, *words)
    assert done.returncode == 2, done
    return " ".join(done.stderr.split())


def messages(bag: pathlib.Path) -> Iterator[tuple[str, float, Any]]:
    """The messages of a bag, as the library of MCAP's authors reads them: topic, seconds and message."""
    with bag.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, message, decoded in reader.iter_decoded_messages():
            yield channel.topic, message.log_time / 1e9, decoded


def heading(orientation: Any) -> float:
    return 2.0 * math.atan2(orientation.z, orientation.w)


def test_a_bag_has_what_the_lines_have(command: str, tmp_path: pathlib.Path) -> None:
    """Four robots, whose topics have the names that their drivers would give them."""
    for name in ("crossing.pyr", "crossing.scene.toml"):
        shutil.copy(EXAMPLES / name, tmp_path)
    for trace in ("run.jsonl", "run.mcap"):
        say(command, tmp_path, "run", "crossing.pyr", "--no-progress", "--trace", trace)
    told = lines((tmp_path / "run.jsonl").read_text(encoding="utf-8"))
    found = list(messages(tmp_path / "run.mcap"))
    poses = [
        (topic, time, each) for topic, time, each in found if topic.endswith("odom")
    ]
    assert len(poses) == len(told)
    for (topic, time, message), line in zip(poses, told, strict=True):
        pose = message.pose.pose
        assert topic == f"/{line['robot']}/odom"
        assert time == pytest.approx(line["t"], abs=1e-6)
        assert message.header.stamp.sec + message.header.stamp.nanosec / 1e9 == (
            pytest.approx(line["t"], abs=1e-6)
        )
        assert (pose.position.x, pose.position.y) == pytest.approx(
            (line["x"], line["y"]), abs=1e-9
        )
        turned = heading(pose.orientation) - line["theta"]
        assert math.remainder(turned, math.tau) == pytest.approx(0.0, abs=1e-9)
    plans = {topic: each for topic, _, each in found if topic.endswith("plan")}
    planned = json.loads(say(command, tmp_path, "plan", "crossing.pyr", "--json"))
    for robot in planned[0]["robots"]:
        last = plans[f"/{robot['name']}/plan"].poses[-1].pose.position
        end = robot["poses"][-1]
        assert (last.x, last.y) == pytest.approx((end["x"], end["y"]), abs=1e-4)


def test_the_page_has_what_lines_have(command: str, folder: pathlib.Path) -> None:
    page = (EXAMPLES.parent / "docs" / "traces.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"^\{.*\}$", page, flags=re.MULTILINE)
    say(command, folder, "run", "yard.pyr", "--no-progress", "--trace", "run.jsonl")
    told = lines((folder / "run.jsonl").read_text(encoding="utf-8"))
    longest = max(told, key=len)
    assert [*json.loads(example)] == [*longest]


def test_topics_and_frames_are_those_of_the_scene(
    command: str, folder: pathlib.Path
) -> None:
    (folder / "yard.scene.toml").write_text(SCENE, encoding="utf-8")
    say(command, folder, "run", "yard.pyr", "--no-progress", "--trace", "run.mcap")
    with AnyReader([folder / "run.mcap"], default_typestore=STORE) as reader:
        types = {each.topic: each.msgtype for each in reader.connections}
        read: list[tuple[str, Any]] = [
            (each.topic, reader.deserialize(raw, each.msgtype))
            for each, _, raw in reader.messages()
        ]
    assert types == {
        "/odometry/filtered": "nav_msgs/msg/Odometry",
        "/ir/front": "sensor_msgs/msg/Range",
        "/ir/skirt": "sensor_msgs/msg/Range",
        "/plan": "nav_msgs/msg/Path",
    }
    odometry = [each for topic, each in read if topic == "/odometry/filtered"]
    frames = {(each.header.frame_id, each.child_frame_id) for each in odometry}
    assert frames == {("world", "base_footprint")}
    # It drives at 0.09 m/s, and turns to the left.
    assert max(each.twist.twist.linear.x for each in odometry) == pytest.approx(
        0.09, abs=0.002
    )
    assert max(each.twist.twist.angular.z for each in odometry) > 0.3
    front = [each for topic, each in read if topic == "/ir/front"]
    assert front[0].range == math.inf
    assert front[-1].range == pytest.approx(1.0, abs=0.01)
    assert front[-1].max_range == pytest.approx(1.0)
    assert {each.range for topic, each in read if topic == "/ir/skirt"} == {math.inf}


def test_a_bumper_that_is_pressed_is_nearer_than_it_can_measure(
    command: str, folder: pathlib.Path
) -> None:
    (folder / "yard.scene.toml").write_text(SCENE, encoding="utf-8")
    program = PROGRAM.replace(
        "60 centimeters until { skirt, front }", "until { skirt }"
    )
    (folder / "yard.pyr").write_text(program, encoding="utf-8")
    say(command, folder, "run", "yard.pyr", "--no-progress", "--trace", "run.mcap")
    found = messages(folder / "run.mcap")
    skirt = [each.range for topic, _, each in found if topic == "/ir/skirt"]
    assert skirt[0] == math.inf
    assert skirt[-1] == -math.inf


@pytest.mark.parametrize("trace", ["run.jsonl", "run.mcap"])
def test_a_replay_says_what_the_run_said(
    command: str, folder: pathlib.Path, trace: str
) -> None:
    (folder / "yard.scene.toml").write_text(SCENE, encoding="utf-8")
    options = ("--no-progress", "--trace", trace, "--picture", "run.svg")
    ran = say(command, folder, "run", "yard.pyr", *options)
    replayed = say(
        command, folder, "replay", trace, "yard.pyr", "--picture", "replay.svg"
    )
    table = ran.splitlines()[:4]
    assert replayed.splitlines()[:4] == table
    assert "recorded" in replayed
    # Sensors saw the same; only times begin with the record.
    dots = [
        re.findall(r"<circle[^>]*>", (folder / name).read_text(encoding="utf-8"))
        for name in ("run.svg", "replay.svg")
    ]
    assert dots[0] == dots[1] != []


def record(
    bag: pathlib.Path,
    topics: dict[str, str],
    compression: CompressionFormat | None = None,
    storage: StoragePlugin = StoragePlugin.MCAP,
) -> None:
    """A bag as the computer of a robot records it: a metre ahead in ten seconds, by each of the topics."""
    time, types = STORE.types["builtin_interfaces/msg/Time"], STORE.types
    header, vector = types["std_msgs/msg/Header"], types["geometry_msgs/msg/Vector3"]
    zero, unknown = vector(x=0.0, y=0.0, z=0.0), np.zeros(36)

    def message(kind: str, seconds: float) -> Any:
        stamp = time(sec=int(seconds), nanosec=round(seconds % 1.0 * 1e9))
        head = header(stamp=stamp, frame_id="odom")
        pose = types["geometry_msgs/msg/PoseWithCovariance"](
            pose=types["geometry_msgs/msg/Pose"](
                position=types["geometry_msgs/msg/Point"](
                    x=0.1 * (seconds - START), y=0.0, z=0.0
                ),
                orientation=types["geometry_msgs/msg/Quaternion"](
                    x=0.0, y=0.0, z=0.0, w=1.0
                ),
            ),
            covariance=unknown,
        )
        match kind:
            case "nav_msgs/msg/Odometry":
                twist = types["geometry_msgs/msg/TwistWithCovariance"](
                    twist=types["geometry_msgs/msg/Twist"](linear=zero, angular=zero),
                    covariance=unknown,
                )
                return types[kind](
                    header=head, child_frame_id="base_link", pose=pose, twist=twist
                )
            case "geometry_msgs/msg/PoseWithCovarianceStamped":
                return types[kind](header=head, pose=pose)
            case _:
                return types["std_msgs/msg/String"](data="what nobody asks for")

    writer = Writer(bag, version=9, storage_plugin=storage)
    if compression is not None:
        writer.set_compression(CompressionMode.STORAGE, compression)
    with writer:
        connections = {
            topic: writer.add_connection(topic, kind, typestore=STORE)
            for topic, kind in topics.items()
        }
        for step in range(200):
            now = START + 0.05 * step
            for topic, kind in topics.items():
                raw = STORE.serialize_cdr(message(kind, now), kind)
                writer.write(connections[topic], round(now * 1e9), raw)


def compress(
    bag: pathlib.Path,
    into: pathlib.Path,
    kind: CompressionType,
    times: tuple[float, float] = (0.0, math.inf),
) -> None:
    """Writes a bag again, its parts compressed, or only what is between two times in seconds."""
    with bag.open("rb") as old, into.open("wb") as new:
        writer = McapWriter(new, compression=kind)
        writer.start(profile="ros2")
        schemas: dict[int, int] = {}
        channels: dict[int, int] = {}
        for schema, channel, message in make_reader(old).iter_messages():
            assert schema is not None
            if not times[0] <= message.log_time / 1e9 < times[1]:
                continue
            if schema.id not in schemas:
                schemas[schema.id] = writer.register_schema(
                    schema.name, schema.encoding, schema.data
                )
            if channel.id not in channels:
                channels[channel.id] = writer.register_channel(
                    channel.topic, channel.message_encoding, schemas[schema.id]
                )
            writer.add_message(
                channels[channel.id],
                message.log_time,
                message.data,
                message.publish_time,
            )
        writer.finish()  # type: ignore[no-untyped-call]


@pytest.mark.parametrize("kind", list(CompressionType))
def test_compressed_bags_are_read(
    command: str, folder: pathlib.Path, kind: CompressionType
) -> None:
    say(command, folder, "run", "yard.pyr", "--no-progress", "--trace", "run.mcap")
    compress(folder / "run.mcap", folder / "other.mcap", kind)
    replayed = [
        say(command, folder, "replay", bag, "yard.pyr")
        for bag in ("run.mcap", "other.mcap")
    ]
    assert replayed[0] == replayed[1]


def test_a_bag_may_consist_of_several_files(command: str, folder: pathlib.Path) -> None:
    """In whatever order a folder lists them: here, the second one is first by its name."""
    (folder / "yard.scene.toml").write_text(SCENE, encoding="utf-8")
    say(command, folder, "run", "yard.pyr", "--no-progress", "--trace", "run.mcap")
    (folder / "lap").mkdir()
    for name, times in {"lap_2": (0.0, 4.0), "lap_10": (4.0, math.inf)}.items():
        part = folder / "lap" / f"{name}.mcap"
        compress(folder / "run.mcap", part, CompressionType.ZSTD, times)
    pictures = []
    for bag in ("run.mcap", "lap"):
        say(command, folder, "replay", bag, "yard.pyr", "--picture", f"{bag}.svg")
        pictures.append((folder / f"{bag}.svg").read_text(encoding="utf-8"))
    # The path, and the dots that sensors saw.
    assert pictures[0] == pictures[1]


ODOMETRY = "nav_msgs/msg/Odometry"
LOCALISED = "geometry_msgs/msg/PoseWithCovarianceStamped"


@pytest.mark.parametrize("compression", [None, CompressionFormat.ZSTD])
def test_a_bag_of_others_is_shown(
    command: str, folder: pathlib.Path, compression: CompressionFormat | None
) -> None:
    """Of a robot whose topics nobody has told; other topics are left alone."""
    record(
        folder / "lap",
        {"/base/odom": ODOMETRY, "/chatter": "std_msgs/msg/String"},
        compression,
    )
    alone = say(
        command, folder, "replay", "lap", "--picture", "lap.png", "--replay", "lap.svg"
    )
    assert re.search(
        r"/base/odom +0\.000 +0\.000 +0\.0 +0\.995 +0\.000 +0\.0 +0\.995", alone
    )
    assert "10.0 s recorded" in alone  # 9.95 s
    assert (folder / "lap.png").read_bytes().startswith(b"\x89PNG")
    over_plan = say(command, folder, "replay", "lap", "yard.pyr")
    assert re.search(r"driven +0\.995 +0\.000 +0\.0", over_plan)


def test_a_robot_that_localises_itself(command: str, folder: pathlib.Path) -> None:
    record(
        folder / "lap",
        {"/odom": ODOMETRY, "/amcl_pose": LOCALISED, "/rover/odom": ODOMETRY},
    )
    scene = '[robots.rover.ros2]\npose = "/amcl_pose"\n'
    (folder / "yard.scene.toml").write_text(scene, encoding="utf-8")
    assert "driven" in say(command, folder, "replay", "lap", "yard.pyr")
    alone = say(command, folder, "replay", "lap")
    for topic in ("/odom", "/amcl_pose", "/rover/odom"):
        assert topic in alone


def test_records_of_other_robots(command: str, folder: pathlib.Path) -> None:
    record(folder / "lap", {"/left/odom": ODOMETRY, "/right/odom": ODOMETRY})
    said = refuse(command, folder, "replay", "lap", "yard.pyr")
    assert "lap has no robot of `yard`, but these: /left/odom, /right/odom" in said
    assert "[robots.NAME.ros2]" in said


def test_a_trace_without_its_end_is_read(command: str, folder: pathlib.Path) -> None:
    say(command, folder, "run", "yard.pyr", "--no-progress", "--trace", "run.jsonl")
    content = (folder / "run.jsonl").read_bytes()
    (folder / "cut.jsonl").write_bytes(content[: len(content) // 2 - 5])
    done = command_line(command, folder, "replay", "cut.jsonl", "yard.pyr")
    assert done.returncode == 0
    assert "ends in the middle" in done.stderr
    assert "driven" in done.stdout


def test_what_is_no_record_says_so(command: str, folder: pathlib.Path) -> None:
    record(folder / "silent", {"/chatter": "std_msgs/msg/String"})
    record(folder / "old", {"/odom": ODOMETRY}, storage=StoragePlugin.SQLITE3)
    (folder / "empty").mkdir()
    (folder / "empty.jsonl").touch()
    step = '{"t": 1, "robot": "rover", "x": 0, "y": 0, "theta": 0}\n'
    (folder / "odd.jsonl").write_text(step + "{}\n" + step, encoding="utf-8")
    reasons = {
        "missing.mcap": "does not exist",
        "yard.pyr": "is not a record of a run",
        "empty": "is not a record of a run",
        "empty.jsonl": "nothing was recorded",
        "odd.jsonl": "line 2 of odd.jsonl is not a step of a trace: missing field `t`",
        "silent": "does not say where a robot was",
        "old": "`ros2 bag convert`",
    }
    for name, reason in reasons.items():
        assert reason in refuse(command, folder, "replay", name), name


def test_nothing_but_an_older_bag_is_replaced(
    command: str, folder: pathlib.Path
) -> None:
    record(folder / "lap", {"/rover/odom": ODOMETRY})
    theirs = next((folder / "lap").glob("*.mcap"))
    before = theirs.read_bytes()
    trace = ("--no-progress", "--trace", str(theirs))
    assert "is not a trace by PyDSLRep" in refuse(
        command, folder, "run", "yard.pyr", *trace
    )
    assert theirs.read_bytes() == before
    for _ in range(2):
        say(command, folder, "run", "yard.pyr", "--no-progress", "--trace", "run.mcap")
    assert not list(folder.glob("*.partial"))
