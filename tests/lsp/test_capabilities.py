"""Every announced capability works: `exercises` has a function for each.

The client library acts as an editor would; the capabilities are read from the result of `initialize`.
"""

from __future__ import annotations

import pathlib
from collections.abc import AsyncIterator
from typing import Any

import pytest
import pytest_lsp
from editor import capabilities, tell_actions_from_commands
from exercises import CONVERTER, EXERCISES, Session
from lsprotocol import types
from pytest_lsp import ClientServerConfig, LanguageClient
from questions import PROGRAM
from raw import SERVER


def names_of(value: Any, path: str = "") -> set[str]:
    """Capabilities by name: enabled ones, each element of a list, and the name of any other value."""
    if value is None or value is False:
        return set()
    if path.startswith(("semanticTokensProvider.legend.", "workspace.fileOperations.")):
        return {path}
    if isinstance(value, dict) and value:
        parts = [names_of(v, f"{path}.{k}".strip(".")) for k, v in value.items()]
        return set().union(*parts)
    if isinstance(value, list):
        return {f"{path}[{item}]" for item in value}
    if path.endswith("TriggerCharacter"):
        return {f"{path}[{value}]"}
    return {path}


@pytest_lsp.fixture(config=ClientServerConfig(server_command=[SERVER, "--stdio"]))  # type: ignore[untyped-decorator]
async def newcomer(lsp_client: LanguageClient) -> AsyncIterator[None]:
    """A client that has sent nothing yet."""
    tell_actions_from_commands(lsp_client)
    yield
    await lsp_client.shutdown_session()


@pytest.mark.asyncio
async def test_capabilities_match_the_contract_and_work(
    newcomer: LanguageClient, tmp_path: pathlib.Path
) -> None:
    hello = types.InitializeParams(capabilities=capabilities("pulling"))
    result = await newcomer.initialize_session(hello)
    session = Session(newcomer, result.capabilities, tmp_path)
    announced = names_of(CONVERTER.unstructure(session.announced))
    assert sorted(announced - EXERCISES.keys()) == [], "announced, but not exercised"
    assert sorted(EXERCISES.keys() - announced) == [], "exercised, but not announced"
    for exercise in dict.fromkeys(EXERCISES.values()):
        session.show(PROGRAM)
        await exercise(session)
