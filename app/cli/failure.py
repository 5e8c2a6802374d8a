"""What ends a call of the command line early."""

from __future__ import annotations

DONE = 0
NO = 1
UNUSABLE = 2


class Failure(Exception):
    """One sentence for standard error and the exit code that goes with it."""

    def __init__(self, sentence: str, code: int = UNUSABLE) -> None:
        super().__init__(sentence)
        self.code = code
