"""The paths of the programs under test, and a client that acts like an editor."""

from __future__ import annotations

import pathlib
from collections.abc import AsyncIterator

import pytest
import pytest_lsp
from editor import capabilities, tell_actions_from_commands
from lsprotocol import types
from pytest_lsp import ClientServerConfig, LanguageClient
from raw import SERVER

ROOT = pathlib.Path(__file__).parents[2]


@pytest.fixture
def server() -> str:
    """The path of the language server."""
    return SERVER


@pytest.fixture
def table_2() -> str:
    """The article's first program on CoppeliaSim's port, without any problem."""
    path = ROOT / "tests" / "paper" / "table2_two_wheels.pyr"
    return path.read_text(encoding="utf-8").replace("19999", "23000")


@pytest_lsp.fixture(config=ClientServerConfig(server_command=[SERVER, "--stdio"]))  # type: ignore[untyped-decorator]
async def client(
    lsp_client: LanguageClient, request: pytest.FixtureRequest
) -> AsyncIterator[LanguageClient]:
    """A client in a session; tests may parametrise it by the name of an editor in `editor.py`."""
    tell_actions_from_commands(lsp_client)
    wanted = capabilities(getattr(request, "param", "complete"))
    await lsp_client.initialize_session(types.InitializeParams(capabilities=wanted))
    yield lsp_client
    await lsp_client.shutdown_session()
