"""What `pydslrep` can ask this package to do with a scene, by name.

A task gets the request and returns its answer, both as JSON. It raises RefusalError, SetupError or SimulatorError.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from ..answers import RefusalError
from ..backend import RobotSpec
from ..remote_api import Connection
from .checks import OLDEST
from .description import read_scene
from .doctor import UnreachableError, connect, examine
from .findings import finding
from .pull import pull
from .push import push
from .remove import remove

Request = Mapping[str, Any]
Answer = dict[str, Any]


def doctor(request: Request) -> Answer:
    """What is wrong with the scene of the robots of a program."""
    robots = [RobotSpec(**robot) for robot in request["robots"]]
    try:
        findings, reached = list(examine(robots)), True
    except UnreachableError as error:
        findings, reached = [error.finding], False
    return {"reached": reached, "findings": [each.as_json() for each in findings]}


@contextmanager
def _simulator(request: Request) -> Iterator[Connection]:
    """A connection to the simulator of a request, as long as it is needed."""
    try:
        connection = connect(request["host"], request["port"])
    except UnreachableError as error:
        raise RefusalError(error.finding.message, error.finding.help) from error
    try:
        sim = connection.sim
        version = connection.call(sim.getInt32Param, sim.intparam_program_version)
        if version < OLDEST:
            major, minor = divmod(version // 100, 100)
            old = finding("old-version", version=f"{major}.{minor}.{version % 100}")
            raise RefusalError(old.message, old.help)
        yield connection
    finally:
        connection.close()


def push_scene(request: Request) -> Answer:
    """Builds a scene."""
    scene = read_scene(request["scene"])
    with _simulator(request) as connection:
        return {"notes": push(connection, scene, replace=request["replace"])}


def pull_scene(request: Request) -> Answer:
    """Reads a scene, and what of it was not understood."""
    with _simulator(request) as connection:
        scene, unclear = pull(connection, request["environment"])
        return {"scene": scene.as_json(), "unclear": unclear}


def remove_scene(request: Request) -> Answer:
    """Takes away what was built."""
    with _simulator(request) as connection:
        removed, main_script = remove(connection, request["environment"])
        return {"removed": removed, "main_script": main_script}


TASKS: Mapping[str, Callable[[Request], Answer]] = {
    "doctor": doctor,
    "pull": pull_scene,
    "push": push_scene,
    "remove": remove_scene,
}
