"""The files of a release, in the folder that PYDSLREP_DIST names: `.ci/dist.sh` makes them."""

from __future__ import annotations

import os
import tarfile
import zipfile
from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(os.environ.get("PYDSLREP_DIST", "."))


@dataclass(frozen=True)
class Platform:
    """A platform that a release is for."""

    target: str
    """Rust's name."""
    wheel: str
    """The tags of its wheel."""
    vscode: str

    @property
    def is_windows(self) -> bool:
        """Whether programs end in `.exe`."""
        return "windows" in self.target

    @property
    def commands(self) -> list[str]:
        """The names of the programs."""
        return [
            name + ".exe" * self.is_windows for name in ("pydslrep", "pydslrep-lsp")
        ]

    def archive(self) -> Path:
        """The commands, with manual pages and completions."""
        return one(f"pydslrep-*-{self.target}.{'zip' if self.is_windows else 'tar.gz'}")

    def package(self) -> Path:
        """The wheel."""
        return one(f"pydslrep-*-py3-none-{self.wheel}.whl")

    def extension(self) -> Path:
        """The extension for VS Code."""
        return one(f"pydslrep-{self.vscode}.vsix")

    def is_there(self) -> bool:
        """Whether the release was made for it."""
        return any(FOLDER.glob(f"pydslrep-*-{self.target}.*"))


PLATFORMS = [
    Platform(
        "x86_64-unknown-linux-musl",
        "manylinux2014_x86_64.musllinux_1_1_x86_64",
        "linux-x64",
    ),
    Platform(
        "aarch64-unknown-linux-musl",
        "manylinux2014_aarch64.musllinux_1_1_aarch64",
        "linux-arm64",
    ),
    Platform("x86_64-pc-windows-gnu", "win_amd64", "win32-x64"),
    Platform("aarch64-apple-darwin", "macosx_11_0_arm64", "darwin-arm64"),
    Platform("x86_64-apple-darwin", "macosx_11_0_x86_64", "darwin-x64"),
]


def one(pattern: str) -> Path:
    """The only file of a release whose name matches."""
    found = sorted(FOLDER.glob(pattern))
    assert len(found) == 1, f"{pattern}: {found}"
    return found[0]


def contents(archive: Path) -> dict[str, bytes]:
    """The files in an archive, a wheel or an extension, by their paths."""
    if archive.name.endswith(".tar.gz"):
        with tarfile.open(archive) as tar:
            files = {member: tar.extractfile(member) for member in tar}
            return {
                member.name: file.read()
                for member, file in files.items()
                if file is not None
            }
    with zipfile.ZipFile(archive) as packed:
        return {
            name: packed.read(name)
            for name in packed.namelist()
            if not name.endswith("/")
        }
