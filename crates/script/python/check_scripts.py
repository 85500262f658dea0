"""Checks generated scripts of every kind as a user's own tools would.

Run it from anywhere with a Python that has tests/requirements.txt installed, and with cargo on the path:

    python3 crates/script/python/check_scripts.py
"""

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def run(*command: str | Path) -> None:
    """Runs a command in the repository; ends the checks where it fails."""
    words = [str(word) for word in command]
    print("+", " ".join(words), flush=True)
    code = subprocess.run(words, cwd=ROOT, check=False).returncode
    if code:
        sys.exit(code)


def tool(name: str, *arguments: str | Path) -> None:
    """Runs a tool that is installed beside this Python."""
    run(sys.executable, "-m", name, *arguments)


def check_scripts(folder: Path) -> None:
    """Generated scripts must please the tools as a user has them, without this repository's settings."""
    tool("ruff", "check", "--isolated", "--no-cache", folder)
    tool("ruff", "format", "--isolated", "--no-cache", "--check", folder)
    for path in sorted(folder.glob("*.py")):
        # Scripts whose names have another length only are alike to mypy.
        if "_names_" not in path.stem or path.stem.endswith("_names_150"):
            tool("mypy", "--strict", "--python-version", "3.11", "--config-file=", path)


def main() -> None:
    """Generates scripts of every kind and checks them."""
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
