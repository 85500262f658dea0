"""What exercises each capability, by what it is for."""

from . import (
    commands,
    folders,
    layout,
    navigation,
    problems,
    reading,
    texts,
    typing_help,
)
from .session import CONVERTER, EXERCISES, Session

__all__ = [
    "CONVERTER",
    "EXERCISES",
    "Session",
    "commands",
    "folders",
    "layout",
    "navigation",
    "problems",
    "reading",
    "texts",
    "typing_help",
]
