"""Checks generated scripts with ruff and mypy, with their default settings.

Run it with a Python that has tests/requirements.txt installed, and with cargo on the path:

    python3 crates/script/python/check_scripts.py
"""

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def run(*command: str | Path) -> None:
    """Runs a command in the repository; exits if it fails."""
    words = [str(word) for word in command]
    print("+", " ".join(words), flush=True)
    code = subprocess.run(words, cwd=ROOT, check=False).returncode
    if code:
        sys.exit(code)


def tool(name: str, *arguments: str | Path) -> None:
    """Runs a tool of this Python environment."""
    run(sys.executable, "-m", name, *arguments)


def check_scripts(folder: Path) -> None:
    """Checks the scripts in a folder without this repository's settings."""
    tool("ruff", "check", "--isolated", "--no-cache", folder)
    tool("ruff", "format", "--isolated", "--no-cache", "--check", folder)
    for path in sorted(folder.glob("*.py")):
        # For mypy, scripts that differ only in the length of names are equivalent.
        if "_names_" not in path.stem or path.stem.endswith("_names_150"):
            tool("mypy", "--strict", "--python-version", "3.11", "--config-file=", path)


def main() -> None:
    """Generates scripts for many kinds of environments and checks them."""
    with tempfile.TemporaryDirectory() as folder:
        variants = [
            "run",
            "--quiet",
            "--locked",
            "--package",
            "pydslrep-script",
            "--example",
            "variants",
        ]
        run("cargo", *variants, "--", folder)
        check_scripts(Path(folder))


if __name__ == "__main__":
    main()
