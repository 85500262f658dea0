"""What a simulator or robot may answer: everything that comes from one is checked here before it is used.

A physics engine that diverges answers with numbers that are not finite, a server that fails with anything at all.
"""

import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Any

from .errors import ReadingError

# No scene and no robot reaches these; the largest that are written as a number still fit into a line.
MAX_LENGTH = 1e6  # m
MAX_ANGLE = 1e9  # rad, which a wheel turns in its life
MAX_RATE = 1e6  # rad/s
MAX_AMOUNT = 1e39  # kg or N·m; simulators have single precision
MAX_TIME_STEP = 10.0  # s
MAX_TIME = 1e9  # s
MAX_GAP = 3600.0  # s between two steps; a robot that was left alone for longer is not where it was
MAX_HANDLE = 2**63 - 1
MAX_OBJECTS = 20_000  # of a scene
MAX_DEPTH = 500  # objects above another one
MAX_VERTICES = 1_000_000  # of a mesh
MAX_NAMESAKES = 1_000  # objects with one path
MAX_NAME = 2_000  # characters; of a path as well
MAX_TEXT = 1 << 20  # characters of other texts
ROUNDING = 0.01  # by which the squares of a rotation's rows may differ from 1

SHOWN = 60  # characters of a value in a message
SHOWN_ITEMS = 4
SHOWN_REASON = 300  # characters of a reason that a simulator gives

CONTROLS = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069]+")


def printable(text: str) -> str:
    """A text without what controls a terminal."""
    return CONTROLS.sub(" ", text)


def shortened(text: str, limit: int = SHOWN_REASON) -> str:
    """The beginning of a text, in one line."""
    beginning = printable(text[: limit + 1])
    return beginning if len(text) <= limit else beginning[:limit].rstrip() + "..."


def shown(value: object) -> str:
    """A value for a message, in a few words however large it is."""
    match value:
        case None:
            return "nothing"
        case bool() | float():
            return str(value)
        case int():
            # Python refuses to write very large ones.
            return str(value) if abs(value) < 10**18 else "a very large number"
        case str():
            return f'"{shortened(value, SHOWN)}"'
        case bytes():
            return f"{len(value)} bytes"
        case list() | tuple() if type(value) in (list, tuple):  # poses have a name
            items = ", ".join(shown(item) for item in value[:SHOWN_ITEMS])
            more = f", ... ({len(value)} values)" if len(value) > SHOWN_ITEMS else ""
            return shortened(f"[{items}{more}]", 2 * SHOWN)
        case dict():
            return f"a map of {len(value)}"
        case _:
            return f"a {shortened(type(value).__name__, SHOWN)}"


@dataclass(frozen=True)
class Form:
    """What a value has to be."""

    description: str  # follows "instead of"
    accepts: Callable[[Any], bool]


def number(low: float, high: float, what: str = "a number") -> Form:
    """A number between two others."""

    def accepts(value: Any) -> bool:
        # Not a number is not between any two.
        return is_number(value) and low <= value <= high

    return Form(f"{what} from {low:g} to {high:g}", accepts)


def whole(low: int, high: int = MAX_HANDLE, what: str = "a whole number") -> Form:
    """A whole number between two others."""

    def accepts(value: Any) -> bool:
        return isinstance(value, int) and low <= value <= high

    return Form(what, accepts)


def numbers(low: int, high: int, limit: float) -> Form:
    """A list of numbers whose absolute value has a limit."""

    def accepts(value: Any) -> bool:
        return (
            isinstance(value, list | tuple)
            and low <= len(value) <= high
            and all(is_number(each) and -limit <= each <= limit for each in value)
        )

    count = f"{low}" if low == high else f"{low} to {high}"
    return Form(f"{count} numbers from -{limit:g} to {limit:g}", accepts)


def text(limit: int) -> Form:
    """A text."""

    def accepts(value: Any) -> bool:
        return isinstance(value, str) and len(value) <= limit

    return Form(f"a text of up to {limit} characters", accepts)


def optional(form: Form) -> Form:
    """What may be missing."""
    return Form(
        f"{form.description}, or nothing",
        lambda value: value is None or form.accepts(value),
    )


def is_number(value: Any) -> bool:
    """Whether a value is a number, and not a truth value."""
    return type(value) in (float, int) or (
        isinstance(value, Real) and not isinstance(value, bool)
    )


def _is_matrix(value: Any) -> bool:
    if not isinstance(value, list | tuple) or len(value) != 12:
        return False
    if not all(is_number(each) and -MAX_LENGTH <= each <= MAX_LENGTH for each in value):
        return False
    rows = (value[0:3], value[4:7], value[8:11])
    return all(abs(x * x + y * y + z * z - 1.0) <= ROUNDING for x, y, z in rows)


