"""Builds the scene of a program in a running simulator."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace as changed

from ..answers import RefusalError
from ..remote_api import Connection
from .checks import check_steps
from .description import ObstacleDescription, RobotDescription, SceneDescription
from .main_script import add_main_script, undo_main_script
from .maker import Maker
from .marks import Marks
from .object_names import alias_of, named_as_objects
from .obstacles import FLOOR, build_floor, build_obstacle
from .reader import SceneReader
from .robot_parts import build_robot

BUILT_ALREADY = "built-already"  # the reason of a refusal without `replace`
MAX_LISTED = 10  # objects in a message


def push(
    connection: Connection, scene: SceneDescription, *, replace: bool
) -> list[str]:
    """Builds a scene; returns what is worth knowing. Raises SimulatorError and RefusalError.

    Objects that were not made here are never changed. If anything goes wrong, what was made is removed again, and with
    `replace`, what an earlier call made stays.
    """
    marks = Marks(connection)
    scene = changed(scene, robots=tuple(map(named_as_objects, scene.robots)))
    aliases = obstacle_aliases(scene)
    _check_names(scene.robots)
    _check_stopped(connection)
    earlier = dict(marks.all())
    if earlier and not replace:
        environment = next(iter(earlier.values())).get("environment")
        raise RefusalError(
            f"the scene has objects already that were built for environment `{environment}`",
            "use --replace to build them again, or `pydslrep scene remove` to take them away",
            BUILT_ALREADY,
        )
    wanted = {FLOOR, *aliases, *(robot.name for robot in scene.robots)}
    _check_free(connection, marks, wanted, earlier)
    # Before anything is made: what is asked may fail.
    steps = list(check_steps(SceneReader(connection)))
    maker, notes = Maker(connection, marks, scene.environment), []
    script = None
    try:
        build_floor(maker, scene)
        for alias, obstacle in zip(aliases, scene.obstacles, strict=True):
            build_obstacle(maker, obstacle, alias)
        for robot in scene.robots:
            notes += build_robot(maker, robot)
        script = add_main_script(connection)
        # At last: nothing brings them back.
        if earlier:
            connection.call(connection.sim.removeObjects, list(earlier))
    except BaseException:
        maker.undo()
        if script is not None:
            undo_main_script(connection, script)
        raise
    if script is not None:
        notes.append("the scene had no main script, and has CoppeliaSim's own now")
    notes += [standstill(each) for each in scene.obstacles if each.moves]
    return notes + [f"{each.message}: {each.help}" for each in steps]


def standstill(obstacle: ObstacleDescription) -> str:
    """What is worth knowing of an obstacle that moves in the embedded simulator."""
    return (
        f"obstacle `{obstacle.name}` has a path, but does not move here: it stays at its first point, "
        f"x {obstacle.x:g} m, y {obstacle.y:g} m"
    )


def obstacle_aliases(scene: SceneDescription) -> Sequence[str]:
    """The aliases of the obstacles: unique, so that each can be found by its path."""
    taken = Counter(robot.name for robot in scene.robots)
    taken[FLOOR] += 1
    aliases = []
    for obstacle in scene.obstacles:
        alias, number = alias_of(obstacle.name), 2
        while alias in taken:
            alias = f"{alias_of(obstacle.name)}_{number}"
            number += 1
        taken[alias] += 1
        aliases.append(alias)
    return aliases


def _check_names(robots: Sequence[RobotDescription]) -> None:
    """Scripts find robots and their parts by their names."""
    for robot in robots:
        if robot.name == FLOOR:
            raise RefusalError(
                f"a robot cannot be called `{FLOOR}`: that is what it stands on"
            )


def _check_stopped(connection: Connection) -> None:
    sim = connection.sim
    if connection.call(sim.getSimulationState) != sim.simulation_stopped:
        raise RefusalError(
            "the simulation is running; what is built now would be reset when it ends",
            "choose [Simulation > Stop simulation] first",
        )


def _check_free(
    connection: Connection,
    marks: Marks,
    wanted: set[str],
    earlier: Mapping[int, object],
) -> None:
    """Raises RefusalError if somebody else's objects have the names."""
    sim, call = connection.sim, connection.call
    found = []
    for handle in marks.objects():
        if handle in earlier or call(sim.getObjectParent, handle) >= 0:
            continue
        alias = call(sim.getObjectAlias, handle, -1)
        if alias in wanted:
            found.append(f"/{alias}")
    if found:
        listed = ", ".join(found[:MAX_LISTED])
        if len(found) > MAX_LISTED:
            listed += f" and {len(found) - MAX_LISTED} more"
        raise RefusalError(
            f"the scene has objects of the same names already: {listed}",
            "rename or remove them: `scene push` never changes what it has not made",
        )
