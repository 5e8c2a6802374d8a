"""Commands that prove themselves: behind them on their line travels an empty frame, which a refusal would keep away."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from codegen.twoletter import nodes
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.parse import parse_line
from device.door import LISTS
from device.tasks import Send, Steps
from device.undecided import ANYTHING, NOTHING
from device.wire import Answer, Proof, framed

PROOF = re.compile(r";MG\{\^30\},\"..\",\{\^31\}$|^MG\{\^30\},\"..\",\{\^31\};(?=DL$)")
SEVERAL = LISTS | {"BS"}  # tell as many lines as there is something to say
TELLING = SEVERAL | {"MG"} | {row.name for row in COMMANDS.values() if row.tells}


def proved(
    nonces: Iterator[str], command: str, timeout_s: float, refusal_s: float = 0.0, reply: str | None = None
) -> Steps[Answer]:
    """A command and the proof that it was accepted; with `refusal_s` a `?` and so much silence is a refusal.

    `reply`: what lines of its answer look like; other text that comes in between is a program's.
    """
    line, proof = with_proof(next(nonces), command, reply)
    return (yield Send(line, proof, timeout_s, refusal_s=refusal_s))


def with_proof(nonce: str, command: str, reply: str | None = None) -> tuple[bytes, Proof]:
    """The line of a command with its proof, and what to expect of it."""
    statements = parse_line(command).statements
    if reply is None:
        reply = ANYTHING if any(tells(statement) for statement in statements) else NOTHING
    return f"{command};{framed(nonce, ())}\r".encode(), Proof(nonce, len(statements), reply, lines_told(statements))


def lines_told(statements: Sequence[nodes.Statement]) -> int | None:
    """How many lines the answer has; None where that is not known."""
    telling = [statement for statement in statements if tells(statement)]
    if any(not isinstance(each, nodes.Command | nodes.Print) for each in telling):
        return None
    if any(isinstance(each, nodes.Command) and (each.name in SEVERAL or _freely(each)) for each in telling):
        return None
    return len(telling)


def _freely(command: nodes.Command) -> bool:
    """Whether it says itself where its lines end (`MG "A",{^13},{N}`), or tells a text of its own."""
    parts = (nodes.NoLineEnd, nodes.Character)
    return command.name == "CW" or any(isinstance(item, parts) for item in command.arguments)


def bare(line: str) -> str:
    """A line as it was meant, without the proof that travels with it."""
    return PROOF.sub("", line)


def tells(statement: nodes.Statement) -> bool:
    """Whether a statement sends something back."""
    if isinstance(statement, nodes.Command):
        if statement.name in TELLING or any(isinstance(item, nodes.Query) for item in statement.arguments):
            return True
        return statement.name == "CW" and not statement.arguments
    return isinstance(statement, nodes.Print | nodes.Broken | nodes.Foreign)
