"""Checks messages of the server against the protocol's meta model.

`lsprotocol` is generated from that model: its classes hold every structure with the types of its properties. They are
read here as a schema for plain JSON, more strictly than its converter does, which passes over unknown properties.
"""

from __future__ import annotations

import collections.abc
import enum
import functools
import types as python_types
import typing
from typing import Any

import attrs
from lsprotocol import types

# Required properties that may be null; lsprotocol gives them the same type as optional ones.
REQUIRED_NULLABLE = {
    "OptionalVersionedTextDocumentIdentifier.version",
    "WorkspaceFullDocumentDiagnosticReport.version",
    "WorkspaceUnchangedDocumentDiagnosticReport.version",
}
PROGRESS = (
    types.WorkDoneProgressBegin
    | types.WorkDoneProgressReport
    | types.WorkDoneProgressEnd
)


def faults_of_message(message: dict[str, Any], asked: str | None = None) -> list[str]:
    """The violations in a message of the server; a response is to a request of the method `asked`."""
    if asked is not None:
        kind = types.ResponseErrorMessage if "error" in message else answer_type(asked)
        if ("error" in message) == ("result" in message):
            return [f"{asked}: an answer has a result or an error"]
        return faults(message, kind, asked)
    method = message["method"]
    if method not in types.METHOD_TO_TYPES:
        ours = method.startswith("pydslrep/")
        return [] if ours else [f"{method} is not in the protocol"]
    if types.message_direction(method) == "clientToServer":
        return [f"{method} is not for servers to send"]
    found = faults(message, types.METHOD_TO_TYPES[method][0], method)
    params = message.get("params")
    if method == "$/progress" and isinstance(params, dict):
        found += faults(params["value"], PROGRESS, f"{method}.value")
    if method == "client/registerCapability" and isinstance(params, dict):
        for registration in params["registrations"]:
            _, _, _, options = types.METHOD_TO_TYPES[registration["method"]]
            path = f"{method}.{registration['method']}"
            found += faults(registration.get("registerOptions"), options, path)
    return found


def answer_type(method: str) -> Any:
    """The result type of a method; commands and our own methods may return anything."""
    return types.METHOD_TO_TYPES[method][1] if method in types.METHOD_TO_TYPES else Any


def faults(value: object, kind: Any, path: str) -> list[str]:
    """The violations in a value of a type of the model."""
    if kind is Any or kind is object:
        return []
    if kind is None or kind is type(None):
        return [] if value is None else [f"{path}: not null"]
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin is typing.Union or origin is python_types.UnionType:
        each = [faults(value, option, path) for option in arguments]
        return min(each, key=len)
    if origin is typing.Literal:
        return [] if value in arguments else [f"{path}: {value!r} is not {arguments}"]
    if origin is tuple:
        if not isinstance(value, list) or len(value) != len(arguments):
            return [f"{path}: {value!r} is not a list of {len(arguments)}"]
        pairs = zip(value, arguments, strict=True)
        return [fault for item, of in pairs for fault in faults(item, of, path)]
    if origin is collections.abc.Sequence:
        if not isinstance(value, list):
            return [f"{path}: {value!r} is not a list"]
        return [
            fault
            for index, item in enumerate(value)
            for fault in faults(item, arguments[0], f"{path}[{index}]")
        ]
    if origin is collections.abc.Mapping:
        if not isinstance(value, dict):
            return [f"{path}: {value!r} is not an object"]
        return [
            fault
            for key, item in value.items()
            for fault in faults(item, arguments[1], f"{path}.{key}")
        ]
    if attrs.has(kind):
        return faults_of_structure(value, kind, path)
    return faults_of_scalar(value, kind, path)


def faults_of_scalar(value: object, kind: Any, path: str) -> list[str]:
    """The violations in a scalar value."""
    if issubclass(kind, enum.Enum):
        known = [member.value for member in kind]
        return [] if value in known else [f"{path}: {value!r} is no {kind.__name__}"]
    if kind is float:
        kind = (int, float)
    if isinstance(value, bool) and kind is not bool:
        return [f"{path}: a truth value"]
    return [] if isinstance(value, kind) else [f"{path}: {value!r} is not {kind}"]


def faults_of_structure(value: object, kind: Any, path: str) -> list[str]:
    """The violations in a structure of the protocol."""
    if not isinstance(value, dict):
        return [f"{path}: {value!r} is not a {kind.__name__}"]
    if kind is types.LSPObject:
        return []
    properties = {camel(field.name): field for field in fields(kind)}
    found = [f"{path}.{name} is unknown" for name in value.keys() - properties.keys()]
    for name, field in properties.items():
        own = f"{path}.{name}"
        nullable = types.is_special_property(kind, field.name)
        if name not in value:
            named = f"{kind.__name__}.{field.name}"
            is_required = (
                field.default is attrs.NOTHING
                or named in REQUIRED_NULLABLE
                or isinstance(field.default, str)
                or name == "result"
            )
            found += [f"{own} is missing"] if is_required else []
        elif (
            value[name] is None and field.default is not attrs.NOTHING and not nullable
        ):
            found.append(f"{own} is null instead of missing")
        elif isinstance(field.default, str) and value[name] != field.default:
            found.append(f"{own}: {value[name]!r} instead of {field.default!r}")
        else:
            found += faults(value[name], field.type, own)
            if isinstance(value[name], int) and field.validator:
                try:
                    field.validator(None, field, value[name])
                except (ValueError, TypeError) as error:
                    found.append(f"{own}: {error}")
    return found


@functools.cache
def fields(kind: Any) -> tuple[attrs.Attribute[Any], ...]:
    """The properties of a structure, with their types resolved."""
    attrs.resolve_types(kind, vars(types))
    return tuple(attrs.fields(kind))


def camel(name: str) -> str:
    """A property's name in the protocol."""
    first, *rest = name.rstrip("_").split("_")
    return first + "".join(part.title() for part in rest)
