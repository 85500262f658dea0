"""What a run writes, and what it leaves alone."""

import argparse
import copy
import functools
import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from pydslrep_runtime.errors import SetupError
from pydslrep_runtime.outputs import (
    PICTURE_MARK,
    PNG,
    growing_trace,
    is_map,
    is_picture,
    is_trace,
    output_path,
    write_whole,
)
from pydslrep_runtime.slam.session import SlamSession, add_slam_options
from pydslrep_runtime.slam.topological_map import TopologicalMap

ROW = json.dumps({"t": 0.05, "robot": "r", "x": 0, "y": 0, "theta": 0}) + "\n"
MAP = json.dumps({"environment": "e", "nodes": [], "edges": []})
PROGRAM = "wheel a with radius 4\n"


def test_a_file_is_recognised_by_its_content(tmp_path: Path) -> None:
    file = tmp_path / "file"
    contents = {
        is_trace: ROW.encode() * 2,
        is_map: MAP.encode(),
        is_picture: PNG + b"\0\0tEXtComment\0" + PICTURE_MARK.encode(),
    }
    for own, content in contents.items():
        file.write_bytes(content)
        assert [check for check in contents if check(file)] == [own]
        assert output_path(file, own, "it") == file
    for strange in (PROGRAM.encode(), b"[]", b"\xff", PNG):
        file.write_bytes(strange)
        for check in contents:
            with pytest.raises(SetupError, match="file exists and is not it; choose"):
                output_path(file, check, "it")


def test_an_empty_or_missing_file_may_be_written(tmp_path: Path) -> None:
    file = tmp_path / "file"
    assert output_path(file, is_trace, "a trace") == file
    file.touch()
    assert output_path(file, is_trace, "a trace") == file


def test_links_are_followed_only_in_their_folder(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    link = tmp_path / "in" / "link"
    for target in (tmp_path / "file", Path("/dev/null"), tmp_path / "in" / "gone"):
        if target.parent == tmp_path:
            target.touch()
        link.symlink_to(target)
        with pytest.raises(SetupError, match="is a link to"):
            output_path(link, is_trace, "a trace")
        link.unlink()
    (tmp_path / "in" / "file").touch()
    link.symlink_to("file")
    assert output_path(link, is_trace, "a trace") == tmp_path / "in" / "file"


def test_a_trace_has_its_name_in_the_end(tmp_path: Path) -> None:
    file, partial = tmp_path / "a.jsonl", tmp_path / "a.jsonl.partial"
    file.write_text(ROW, encoding="utf-8")

    def drive() -> None:
        with growing_trace(file) as trace:
            trace.write(ROW * 2)
            assert file.read_text(encoding="utf-8") == ROW
            assert partial.read_text(encoding="utf-8") == ROW * 2
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        drive()
    assert file.read_text(encoding="utf-8") == ROW * 2
    assert not partial.exists()


def test_a_failed_write_changes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "file"
    write_whole(file, b"old")

    def fail(_: int) -> None:
        raise OSError(28, "no space left on device")

    monkeypatch.setattr("pydslrep_runtime.outputs.os.fsync", fail)
    with pytest.raises(OSError, match="no space"):
        write_whole(file, b"new")
    assert file.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [file]


def test_maps_replace_maps_only(tmp_path: Path) -> None:
    parser = argparse.ArgumentParser()
    add_slam_options(parser, "yard")
    file = tmp_path / "yard_map.json"
    session = SlamSession("yard", parser.parse_args(["--map", str(file)]))
    for _ in range(2):
        session.check_outputs()
        session.add_map("r", TopologicalMap())
    assert json.loads(file.read_text(encoding="utf-8"))["environment"] == "yard"
    file.write_text('{"mine": 1}', encoding="utf-8")
    for write in (
        session.check_outputs,
        lambda: session.add_map("r", TopologicalMap()),
    ):
        with pytest.raises(SetupError, match="is not a map"):
            write()
    assert file.read_text(encoding="utf-8") == '{"mine": 1}'


def test_a_trace_has_one_writer(tmp_path: Path) -> None:
    path = tmp_path / "driven.jsonl"
    with growing_trace(path) as first:
        first.write(ROW)
        with (
            pytest.raises(SetupError, match="another process is writing it"),
            growing_trace(path),
        ):
            pass
        first.write(ROW)
    assert path.read_text(encoding="utf-8") == ROW * 2
    with growing_trace(path) as second:
        second.write(ROW)
    assert path.read_text(encoding="utf-8") == ROW
    assert list(tmp_path.iterdir()) == [path]


def test_a_run_that_drives_nothing_keeps_an_older_trace(tmp_path: Path) -> None:
    path = tmp_path / "driven.jsonl"
    path.write_text(ROW, encoding="utf-8")
    with pytest.raises(SetupError, match="no reply"), growing_trace(path):
        raise SetupError("no reply")
    assert path.read_text(encoding="utf-8") == ROW
    assert list(tmp_path.iterdir()) == [path]


def test_the_maps_of_two_robots_are_one_map(tmp_path: Path) -> None:
    """The nodes of the second have other numbers than those of the first, and so have its ways."""
    parser = argparse.ArgumentParser()
    add_slam_options(parser, "yard")
    file = tmp_path / "yard_map.json"
    slam = SlamSession("yard", parser.parse_args(["--map", str(file)]))
    ways = [{"bearing": 0.0, "to": 1}, {"bearing": 90.0, "to": None}]
    nodes = [
        {"id": 0, "x": 0.0, "y": 0.0, "exits": ways},
        {"id": 1, "x": 1.0, "y": 0.0, "exits": []},
    ]
    for robot in ("one", "two"):
        data = {
            "nodes": copy.deepcopy(nodes),
            "edges": [{"from": 0, "to": 1, "length": 1.0}],
        }
        found: Any = SimpleNamespace(as_json=functools.partial(copy.deepcopy, data))
        slam.add_map(robot, found)
    written = json.loads(file.read_text(encoding="utf-8"))
    assert [(n["id"], n["robot"]) for n in written["nodes"]] == [
        (0, "one"),
        (1, "one"),
        (2, "two"),
        (3, "two"),
    ]
    assert [(e["from"], e["to"]) for e in written["edges"]] == [(0, 1), (2, 3)]
    assert [way["to"] for way in written["nodes"][2]["exits"]] == [3, None]
