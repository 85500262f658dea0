"""Puts the commands into the wheel: those in the folder PYDSLREP_BINARIES if that is set, else built here with cargo.

Manual pages and completions are those in the folder PYDSLREP_SHARE; without it, the command writes them.
PYDSLREP_PLATFORM names the wheel's platforms where they are not those of this machine, separated by dots, as in
`manylinux2014_x86_64.musllinux_1_1_x86_64`.
"""

from __future__ import annotations

import atexit
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

COMMANDS = ("pydslrep", "pydslrep-lsp")


class CommandsHook(BuildHookInterface[Any]):
    """Adds the commands of the language to a wheel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Is called before a wheel is built; an editable one uses the commands in `target`."""
        if self.target_name != "wheel" or version == "editable":
            return
        folder = os.environ.get("PYDSLREP_BINARIES")
        binaries = Path(folder) if folder else self._build()
        names = [f"{name}{end}" for name in COMMANDS for end in ("", ".exe")]
        commands = [path for name in names if (path := binaries / name).is_file()]
        if len(commands) != len(COMMANDS):
            sys.exit(f"error: {binaries} must have {' and '.join(COMMANDS)}")
        build_data["shared_scripts"] = {str(path): path.name for path in commands}
        build_data["shared_data"] = {str(self._share(commands[0])): "share"}
        build_data["pure_python"] = False
        platform = os.environ.get("PYDSLREP_PLATFORM")
        build_data["tag"] = f"py3-none-{platform or _this_platform()}"

    def _share(self, command: Path) -> Path:
        folder = os.environ.get("PYDSLREP_SHARE")
        if folder:
            return Path(folder)
        written = tempfile.TemporaryDirectory()
        atexit.register(written.cleanup)
        subprocess.run([command, "share", written.name], check=True)
        return Path(written.name)

    def _build(self) -> Path:
        cargo = shutil.which("cargo")
        if cargo is None:
            sys.exit("error: building pydslrep needs Rust: https://rustup.rs")
        root = Path(self.root)
        target = Path(os.environ.get("CARGO_TARGET_DIR", root / "target"))
        bins = [word for name in COMMANDS for word in ("--bin", name)]
        command = [cargo, "build", "--release", "--locked", *bins]
        subprocess.run(command, cwd=root, check=True)
        return target / "release"


def _this_platform() -> str:
    # Hatchling depends on it.
    from packaging.tags import platform_tags

    return next(platform_tags())
