"""Where an action is: the movement that the environment lists, and the way from there."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Call:
    """A statement that does another movement."""

    movement: str  # that it is in
    action: int  # its number there


@dataclass(frozen=True)
class Place:
    """Where an action is in a program."""

    movement: str = ""  # that the environment lists
    action: int = (
        0  # the number of its statement in its movement, from 1; 0 if there is none
    )
    line: int | None = None  # of the program, if known
    rounds: tuple[int, ...] = ()  # of the loops that it is in, outermost first
    calls: tuple[Call, ...] = ()  # that lead to its movement, outermost first
    inner: str = ""  # its own movement, if calls lead there

    def parts(self) -> dict[str, object]:
        """What events and traces say besides the movement and the number, where there is something to say."""
        found: dict[str, object] = {}
        if self.rounds:
            found["rounds"] = list(self.rounds)
        if self.calls:
            found["calls"] = [
                {"movement": call.movement, "action": call.action}
                for call in self.calls
            ]
        return found

    def way(self, text: str, word: str = "") -> str:
        """An action with its number, after the calls that lead there; `word` precedes each number."""
        names = [*(call.movement for call in self.calls[1:]), self.inner]
        calls = "".join(
            f"{word}{call.action}: do {name}, "
            for call, name in zip(self.calls, names, strict=False)
        )
        return f"{calls}{word}{self.action}{self._rounds()}: {text}"

    def _rounds(self) -> str:
        if not self.rounds:
            return ""
        word = "round" if len(self.rounds) == 1 else "rounds"
        return f" in {word} {', '.join(map(str, self.rounds))}"