def _is_list_of_handles(value: Any) -> bool:
    # A list without elements is an empty map.
    return value == {} or (
        isinstance(value, list | tuple)
        and len(value) <= MAX_OBJECTS
        and all(map(HANDLE.accepts, value))
    )


def _is_list_of_indices(value: Any) -> bool:
    return (
        isinstance(value, list | tuple)
        and 3 <= len(value) <= 6 * MAX_VERTICES
        and all(type(each) is int and 0 <= each < MAX_VERTICES for each in value)
    )


def _is_list_of_points(value: Any) -> bool:
    return (
        isinstance(value, list)
        and len(value) <= MAX_OBJECTS
        and all(map(POINT.accepts, value))
    )


def _is_interface(value: Any) -> bool:
    return isinstance(value, dict) and all(
        isinstance(name, str) and isinstance(what, dict) for name, what in value.items()
    )


def _is_data(value: Any) -> bool:
    return isinstance(value, str | bytes) and len(value) <= MAX_TEXT


HANDLE = whole(0, what="a handle")
HANDLE_OR_NONE = whole(-1, what="a handle or -1")
INTEGER = whole(-(2**31), 2**32, "a whole number of 32 bits")
MATRIX = Form(
    f"the matrix of a rotation and a position up to {MAX_LENGTH:g} m",
    _is_matrix,
)
HANDLES = Form(f"a list of up to {MAX_OBJECTS} handles", _is_list_of_handles)
INDICES = Form("a list of indices, three for each triangle", _is_list_of_indices)
INTERFACE = Form("a map of functions and constants", _is_interface)
DATA = Form(f"a text of up to {MAX_TEXT} characters", _is_data)
NAME = text(MAX_NAME)
POINT = numbers(2, 2, MAX_LENGTH)
POSITION = numbers(3, 3, MAX_LENGTH)
ANGLES = numbers(3, 3, MAX_ANGLE)
LENGTH = number(-MAX_LENGTH, MAX_LENGTH)
DISTANCE = number(0.0, MAX_LENGTH)
ANGLE = number(-MAX_ANGLE, MAX_ANGLE)
AMOUNT = number(-MAX_AMOUNT, MAX_AMOUNT)
TIME = number(0.0, MAX_TIME, "a time")
TIME_STEP = number(1e-6, MAX_TIME_STEP, "a time step")
SENSOR_STATE = whole(-1, 1, "a sensor's state: -1, 0 or 1")
READING = (SENSOR_STATE, DISTANCE)
NOTHING: tuple[Form, ...] = ()

# What is read of the result of each function of CoppeliaSim: the first of its values.
RESULTS: Mapping[str, tuple[Form, ...]] = {
    "addScript": (HANDLE,),
    "checkProximitySensor": READING,
    "createForceSensor": (HANDLE,),
    "createJoint": (HANDLE,),
    "createPrimitiveShape": (HANDLE,),
    "createProximitySensor": (HANDLE,),
    "createShape": (HANDLE,),
    "getFloatArrayProperty": (numbers(0, 16, MAX_LENGTH),),
    "getFloatProperty": (LENGTH,),
    "getFloatParam": (number(0.0, MAX_TIME_STEP),),
    "getInt32Param": (INTEGER,),
    "getJointMode": (INTEGER,),
    "getJointPosition": (ANGLE,),
    "getJointTargetForce": (AMOUNT,),
    "getJointTargetVelocity": (number(-MAX_RATE, MAX_RATE),),
    "getJointType": (INTEGER,),
    "getJointVelocity": (number(-MAX_RATE, MAX_RATE),),
    "getObject": (HANDLE_OR_NONE,),
    "getObjectAlias": (NAME,),
    "getObjectFloatParam": (AMOUNT,),
    "getObjectInt32Param": (INTEGER,),
    "getObjectMatrix": (MATRIX,),
    "getObjectParent": (HANDLE_OR_NONE,),
    "getObjectSpecialProperty": (INTEGER,),
    "getObjectType": (INTEGER,),
    "getObjectsInTree": (HANDLES,),
    "getScript": (HANDLE_OR_NONE,),
    "getScriptStringParam": (DATA,),
    "getShapeGeomInfo": (INTEGER, INTEGER, numbers(2, 16, MAX_LENGTH)),
    "getShapeMesh": (numbers(9, 3 * MAX_VERTICES, MAX_LENGTH), INDICES),
    "getSimulationState": (whole(0, 255, "the state of a simulation"),),
    "getSimulationTime": (TIME,),
    "getSimulationTimeStep": (TIME_STEP,),
    "handleProximitySensor": READING,
    "readCustomDataBlock": (optional(DATA),),
    "readCustomStringData": (optional(DATA),),
    "readProximitySensor": READING,
    "removeObjects": NOTHING,
    "removeScript": NOTHING,
    "setEngineFloatParam": NOTHING,
    "setJointTargetForce": NOTHING,
    "setJointTargetVelocity": NOTHING,
    "setObjectAlias": NOTHING,
    "setObjectInt32Param": NOTHING,
    "setObjectMatrix": NOTHING,
    "setObjectParent": NOTHING,
    "setObjectSpecialProperty": NOTHING,
    "setScriptStringParam": NOTHING,
    "setShapeMass": NOTHING,
    "setStepping": (optional(INTEGER),),
    "startSimulation": NOTHING,
    "step": NOTHING,
    "stopSimulation": NOTHING,
    "writeCustomDataBlock": NOTHING,
    "writeCustomStringData": NOTHING,
    "zmqRemoteApi.info": (INTERFACE,),
    "zmqRemoteApi.require": NOTHING,
}

