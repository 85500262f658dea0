"""A release: its commands in every package, and the tutorial in an empty environment without the repository."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from artefacts import FOLDER, PLATFORMS, Platform, contents, one
from pages import ROOT, Block, Session, blocks, comparable
from raw import RawServer, notification, request

if "PYDSLREP_DIST" not in os.environ:
    pytest.skip("PYDSLREP_DIST names no release", allow_module_level=True)

import lief

LIMIT = 14_000_000
"""Bytes of the command `pydslrep`."""
HERE = PLATFORMS[0]
THERE = [platform for platform in PLATFORMS if platform.is_there()]
SHARED = {
    "bash-completion/completions/pydslrep",
    "elvish/lib/pydslrep.elv",
    "fish/vendor_completions.d/pydslrep.fish",
    "man/man1/pydslrep-run.1",
    "man/man1/pydslrep.1",
    "pydslrep/pydslrep.ps1",
    "zsh/site-functions/_pydslrep",
}

of_each_platform = pytest.mark.parametrize(
    "platform", THERE, ids=lambda platform: platform.target
)
here = pytest.mark.skipif(HERE not in THERE, reason="made for other platforms")


def command(files: dict[str, bytes], platform: Platform) -> bytes:
    """The command `pydslrep` among the files of a package."""
    named = [name for name in files if Path(name).name == platform.commands[0]]
    # The completion of bash has the same name.
    (path,) = [name for name in named if "/share/" not in name]
    return files[path]


def check_linux(binary: Any, machine: Any) -> None:
    assert isinstance(binary, lief.ELF.Binary)
    assert binary.header.machine_type == machine
    assert not binary.has_interpreter, "it is not static"


def check_windows(binary: Any) -> None:
    assert isinstance(binary, lief.PE.Binary)
    assert binary.header.machine == lief.PE.Header.MACHINE_TYPES.AMD64
    # What every Windows 10 has: none of the compiler's own libraries.
    libraries = {str(library.name).lower() for library in binary.imports}
    assert not [name for name in libraries if name.startswith("lib")], libraries


def check_macos(binary: Any, machine: Any) -> None:
    assert isinstance(binary, lief.MachO.Binary)
    assert binary.header.cpu_type == machine
    assert binary.build_version is not None
    assert binary.build_version.minos[:2] == [11, 0]
    libraries = {str(library.name) for library in binary.libraries}
    assert all(re.match(r"/(usr/lib|System/Library)/", name) for name in libraries)
    # Processors of Apple start signed programs only; the signature names nobody.
    assert binary.has_code_signature or machine != lief.MachO.Header.CPU_TYPE.ARM64


def check_binary(data: bytes, platform: Platform) -> None:
    """That a program is for a platform, and needs nothing but the system."""
    binary = lief.parse(list(data))
    if platform.is_windows:
        check_windows(binary)
    elif "linux" in platform.target:
        arm, intel = lief.ELF.ARCH.AARCH64, lief.ELF.ARCH.X86_64
        check_linux(binary, arm if "aarch64" in platform.target else intel)
    else:
        cpu = lief.MachO.Header.CPU_TYPE
        check_macos(binary, cpu.ARM64 if "aarch64" in platform.target else cpu.X86_64)


@of_each_platform
def test_an_archive_has_the_commands_of_its_platform(platform: Platform) -> None:
    files = contents(platform.archive())
    folder = platform.archive().name.removesuffix(".zip").removesuffix(".tar.gz")
    for name in platform.commands:
        check_binary(files[f"{folder}/{name}"], platform)
    assert {f"{folder}/share/{name}" for name in SHARED} <= files.keys()
    assert {f"{folder}/{name}" for name in ("LICENSE", "README.md")} <= files.keys()


@of_each_platform
def test_a_wheel_has_the_same_commands(platform: Platform) -> None:
    files = contents(platform.package())
    original = contents(platform.archive())
    folder = next(name for name in files if ".data/" in name).partition("/")[0]
    assert command(files, platform) == command(original, platform)
    for name in platform.commands:
        assert f"{folder}/scripts/{name}" in files
    assert {f"{folder}/data/share/{name}" for name in SHARED} <= files.keys()
    assert "pydslrep_runtime/py.typed" in files


@of_each_platform
def test_an_extension_has_the_same_command(platform: Platform) -> None:
    files = contents(platform.extension())
    assert command(files, platform) == command(contents(platform.archive()), platform)
    assert f'TargetPlatform="{platform.vscode}"' in manifest(files)
    assert not [name for name in files if "pydslrep-lsp" in name], "it is in pydslrep"


def manifest(files: dict[str, bytes]) -> str:
    """What galleries read of an extension."""
    return files["extension.vsixmanifest"].decode()


def test_the_universal_extension_has_no_command() -> None:
    files = contents(one("pydslrep-universal.vsix"))
    assert not [name for name in files if "/server/" in name]
    assert not [
        name for name, data in files.items() if data[:4] in (b"\x7fELF", b"MZ\x90\0")
    ]
    assert "TargetPlatform" not in manifest(files)


@of_each_platform
def test_the_command_is_small(platform: Platform) -> None:
    assert len(command(contents(platform.archive()), platform)) <= LIMIT


def test_the_source_distribution_has_every_crate() -> None:
    files = contents(one("pydslrep-*[0-9].tar.gz"))
    packed = {name.partition("/")[2] for name in files}
    crates = {str(path.relative_to(ROOT)) for path in ROOT.glob("crates/*/Cargo.toml")}
    assert crates | {"Cargo.lock", "pyproject.toml", "python/build_hook.py"} <= packed


def test_checksums_are_of_all_files() -> None:
    sums = FOLDER / "SHA256SUMS"
    run(["sha256sum", "--check", "--strict", "--quiet", sums.name], FOLDER)
    named = {line.split()[1] for line in sums.read_text().splitlines()}
    assert named | {sums.name} == {path.name for path in FOLDER.iterdir()}


def run(command: list[str | Path], folder: Path, **environment: str) -> str:
    """Runs a command and returns what it prints."""
    done = subprocess.run(
        command,
        cwd=folder,
        env={**os.environ, **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout
    return done.stdout


def is_of_the_repository(block: Block) -> bool:
    """Whether a block of the tutorial needs a clone."""
    return "cargo" in block.code or "examples/" in block.code


TUTORIAL = [
    block
    for block in blocks(ROOT / "docs" / "tutorial.md")
    if not is_of_the_repository(block)
]


def differences(session: Session) -> list[str]:
    """Goes through the tutorial; returns what is not as it says."""
    found = []
    for block in TUTORIAL:
        if block.language == "console":
            now = session.transcript(block)
            if comparable(now) != comparable(block.code):
                found.append(f"{block}: it is\n{now}")
        elif block.file:
            session.write(block)
    return found


@here
def test_the_tutorial_works_with_the_wheel(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    home = tmp_path / "environment"
    run([sys.executable, "-m", "venv", home], tmp_path)
    wheel = f"{HERE.package()}[coppeliasim]"
    run([home / "bin" / "pip", "install", "--quiet", wheel], tmp_path)
    cache = tmp_path / "cache"
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache))
    session = Session(str(home / "bin" / "pydslrep"), tmp_path / "work", False)
    assert not differences(session)
    assert not list(cache.glob("pydslrep/venv-*")), "it made an environment of its own"
    # `man` finds them if the environment's commands are on the path.
    assert (home / "share" / "man" / "man1" / "pydslrep.1").is_file()


@pytest.fixture(params=PLATFORMS[:2], ids=lambda platform: platform.target)
def unpacked(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A folder with the commands of an archive for Linux; those for another machine are emulated."""
    platform: Platform = request.param
    if platform not in THERE:
        pytest.skip("made for other platforms")
    run(["tar", "-xzf", platform.archive()], tmp_path)
    (folder,) = tmp_path.iterdir()
    if platform == HERE:
        return folder
    emulator = shutil.which("qemu-aarch64")
    if emulator is None:
        pytest.skip("qemu-user is not installed")
    emulated = tmp_path / "emulated"
    emulated.mkdir()
    for name in platform.commands:
        script = emulated / name
        script.write_text(f'#!/bin/sh\nexec {emulator} "{folder / name}" "$@"\n')
        script.chmod(0o755)
    return emulated


def test_the_tutorial_works_with_an_archive(unpacked: Path, tmp_path: Path) -> None:
    session = Session(str(unpacked / "pydslrep"), tmp_path / "work", False)
    # The first run installs the client library, and says so.
    program = ROOT / "examples" / "square.pyr"
    shutil.copy(program, session.folder)
    code, output = session.run(f"pydslrep run {program.name}")
    assert code == 0, output
    assert not differences(session)


def test_the_server_of_an_archive_answers(unpacked: Path) -> None:
    uri = "file:///yard/square.pyr"
    text = (ROOT / "examples" / "square.pyr").read_text(encoding="utf-8")
    item = {"uri": uri, "languageId": "pydslrep", "version": 1, "text": text}
    line = text[: text.index("\nrobot ") + 1].count("\n")
    place = {"textDocument": {"uri": uri}, "position": {"line": line, "character": 7}}
    with RawServer(str(unpacked / "pydslrep-lsp"), "--stdio") as server:
        server.initialize()
        server.send(
            notification("textDocument/didOpen", {"textDocument": item}),
            request(1, "textDocument/hover", place),
            request(2, "shutdown", None),
            notification("exit", None),
        )
        assert "scout" in json.dumps(server.answer(1)["result"])
        assert server.leave() == 0
