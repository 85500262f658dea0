"""Checks generated scripts with ruff and mypy, with their default settings.

Run it with a Python that has tests/requirements.txt installed, and with cargo on the path:

    python3 python/check_scripts.py
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def run(*command: str | Path) -> None:
    """Runs a command in the repository; exits if it fails."""
    words = [str(word) for word in command]
    print("+", " ".join(words), flush=True)
    # Here mypy finds the runtime, as it would beside the scripts.
    environment = os.environ | {"MYPYPATH": str(ROOT / "python")}
    code = subprocess.run(words, cwd=ROOT, env=environment, check=False).returncode
    if code:
        sys.exit(code)


def tool(name: str, *arguments: str | Path) -> None:
    """Runs a tool of this Python environment."""
    run(sys.executable, "-m", name, *arguments)


def check_scripts(folder: Path) -> None:
    """Checks the scripts in a folder without this repository's settings."""
    isolated = ("--isolated", "--no-cache")
    # The order of imports is not checked by default, but many projects do.
    tool("ruff", "check", *isolated, "--extend-select", "I", folder)
    tool("ruff", "format", *isolated, "--check", folder)
    tool("mypy", "--strict", "--python-version", "3.11", "--config-file=", folder)


def main() -> None:
    """Generates scripts for many kinds of environments and checks them."""
    with tempfile.TemporaryDirectory() as folder:
        variants = [
            "run",
            "--quiet",
            "--locked",
            # Without the name of its package, it has the features of the whole workspace, as the other tests.
            "--example",
            "variants",
        ]
        run("cargo", *variants, "--", folder)
        check_scripts(Path(folder))


if __name__ == "__main__":
    main()
