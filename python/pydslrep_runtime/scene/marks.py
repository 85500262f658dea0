"""The marks on what was made here: nothing else is ever changed or removed."""

import json
from collections.abc import Iterator
from typing import Any

from ..readings import read_mark
from ..remote_api import Connection

TAG = "PyDSLRep"  # the name of the custom data
STRINGS = 40700  # the first version that has functions for custom data of each type


class Marks:
    """The marks in the scene of one simulator; every method raises SimulatorError."""

    def __init__(self, connection: Connection) -> None:
        self._connection, self._sim = connection, connection.sim
        version = connection.call(
            self._sim.getInt32Param, self._sim.intparam_program_version
        )
        self._has_strings = version >= STRINGS

    def write(self, handle: int, mark: dict[str, Any]) -> None:
        """Marks an object."""
        text = json.dumps(mark)
        if self._has_strings:
            self._connection.call(self._sim.writeCustomStringData, handle, TAG, text)
        else:
            self._connection.call(self._sim.writeCustomDataBlock, handle, TAG, text)

    def read(self, handle: int) -> dict[str, Any] | None:
        """The mark of an object; None if it was not made here."""
        if self._has_strings:
            text = self._connection.call(self._sim.readCustomStringData, handle, TAG)
        else:
            text = self._connection.call(self._sim.readCustomDataBlock, handle, TAG)
        return read_mark(f"the mark of object {handle}", text)

    def all(self) -> Iterator[tuple[int, dict[str, Any]]]:
        """All marked objects of the scene with their marks."""
        for handle in self.objects():
            mark = self.read(handle)
            if mark is not None:
                yield handle, mark

    def objects(self) -> list[int]:
        """All objects of the scene."""
        sim = self._sim
        # A list without elements is an empty map.
        return list(
            self._connection.call(
                sim.getObjectsInTree, sim.handle_scene, sim.handle_all, 0
            )
        )
