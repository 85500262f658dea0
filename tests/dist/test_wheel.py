"""The wheel, in an empty environment: its commands and its package work without the repository."""

import os
import pathlib
import shutil
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).parents[2]
PROGRAM = (ROOT / "examples" / "square.pyr").read_text()


def run(
    command: list[str | pathlib.Path], folder: pathlib.Path, **environment: str
) -> str:
    """Runs a command and returns what it prints."""
    done = subprocess.run(
        command,
        cwd=folder,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """A wheel with the commands of the debug build, without what debuggers need."""
    folder = tmp_path_factory.mktemp("wheel")
    built = pathlib.Path(
        os.environ.get("PYDSLREP", ROOT / "target" / "debug" / "pydslrep")
    )
    server = pathlib.Path(
        os.environ.get("PYDSLREP_LSP", built.with_name("pydslrep-lsp"))
    )
    for binary, name in [(built, "pydslrep"), (server, "pydslrep-lsp")]:
        if strip := shutil.which("strip"):
            run([strip, "-o", folder / name, binary], folder)
        else:
            shutil.copy(binary, folder / name)
    run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder],
        ROOT,
        PYDSLREP_BINARIES=str(folder),
    )
    (wheel,) = folder.glob("*.whl")
    return wheel


@pytest.fixture(scope="module")
def programs(
    wheel: pathlib.Path, tmp_path_factory: pytest.TempPathFactory
) -> pathlib.Path:
    """The folder of programs of an environment with nothing but the wheel and what it asks for."""
    home = tmp_path_factory.mktemp("environment")
    run([sys.executable, "-m", "venv", home], home)
    programs = home / ("Scripts" if os.name == "nt" else "bin")
    run([programs / "pip", "install", "--quiet", f"{wheel}[coppeliasim]"], home)
    return programs


def test_a_run_uses_the_python_that_it_is_installed_in(
    programs: pathlib.Path, tmp_path: pathlib.Path
) -> None:
    (tmp_path / "square.pyr").write_text(PROGRAM)
    run([programs / "pydslrep", "check", "square.pyr"], tmp_path)
    result = run(
        [programs / "pydslrep", "run", "square.pyr", "--no-progress"],
        tmp_path,
        XDG_CACHE_HOME=str(tmp_path / "cache"),
    )
    assert "driven" in result
    assert not list((tmp_path / "cache" / "pydslrep").glob("venv-*"))


def test_scripts_need_no_folder_next_to_them(
    programs: pathlib.Path, tmp_path: pathlib.Path
) -> None:
    (tmp_path / "square.pyr").write_text(PROGRAM)
    path = os.pathsep.join([str(programs), os.environ["PATH"]])
    run([programs / "pydslrep", "build", "square.pyr"], tmp_path, PATH=path)
    assert (tmp_path / "yard.py").exists()
    assert not (tmp_path / "pydslrep_runtime").exists()
    assert "--robot" in run([programs / "python", "yard.py", "--help"], tmp_path)


def test_the_server_and_the_package_have_one_version(
    programs: pathlib.Path, tmp_path: pathlib.Path
) -> None:
    _, command = run([programs / "pydslrep", "--version"], tmp_path).split()
    _, server = run([programs / "pydslrep-lsp", "--version"], tmp_path).split()
    version = "import pydslrep_runtime as package; print(package.__version__)"
    package = run([programs / "python", "-c", version], tmp_path).strip()
    assert command == server == package


@pytest.mark.long
def test_the_source_distribution_builds_in_an_empty_environment(
    tmp_path: pathlib.Path,
) -> None:
    run(
        [sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", tmp_path],
        ROOT,
    )
    (source,) = tmp_path.glob("*.tar.gz")
    home = tmp_path / "environment"
    run([sys.executable, "-m", "venv", home], tmp_path)
    programs = home / ("Scripts" if os.name == "nt" else "bin")
    # Without the commands and builds of this repository.
    ours = ("PYDSLREP", "CARGO_TARGET_DIR")
    clean = {
        key: value for key, value in os.environ.items() if not key.startswith(ours)
    }
    pip = str(programs / "pip")
    subprocess.run([pip, "install", "--quiet", source], env=clean, check=True)
    for name in ("pydslrep", "pydslrep-lsp"):
        assert run([programs / name, "--version"], tmp_path).startswith(f"{name} ")
