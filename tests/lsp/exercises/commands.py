"""The server's commands."""

from __future__ import annotations

from typing import Any

import pytest
from editor import to_path
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from questions import PROGRAM

from .session import CONVERTER, Session, exercises


async def execute(s: Session, command: str, argument: dict[str, str]) -> Any:
    params = types.ExecuteCommandParams(command, [{"uri": s.uri, **argument}])
    return await s.client.workspace_execute_command_async(params)


@exercises("executeCommandProvider.commands[pydslrep.generateScript]")
async def scripts_are_written(s: Session) -> None:
    await execute(s, "pydslrep.generateScript", {"environment": "yard"})
    script = (s.folder / "yard.py").read_text(encoding="utf-8")
    compile(script, "yard.py", "exec")
    assert "rover" in script
    (s.folder / "yard.py").unlink()


@exercises("executeCommandProvider.commands[pydslrep.writeRuntime]")
async def what_scripts_import_is_written(s: Session) -> None:
    await execute(s, "pydslrep.writeRuntime", {"environment": "yard"})
    assert (s.folder / "pydslrep_runtime" / "__init__.py").is_file()


@exercises("executeCommandProvider.commands[pydslrep.showKinematics]")
async def kinematics_are_shown(s: Session) -> None:
    shown = await execute(s, "pydslrep.showKinematics", {"robot": "rover"})
    assert "right = (v + ω d/2) / r" in shown


@exercises("executeCommandProvider.commands[pydslrep.previewPath]")
async def paths_are_drawn(s: Session) -> None:
    s.show(PROGRAM.replace("wheeel", "a"))
    done = CONVERTER.unstructure(
        await execute(s, "pydslrep.previewPath", {"environment": "yard"})
    )
    picture = to_path(done["picture"] if isinstance(done, dict) else done.picture)
    assert "<svg" in picture.read_text(encoding="utf-8")
    picture.unlink()


@exercises(
    "executeCommandProvider.commands[pydslrep.run]",
    "executeCommandProvider.commands[pydslrep.pushScene]",
    "executeCommandProvider.commands[pydslrep.checkScene]",
    "executeCommandProvider.commands[pydslrep.removeScene]",
)
async def runs_of_what_has_errors_are_refused(s: Session) -> None:
    """Runs are in `test_runs.py`, scenes in `test_scene_commands.py`: they need a replacement for `pydslrep`, or a simulator."""
    s.show(PROGRAM.replace("{ a b }", "{ a c }"))
    for command in ("run", "pushScene", "checkScene", "removeScene"):
        with pytest.raises(JsonRpcException, match="`yard` has errors"):
            await execute(s, f"pydslrep.{command}", {"environment": "yard"})


@exercises("executeCommandProvider.commands[pydslrep.openPreview]")
async def the_live_preview_is_opened(s: Session) -> None:
    s.show(PROGRAM)
    done = CONVERTER.unstructure(await execute(s, "pydslrep.openPreview", {}))
    address = done["address"] if isinstance(done, dict) else done.address
    assert address.startswith("http://127.0.0.1:")
