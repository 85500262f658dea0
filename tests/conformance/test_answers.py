"""The embedded simulator answers as CoppeliaSim 4.6 does.

`answers.json` has what a CoppeliaSim 4.6.0 rev. 18 answered to one call after the other, in a scene that
`pydslrep scene push` had built: a two-wheel robot with a sensor, a crate and a floor. The same calls are made here, and
every answer is the same, or one of `DIFFERENT`.

A call is a function with its arguments: `sim.NAME` is a constant, `$NAME` an object of the scene, or what an earlier call
returned `as` that name. An answer is a value, `values` if there are several, an `error` with its number and its text,
`missing` where there is no such name, or a text that it `contains`. Objects are compared by their `paths`, because handles
count what a scene had before.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest
from coppeliasim_zmqremoteapi_client import (  # type: ignore[import-untyped]
    RemoteAPIClient,
)
from pydslrep_runtime.remote_api import Connection
from pydslrep_runtime.scene.description import read_scene
from pydslrep_runtime.scene.push import push

Row = dict[str, Any]

ANSWERS = Path(__file__).with_name("answers.json")
TOLERANCE = 2e-5  # the answers are rounded

WHEELS = [
    {"name": f"wheel{side}", "radius": 0.045, "x": 0.0, "y": y}
    for side, y in (("L", 0.15), ("R", -0.15))
]
# A narrow cone: sensors with a wide one look up.
SENSOR = {"name": "fSensor", "kind": "distance", "x": 0.15, "y": 0.0, "bearing": 0.0}
ROBOT = {
    **{"name": "robot_1", "type": "tw", "x": 0.0, "y": 0.0, "heading": 0.0},
    **{"length": 0.3, "width": 0.3, "grip": 1.0},
    **{"rim_speed": None, "rim_acceleration": 1.0, "wheels": WHEELS},
    "sensors": [{**SENSOR, "range": 1.0, "cone": math.radians(3.0)}],
}
CRATE = {"name": "crate", "x": 0.8, "y": 0.0, "heading": 0.0, "size": [0.4, 0.4]}
SCENE = {"environment": "apiarea", "robots": [ROBOT], "obstacles": [CRATE]}

# Why answers differ, by the call, with its number if it is made several times.
HISTORY = (
    "the time depends on the runs before, and on how long the simulation ran freely"
)
DIFFERENT = {
    "getObjectAlias $joint 6": "the number after the alias counts objects in a way that is not known",
    "getFloatProperty $sensor volume_range": "of 4.8; slam reads the range of sensors with it",
    "getFloatArrayProperty $sensor volume_angle": "of 4.8; slam reads the cone of sensors with it",
    "checkProximitySensor $sensor $crate": "handles count what a scene had before",
    "getSimulationTime": HISTORY,
    "readProximitySensor $sensor #2": "another program computed the distances of sensors there",
    "getJointVelocity $joint #2": "wheels at rest do not tremble here",
    "getSimulationTime #6": HISTORY,
}


def label(row: Row, seen: dict[str, int]) -> str:
    """The name of a call: its words, and its number from the second time on."""
    text = " ".join(
        part if isinstance(part, str) else json.dumps(part) for part in row["call"]
    )
    seen[text] = seen.get(text, 0) + 1
    return text if seen[text] == 1 else f"{text} #{seen[text]}"


class Caller:
    """Makes the calls of rows."""

    def __init__(self, sim: Any) -> None:
        self._sim = sim
        joint = sim.getObject("/robot_1/wheelL")
        self.names = {
            "body": sim.getObject("/robot_1"),
            "joint": joint,
            "wheel": sim.getObjectChild(joint, 0),
            "sensor": sim.getObject("/robot_1/fSensor"),
            "floor": sim.getObject("/floor"),
            "crate": sim.getObject("/crate"),
        }

    def value(self, argument: Any) -> Any:
        """What an argument stands for."""
        if isinstance(argument, list):
            return [self.value(each) for each in argument]
        if isinstance(argument, dict):
            return {key: self.value(each) for key, each in argument.items()}
        if isinstance(argument, str) and argument.startswith("$"):
            return self.names[argument[1:]]
        if isinstance(argument, str) and argument.startswith("sim."):
            return getattr(self._sim, argument[4:])
        return argument

    def answer(self, row: Row) -> Any:
        """The answer to a row's call, as rows have it."""
        name, *arguments = row["call"]
        try:
            if name == "constant":
                return getattr(self._sim, arguments[0])
            found = getattr(self._sim, name)(*map(self.value, arguments))
        except AttributeError:
            return {"missing": True}
        except Exception as error:  # the client has no error class of its own
            text = re.fullmatch(r"(\d+): in sim\._?(\w+): (.*)", str(error))
            if text is None or text[2] != name:
                return str(error)
            return {"error": [int(text[1]), text[3]]}
        if "as" in row:
            self.names[row["as"]] = found
            return None if isinstance(found, int) else found
        return self._plain(found, paths=row.get("paths", False))

    def _plain(self, found: Any, *, paths: bool) -> Any:
        if paths:
            handles = found if isinstance(found, list) else [found]
            aliases = [self._sim.getObjectAlias(handle, 2) for handle in handles]
            return aliases if isinstance(found, list) else aliases[0]
        if isinstance(found, tuple):
            return {"values": list(found)}
        if isinstance(found, dict):
            return {"map": found}
        if isinstance(found, bytes):
            return found.decode()
        return found


def same(found: Any, wanted: Any) -> bool:
    """Whether two answers are the same."""
    if isinstance(wanted, dict) and "contains" in wanted:
        return isinstance(found, str) and wanted["contains"] in found
    if isinstance(wanted, dict) and isinstance(found, dict):
        keys = wanted.keys() | found.keys()
        return all(same(found.get(key), wanted.get(key)) for key in keys)
    if isinstance(wanted, list) and isinstance(found, list):
        is_as_long = len(found) == len(wanted)
        return is_as_long and all(map(same, found, wanted))
    if isinstance(wanted, bool) or isinstance(found, bool):
        return found is wanted
    if isinstance(wanted, int | float) and isinstance(found, int | float):
        return abs(found - wanted) <= TOLERANCE * max(1.0, abs(wanted))
    return bool(found == wanted)


@pytest.fixture
def sim(port: int) -> Any:
    """The functions of the simulator, whose scene is that of the answers."""
    connection = Connection("127.0.0.1", port)
    push(connection, read_scene(SCENE), replace=False)
    connection.close()
    remote = RemoteAPIClient("127.0.0.1", port)
    yield remote.require("sim")
    remote.socket.close(linger=0)
    remote.context.term()


def test_the_embedded_simulator_answers_as_coppeliasim(sim: Any) -> None:
    caller, seen = Caller(sim), dict[str, int]()
    rows: list[Row] = json.loads(ANSWERS.read_text(encoding="utf-8"))
    assert len(rows) >= 351
    different = {}
    for row in rows:
        found, wanted = caller.answer(row), caller.value(row["answer"])
        name = label(row, seen)
        if not same(found, wanted):
            different[name] = f"is {found!r}, in CoppeliaSim {wanted!r}"
    unknown = {name: how for name, how in different.items() if name not in DIFFERENT}
    assert unknown == {}
    assert DIFFERENT.keys() - different.keys() == set(), "these are the same now"
