"""The check of the package index, which saves minutes of retries by pip."""

from __future__ import annotations

import http.server
import os
import pathlib
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator

import pytest

ASK = pathlib.Path(__file__).parents[2] / "crates/cli/python/ask_index.py"
ABSENT = 3


@pytest.fixture(name="home")
def fixture_home(tmp_path: pathlib.Path) -> pathlib.Path:
    """A home folder without pip's settings."""
    return tmp_path


def ask(home: pathlib.Path, **settings: str) -> tuple[int, str]:
    """The exit code and output with such an environment."""
    kept = {
        name: os.environ[name] for name in ("PATH", "SYSTEMROOT") if name in os.environ
    }
    environment = kept | {
        "HOME": str(home),
        "NO_PROXY": "*",
        "PIP_CONFIG_FILE": os.devnull,
    }
    done = subprocess.run(
        [sys.executable, "-I", str(ASK)],
        env=environment | settings,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stderr == ""
    return done.returncode, done.stdout


class Quiet(http.server.BaseHTTPRequestHandler):
    """An index without packages."""

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002
        """Logs nothing."""


@pytest.fixture(name="answering")
def fixture_answering() -> Iterator[str]:
    """The address of an index that replies."""
    with http.server.HTTPServer(("127.0.0.1", 0), Quiet) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}/simple"
        server.shutdown()
        thread.join()


@pytest.fixture(name="silent")
def fixture_silent() -> Iterator[int]:
    """The port of an index that accepts connections but never replies."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server.getsockname()[1]


@pytest.fixture(name="closed")
def fixture_closed() -> int:
    """A port without a server."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        port: int = server.getsockname()[1]
    return port


def test_an_index_that_answers_is_there(home: pathlib.Path, answering: str) -> None:
    assert ask(home, PIP_INDEX_URL=answering) == (0, "")


@pytest.mark.parametrize("scheme", ["http", "https"])
def test_one_that_never_answers_is_not(
    home: pathlib.Path, silent: int, scheme: str
) -> None:
    received = ask(home, PIP_INDEX_URL=f"{scheme}://127.0.0.1:{silent}/simple")
    assert received == (ABSENT, "127.0.0.1 cannot be reached: no reply for 2 s\n")


def test_one_that_nobody_serves_is_not(home: pathlib.Path, closed: int) -> None:
    received = ask(home, PIP_INDEX_URL=f"https://user:secret@127.0.0.1:{closed}/simple")
    assert received == (ABSENT, "127.0.0.1 cannot be reached: Connection refused\n")


def test_nor_is_one_without_a_place(home: pathlib.Path) -> None:
    code, received = ask(home, PIP_INDEX_URL="https://index.invalid/simple")
    assert code == ABSENT
    assert received.startswith("index.invalid cannot be reached: ")


def test_files_of_pip_count(home: pathlib.Path, answering: str, closed: int) -> None:
    file = home / "pip.conf"
    file.write_text(f"[global]\nindex-url = {answering}\n", encoding="utf-8")
    assert ask(home, PIP_CONFIG_FILE=str(file)) == (0, "")
    away = f"http://127.0.0.1:{closed}/simple"
    assert ask(home, PIP_CONFIG_FILE=str(file), PIP_INDEX_URL=away)[0] == ABSENT


def test_a_proxy_is_asked_in_its_place(home: pathlib.Path, closed: int) -> None:
    proxy = f"http://127.0.0.1:{closed}"
    received = ask(
        home, NO_PROXY="", HTTPS_PROXY=proxy, PIP_INDEX_URL="https://index.invalid"
    )
    reason = (
        "index.invalid cannot be reached by the proxy 127.0.0.1: Connection refused\n"
    )
    assert received == (ABSENT, reason)


def test_packages_from_elsewhere_need_no_index(home: pathlib.Path, closed: int) -> None:
    away = f"http://127.0.0.1:{closed}/simple"
    wheels = home / "wheels"
    wheels.mkdir()
    assert ask(home, PIP_INDEX_URL=away, PIP_FIND_LINKS=str(wheels))[0] == ABSENT
    (wheels / "coppeliasim_zmqremoteapi_client-2.0.4-py3-none-any.whl").touch()
    assert ask(home, PIP_INDEX_URL=away, PIP_FIND_LINKS=str(wheels)) == (0, "")
    assert ask(home, PIP_INDEX_URL=away, PIP_NO_INDEX="1") == (0, "")