# The same of the legacy remote API, after the return code.
LEGACY_RESULTS: Mapping[str, tuple[Form, ...]] = {
    "simxGetFloatingParameter": (TIME_STEP,),
    "simxGetInMessageInfo": (INTEGER,),
    "simxGetJointPosition": (ANGLE,),
    "simxGetLastCmdTime": (INTEGER,),
    "simxGetObjectHandle": (HANDLE_OR_NONE,),
    "simxGetObjectIntParameter": (INTEGER,),
    "simxGetObjectOrientation": (ANGLES,),
    "simxGetObjectPosition": (POSITION,),
    "simxGetObjects": (HANDLES,),
    "simxReadProximitySensor": (SENSOR_STATE,),
}
# What the same function returns second, if the sensor detects something; it is rubbish otherwise.
LEGACY_POINT = POSITION

# What the marks of `scene push` say of an object.
MARKS: Mapping[str, Form] = {
    "kind": NAME,
    "environment": NAME,
    "name": NAME,
    "sensor": NAME,
    "grip": number(0.0, 1.0),
    "rim_speed": optional(number(0.0, MAX_LENGTH)),
    "rim_acceleration": number(0.0, MAX_LENGTH),
    "range": number(0.0, MAX_LENGTH),
    "cone": number(0.0, MAX_ANGLE),
    "origin": MATRIX,
    "corners": Form("a list of points", _is_list_of_points),
}

CONSTANT = whole(-(2**63), what="a whole number")


def check(call: str, value: Any, form: Form) -> None:
    """Raises ReadingError unless a value is what it has to be."""
    if not form.accepts(value):
        raise ReadingError(
            f"{call} returned {shown(value)} instead of {form.description}"
        )


def read_result(call: str, values: Sequence[Any], forms: Sequence[Form]) -> Any:
    """Those values of a result that are read: none, one or a tuple; raises ReadingError."""
    read = [*values[: len(forms)], *[None] * (len(forms) - len(values))]
    for value, form in zip(read, forms, strict=True):
        check(call, value, form)
    if not read:
        return None
    return read[0] if len(read) == 1 else tuple(read)


def read_reply(function: str, values: Any) -> Any:
    """The result of a function of CoppeliaSim; raises ReadingError."""
    if values == {}:  # a list without elements
        values = []
    if not isinstance(values, list | tuple):
        raise ReadingError(f"{function} returned {shown(values)} instead of a list")
    forms = RESULTS.get(function.removeprefix("sim."))
    if forms is not None:
        return read_result(function, values, forms)
    match values:
        case []:
            return None
        case [value]:
            return value
        case _:
            return tuple(values)


def check_time(clock: str, before: float, now: Any, correction: float = 0.0) -> None:
    """Raises ReadingError unless a time in seconds can follow another one; it may be less by a correction."""
    check(clock, now, TIME)
    if now < before - correction:
        raise ReadingError(f"{clock} went back from {before:g} s to {now:g} s")
    if now - before > MAX_GAP:
        raise ReadingError(f"{clock} went from {before:g} s to {now:g} s at once")


def read_mark(call: str, data: Any) -> dict[str, Any] | None:
    """The mark of an object; None if it is none of ours. Raises ReadingError if its values cannot be."""
    try:
        mark = json.loads(data or "null")
    except (TypeError, ValueError, RecursionError):
        return None  # somebody else's data, with the same name
    if not (isinstance(mark, dict) and "kind" in mark):
        return None
    for key, form in MARKS.items():
        if key in mark:
            check(f"{call}: {key}", mark[key], form)
    return mark
