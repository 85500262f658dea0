"""The action slam, with the simulator's poses or by odometry."""

import importlib
from typing import TYPE_CHECKING

from .. import events
from .explorer import UnboundedAreaError
from .robot import SlamRobot
from .session import SlamSession
from .topological_map import TopologicalMap

if TYPE_CHECKING:
    from ..motion import Motion


async def explore(robot: "Motion", session: SlamSession) -> None:
    """Explores with a robot and adds its map to the session.

    The sensors must have readings, so one step of time must have passed. Raises
    MovementError if the robot is blocked or the area seems to be unbounded, and SetupError
    if the map cannot be written.
    """
    session.check_outputs()
    explorer = make_slam_robot(robot, session).explorer()
    explorer.on_node = lambda: _report(robot, explorer.map)
    try:
        await explorer.explore()
    except UnboundedAreaError as error:
        raise robot.failure(error) from error
    else:
        if not any(explorer.map.edges()):
            raise robot.failure(_reason_for_nothing(robot))
    finally:
        session.add_map(robot.name, explorer.map)
        warn_of_uncertain_nodes(robot.name, explorer.map)


def _report(robot: "Motion", found: TopologicalMap) -> None:
    """Tells how far the map has grown."""
    exits = (frontier for node in found.nodes for frontier in node.frontiers)
    unexplored = sum(frontier.target is None for frontier in exits)
    text = f"slam: {len(found.nodes)} nodes, {unexplored} exits to explore"
    events.current.progress(robot.backend.clock.time, robot.name, text)


def _reason_for_nothing(robot: "Motion") -> str:
    """Why a robot may have found no way from where it started."""
    readings = (robot.backend.distance(sensor) for sensor in robot.spec.sensors)
    seen = [distance for distance in readings if distance is not None]
    reason = "it has explored nothing: it saw no way from where it started"
    if seen:
        reason += f". Its sensors see something {min(seen):.2f} m away: if that is the floor, `pydslrep doctor` says what to do"
    return reason


def warn_of_uncertain_nodes(robot: str, found: TopologicalMap) -> None:
    """Tells which nodes may be somewhere else."""
    uncertain = [str(node.number) for node in found.nodes if node.is_uncertain]
    if uncertain:
        events.current.warning(
            f"robot {robot} lost its way and did not find it again: in its map, "
            f"the positions of these nodes are uncertain: {', '.join(uncertain)}"
        )


def make_slam_robot(robot: "Motion", session: SlamSession) -> SlamRobot:
    """A robot as the explorer uses it."""
    if not session.uses_odometry:
        return SlamRobot(robot, session)
    # By name and only here: neither a script nor a type checker that reads it needs numpy and
    # scipy for anything else.
    odometry = importlib.import_module(".odometry.robot", __package__)
    slam_robot: SlamRobot = odometry.OdometrySlamRobot(robot, session)
    return slam_robot
