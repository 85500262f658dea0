"""Why a request about a scene is refused."""


class RefusalError(Exception):
    """A request that cannot be fulfilled, in a sentence, and what to do about it.

    Programs tell the reason from others by a word, where they can do something about it.
    """

    def __init__(
        self, message: str, help_text: str | None = None, reason: str | None = None
    ) -> None:
        super().__init__(message)
        self.message, self.help, self.reason = message, help_text, reason
