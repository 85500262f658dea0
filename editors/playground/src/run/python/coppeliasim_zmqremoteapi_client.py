"""Stands in for CoppeliaSim's client: `require`, and calls of what it returns."""

import uuid
from collections.abc import Callable
from typing import Any

import cbor2 as cbor
import zmq

__all__ = ["RemoteAPIClient", "cbor"]

WAIT, REPEAT, EXECUTED = "_*wait*_", "_*repeat*_", "_*executed*_"


class RemoteAPIClient:
    """A client of the simulator."""

    def __init__(self, host: str = "localhost", port: int = 23000) -> None:
        """Connects."""
        self.socket = zmq.Context.instance().socket(zmq.REQ)
        self.socket.connect(f"tcp://{host}:{port}")
        self.uuid = str(uuid.uuid4())
        self.timeout = 600.0
        self._is_known = False

    def require(self, name: str) -> Any:
        """The functions and constants of an API, such as `sim`."""
        self.call("zmqRemoteApi.require", [name])
        return self._object(name, self.call("zmqRemoteApi.info", [name]))

    def call(self, function: str, arguments: list[Any]) -> Any:
        """The result of a function, or a tuple of its results; raises an exception if it fails."""
        self._send({"func": function, "args": arguments})
        while "func" in (reply := cbor.loads(self.socket.recv())):
            if reply["func"] == WAIT:
                function, arguments = EXECUTED, []
            elif reply["func"] != REPEAT:
                raise RuntimeError(f"unknown reply {reply['func']}")
            self._send({"func": function, "args": arguments})
        if "err" in reply:
            raise RuntimeError(reply["err"])
        results = reply.get("ret", [])
        return results[0] if len(results) == 1 else tuple(results) or None

    def _send(self, request: dict[str, Any]) -> None:
        request |= {"argsL": len(request["args"]), "uuid": self.uuid}
        if not self._is_known:
            self._is_known = True
            request |= {"ver": 2, "lang": "python", "timeout": self.timeout}
        self.socket.send(cbor.dumps(request))

    def _object(self, name: str, members: dict[str, Any]) -> Any:
        def function(path: str) -> Callable[..., Any]:
            return lambda *arguments: self.call(path, list(arguments))

        found = type(name, (), {})()
        for key, member in members.items():
            path = f"{name}.{key}"
            if "func" in member:
                value: Any = function(path)
            elif "const" in member:
                value = member["const"]
            else:
                value = self._object(path, member)
            setattr(found, key, value)
        return found
