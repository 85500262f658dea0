"""The main script of a scene: without one, a simulation does nothing."""

from ..remote_api import Connection

# What a new scene has, with a mark: a script is no object, and versions before 4.7 keep no other data with it.
TEXT = """--lua
-- Added by PyDSLRep; `pydslrep scene remove` removes it.
require('defaultMainScript')
"""


def add_main_script(connection: Connection) -> int | None:
    """Adds a main script to a scene without one; returns its handle, or None if there is one."""
    sim, call = connection.sim, connection.call
    if call(sim.getScript, sim.scripttype_mainscript) >= 0:
        return None
    script: int = call(sim.addScript, sim.scripttype_mainscript)
    try:
        call(sim.setScriptStringParam, script, sim.scriptstringparam_text, TEXT)
    except BaseException:
        undo_main_script(connection, script)
        raise
    return script


def undo_main_script(connection: Connection, script: int) -> None:
    """Removes a main script that was just added, even after an error."""
    connection.last_call("sim.removeScript", script)


def remove_main_script(connection: Connection) -> bool:
    """Removes the main script that was added here, unless somebody has changed it; returns whether it did."""
    sim, call = connection.sim, connection.call
    script = call(sim.getScript, sim.scripttype_mainscript)
    if script < 0:
        return False
    text = call(sim.getScriptStringParam, script, sim.scriptstringparam_text)
    if text != TEXT:
        return False
    call(sim.removeScript, script)
    return True
