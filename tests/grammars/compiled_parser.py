"""The checked-in parser of the tree-sitter grammar, compiled."""

from __future__ import annotations

import ctypes
import subprocess
from pathlib import Path

import tree_sitter

GRAMMAR = Path(__file__).resolve().parents[2] / "grammar" / "tree-sitter"


def compiled_parser(folder: Path) -> tree_sitter.Language:
    """Compiles the checked-in parser into a folder."""
    library = folder / "pydslrep.so"
    source = GRAMMAR / "src"
    subprocess.run(
        [
            "cc",
            "-O2",
            "-shared",
            "-fPIC",
            "-std=c11",
            "-I",
            source,
            "-o",
            library,
            source / "parser.c",
        ],
        check=True,
    )
    function = ctypes.CDLL(str(library)).tree_sitter_pydslrep
    function.restype = ctypes.c_void_p
    capsule = ctypes.pythonapi.PyCapsule_New
    capsule.restype = ctypes.py_object
    capsule.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
    return tree_sitter.Language(capsule(function(), b"tree_sitter.Language", None))
