"""Takes away what `push` has made."""

from ..remote_api import Connection
from .main_script import remove_main_script
from .marks import Marks


def remove(connection: Connection, environment: str | None) -> tuple[int, bool]:
    """Removes what was made, or only what was made for one environment.

    Returns the number of objects, and whether the main script was removed with the last of them.
    """
    marked = list(Marks(connection).all())
    made = [
        handle
        for handle, mark in marked
        if environment in (None, mark.get("environment"))
    ]
    if made:
        connection.call(connection.sim.removeObjects, made)
    is_last = len(made) == len(marked)
    return len(made), is_last and remove_main_script(connection)
