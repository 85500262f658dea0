"""The Python of `run`: one that has the client, or a private environment, made again if it is damaged."""

import os
import pathlib
import subprocess
import sys
from collections.abc import Callable

import pytest

ROOT = pathlib.Path(__file__).parents[2]
TABLE_2 = ROOT / "tests" / "paper" / "table2_two_wheels.pyr"
PREPARING = "preparing Python for the first run"


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """A folder for caches, with what an interrupted first run has left."""
    home = tmp_path_factory.mktemp("cache")
    (home / "pydslrep" / "venv-new-interrupted" / "lib").mkdir(parents=True)
    return home


@pytest.fixture
def run(command: str, home: pathlib.Path, tmp_path: pathlib.Path) -> Callable[[], str]:
    """Runs a program and returns what it says on standard error."""

    def run() -> str:
        done = subprocess.run(
            [command, "run", TABLE_2],
            cwd=tmp_path,
            env={**os.environ, "XDG_CACHE_HOME": str(home)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return done.stderr

    return run


def test_a_damaged_environment_is_named_and_made_again(
    run: Callable[[], str], home: pathlib.Path
) -> None:
    cache = home / "pydslrep"
    assert PREPARING in run()
    assert not list(cache.glob("venv-new-*")), "interrupted runs leave nothing"
    assert PREPARING not in run()

    (environment,) = cache.glob("venv-*")
    (client,) = environment.glob("**/coppeliasim_zmqremoteapi_client/__init__.py")
    client.write_bytes(client.read_bytes()[:100])
    said = run()
    assert f"the Python environment in {environment} is damaged: " in said
    assert f"{client.relative_to(environment).as_posix()} has changed" in said
    assert PREPARING in said
    assert PREPARING not in run()


def test_a_python_that_has_the_client_is_used_as_it_is(
    command: str, tmp_path: pathlib.Path
) -> None:
    done = subprocess.run(
        [command, "run", TABLE_2, "--python", sys.executable],
        cwd=tmp_path,
        env={**os.environ, "XDG_CACHE_HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert PREPARING not in done.stderr
    assert not list((tmp_path / "pydslrep").glob("venv-*"))
