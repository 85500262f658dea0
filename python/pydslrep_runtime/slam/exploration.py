"""The action slam, with the simulator's poses or by odometry."""

import importlib
import sys
from typing import TYPE_CHECKING

from .explorer import UnboundedAreaError
from .rover import SlamRover
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
    explorer = make_rover(robot, session).explorer()
    try:
        await explorer.explore()
    except UnboundedAreaError as error:
        raise robot.failure(error) from error
    finally:
        session.add_map(robot.name, explorer.map)
        warn_of_uncertain_nodes(robot.name, explorer.map)


def warn_of_uncertain_nodes(robot: str, found: TopologicalMap) -> None:
    """Tells which nodes may be somewhere else."""
    uncertain = [str(node.number) for node in found.nodes if node.is_uncertain]
    if uncertain:
        print(
            f"warning: robot {robot} lost its way and did not find it again: in its map, "
            f"the positions of these nodes are uncertain: {', '.join(uncertain)}",
            file=sys.stderr,
        )


def make_rover(robot: "Motion", session: SlamSession) -> SlamRover:
    """A robot as the explorer uses it."""
    if not session.uses_odometry:
        return SlamRover(robot, session)
    # By name and only here: neither a script nor a type checker that reads it needs numpy and
    # scipy for anything else.
    odometry = importlib.import_module(".odometry.rover", __package__)
    rover: SlamRover = odometry.OdometryRover(robot, session)
    return rover
