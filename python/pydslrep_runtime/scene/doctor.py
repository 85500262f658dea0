"""Connects to a simulator and checks its scene against a program."""

from collections.abc import Iterator, Sequence

from ..backend import RobotSpec
from ..errors import ReadingError, SimulatorError
from ..remote_api import Connection, RefusedError, accepts_connections
from .checks import check_robot, check_simulator
from .findings import Finding, finding
from .reader import SceneReader

LEGACY_PORT = 19999  # of the legacy remote API


class UnreachableError(Exception):
    """A simulator does not reply; the finding says why."""

    def __init__(self, why: Finding) -> None:
        super().__init__(why.message)
        self.finding = why


def examine(robots: Sequence[RobotSpec]) -> Iterator[Finding]:
    """All findings; raises UnreachableError, and SimulatorError if the connection is lost."""
    addresses: dict[tuple[str, int], list[RobotSpec]] = {}
    for spec in robots:
        addresses.setdefault((spec.host, spec.port), []).append(spec)
    for (host, port), specs in addresses.items():
        connection = connect(host, port)
        try:
            scene = SceneReader(connection)
            yield from check_simulator(scene)
            for spec in specs:
                yield from check_robot(scene, spec)
        finally:
            connection.close()


def connect(host: str, port: int) -> Connection:
    """Connects to a simulator; raises UnreachableError, and SimulatorError if it answers nonsense."""
    try:
        return Connection(host, port)
    except (ReadingError, RefusedError):
        raise  # somebody answers
    except SimulatorError as error:
        raise UnreachableError(_reason(host, port)) from error


def _reason(host: str, port: int) -> Finding:
    """Why a simulator does not reply."""
    address = f"{host}:{port}"
    if port == LEGACY_PORT:
        return finding("legacy-port", address=address)
    code = "no-reply" if accepts_connections(address) else "no-connection"
    return finding(code, address=address)
