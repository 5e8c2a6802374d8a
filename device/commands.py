"""Lines as a person types them: sent with their proof where that is possible, and replies in words."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

from codegen.models import MODELS
from codegen.twoletter import nodes
from codegen.twoletter.parse import parse_line
from codegen.twoletter.problems import ERROR_TEXTS
from codegen.twoletter.slow_mark import BURNS, FULL, percent_of
from device.asking import Listing
from device.backup import parameter_names
from device.door import choose, only_reads
from device.download import held_program
from device.identify import fence, read_once
from device.proof import proved, with_proof
from device.stop import StopState
from device.tasks import LinkError, LinkLost, NotAllowed, Refused, Send, Steps, data_line
from device.wire import FRAME_COLUMNS, Answer, Kind, Prompts, Revision, Shape, Upload

if TYPE_CHECKING:
    from device.api import Controller

T = TypeVar("T")
ALONE = frozenset(["RS", "UL", "CI"])  # nothing can stand behind these on a line
ENDING = frozenset(["MO", "ST", "AB", "HX", "MG"])
ACTING = frozenset(["AF", "CE", "MT", "OF"])  # may drive a motor at once
MEANWHILE = ENDING | {"SB", "CB", "OP"}  # what may be sent while an axis is tuned or brought to life
ENTRY = frozenset(["DL", "ED", "QD"])
REPLACES = frozenset(["DL", "ED", "RS"])
SETTLING = "settling"  # who sends what was in effect before a STOP: that starts nothing
SLOW = {"BP": 15.0, "BV": 5.0, "BN": 3.0, "RS": 5.0}
USUAL_S = 1.0


@dataclass(frozen=True, slots=True)
class Reply:
    """The answer to one line; `certain` False when a program's text may be in it; `reason` says why it was refused."""

    text: str
    accepted: bool
    certain: bool = True
    code: int = 0
    reason: str = ""


def names(command: str) -> list[str]:
    """The two-letter names on a line."""
    return [s.name for s in parse_line(command).statements if isinstance(s, nodes.Command)]


def by_hand(controller: Controller, command: str, timeout_s: float | None) -> Steps[Reply]:
    """A line of a person. What is there only for a while (of a tuning, a move by hand, a capture) is never burned."""
    found, motion = names(command), controller.motion
    if not only_reads(f"{command.rstrip()}\r".encode()) and not MEANWHILE.issuperset(found):
        motion.unclaimed("Not sent")
    if "BN" in found and motion.busy:
        raise NotAllowed(f"Not burned: {motion.busy} is under way; its speeds would be kept. Wait for its end.")
    if "BV" in found and controller.recording:
        raise NotAllowed(f"Not burned: {controller.recording}")
    return (yield from typed(controller, command, timeout_s))


def typed(controller: Controller, command: str, timeout_s: float | None) -> Steps[Reply]:
    """Sends a line and reads its reply."""
    if command in ("\x12\x16", "^R^V"):
        answer = yield Send(b"\x12\x16", Revision(), timeout_s or USUAL_S)
        return Reply(answer.text, answer.kind is Kind.ACCEPTED, answer.certain)
    command = command.rstrip("\r\n")
    data_line(command)
    if controller.waiting.entry:
        return (yield from _entered(controller, command))
    found = names(command)
    slow = percent_of(controller.listing or "")
    if slow < FULL and not BURNS.isdisjoint(found):
        raise NotAllowed(f"Not burned: the program in the controller is slowed to {slow} %, and so may its speeds be.")
    if found and found[-1] in ENTRY:
        return (yield from _enter(controller, command, found[-1]))
    before = (yield from _before_start(controller)) if "XQ" in found else 0
    limit = timeout_s or max([SLOW.get(name, USUAL_S) for name in found], default=USUAL_S)
    if "UL" in found:
        return (yield from _listed(controller, command))
    if _plain(command, found, controller):
        return (yield from _with_proof(controller, command, limit, before))
    count = max(len(parse_line(command).statements), 1)
    answer = yield Send(data_line(command), Prompts(count), limit, refusal_s=0.05)
    return (yield from _reply(controller, answer, command, limit))


def _listed(controller: Controller, command: str) -> Steps[Reply]:
    """`UL`: where a program runs and may print, what it holds is told from what it prints as far as it is known."""
    known, quiet = controller.listing, controller.waiting.position == frozenset()
    answer = yield Send(data_line(command), Upload(known=known, prints=not quiet), timeout_s=1.0, extends=True)
    if answer.reading is None:
        return Reply(answer.text, answer.kind is Kind.ACCEPTED, answer.certain)
    if known is not None and answer.reading.holds(known):
        answer.reading.decide(known)
        return Reply(known, True)
    return Reply(answer.reading.decide_alone(), True, certain=False)


def _enter(controller: Controller, command: str, name: str) -> Steps[Reply]:
    """DL, QD and ED answer nothing but a refusal; from here on lines belong to them, and reading rests."""
    answer = yield Send(data_line(command), Prompts(1), 0.2, hold=True)
    if answer.kind is Kind.REFUSED:
        return (yield from _reply(controller, answer, command, USUAL_S))
    controller.waiting.entry = name
    controller.door.question = controller.waiting.question
    return Reply(answer.text, True, False)


def _entered(controller: Controller, line: str) -> Steps[Reply]:
    """A line of a program or an array typed by hand; a backslash ends it."""
    if "\\" not in line:
        yield Send(data_line(line), answers_prompt=True)
        return Reply("", True, False)
    end = b"\x11" if controller.waiting.entry == "ED" else b"\\"
    rest = line.partition("\\")[0].encode("ascii")
    answer = yield Send(rest + end, Prompts(1), USUAL_S, answers_prompt=True)
    controller.waiting.entry = ""
    controller.door.question = controller.waiting.question
    return (yield from _reply(controller, answer, line, USUAL_S))


def _plain(command: str, found: list[str], controller: Controller) -> bool:
    columns = controller.model.columns if controller.model is not None else 40
    line = parse_line(command)
    broken = any(isinstance(s, nodes.Broken | nodes.Foreign | nodes.Comment | nodes.Label) for s in line.statements)
    fits = len(command) + 1 + FRAME_COLUMNS <= columns
    return (
        bool(line.statements) and fits and not broken and not ALONE & set(found) and not re.search(r"[%!\\]", command)
    )


def _with_proof(controller: Controller, command: str, limit: float, before: int) -> Steps[Reply]:
    """The frame behind the command comes only when the command was accepted."""
    nonce = next(controller.nonces)
    line, proof = with_proof(nonce, command)
    answer = yield Send(line, proof, limit, refusal_s=0.05)
    if controller.waiting.position != frozenset() and proof.count not in (None, len(answer.text.splitlines())):
        answer = replace(answer, certain=False)  # a line of the program that runs may be among them
    return (yield from _reply(controller, answer, command, limit, nonce, before))


def _reply(
    controller: Controller, answer: Answer, command: str, limit: float, nonce: str = "", before: int = 0
) -> Steps[Reply]:
    """What an answer means; a refusal is proved by a later read, which also tells the reason."""
    reply = yield from _judged(controller, answer, command, limit, nonce, before)
    controller.link.note("<", f"{reply.text}\n:".lstrip("\n") if reply.accepted else f"? {reply.reason}", "user")
    return reply


def _judged(
    controller: Controller, answer: Answer, command: str, limit: float, nonce: str, before: int
) -> Steps[Reply]:
    """`before`: the error code that stood there already; a `?` of a program's text makes no refusal of it."""
    if answer.kind is Kind.ACCEPTED:
        return Reply(answer.text, True, answer.certain)
    if answer.kind is Kind.SILENT:
        raise LinkLost(f"No answer to “{command}”.")
    left = controller.link.wire.left
    fenced = yield from fence(controller.nonces, max(limit, 0.6))
    if nonce and nonce in left.seen:
        return Reply("", True, False)
    code = int(fenced.values[0]) if fenced.kind is Kind.VALUES else 0
    stands = answer.kind is Kind.REFUSED or answer.refused
    refused = stands or ("?" in answer.text and code != before)
    if not refused or not code:
        raise LinkLost(f"No clear answer to “{command}”; look whether it was carried out.")
    if not stands:
        left.strip_question()
    words = ERROR_TEXTS.get(code, "unknown error")
    return Reply("", False, True, code, f"{command}: refused, error {code}, {words}.")


def addressed(controller: Controller, address: int, steps: Steps[T]) -> Steps[T]:
    """`%n` first: whoever talked on the line meanwhile may have chosen another (dmc-1412-1414.txt l.1305)."""
    if not controller.waiting.question:
        choice = yield Send(choose(address), Prompts(1), 1.0)
        if choice.kind is Kind.SILENT:
            steps.close()
            raise LinkLost(f"No controller with address {address} answers in the chain.")
    return (yield from steps)


def read(controller: Controller, expressions: Sequence[str]) -> Steps[tuple[float, ...]]:
    """Expressions one by one, each framed; a refused one raises Refused."""
    values: list[float] = []
    for expression in expressions:
        answer = yield from read_once(controller.nonces, (expression, Shape(10, 4)))
        if answer.kind is not Kind.VALUES:
            raise (yield from reason(controller, answer, expression))
        values += answer.values
    return tuple(values)


def reason(controller: Controller, answer: Answer, expression: str) -> Steps[LinkError]:
    """Why a read was not answered, as the error to raise."""
    if answer.kind is Kind.SILENT:
        return LinkLost(f"No answer when reading {expression}.")
    fenced = yield from fence(controller.nonces)
    if fenced.kind is Kind.VALUES and "?" in answer.text:
        code = int(fenced.values[0])
        return Refused(
            code, f"{expression} cannot be read here: error {code}, {ERROR_TEXTS.get(code, 'unknown error')}."
        )
    return LinkLost(f"Reading {expression} was disturbed; try again.")


def halt(controller: Controller) -> Steps[Reply]:
    """`HX`, then `ST`."""
    answer = yield from proved(controller.nonces, "HX;ST", USUAL_S)
    return (yield from _reply(controller, answer, "HX;ST", USUAL_S))


def _before_start(controller: Controller) -> Steps[int]:
    """Before a program starts: its listing (whether it asks decides what may be sent), and the error code there is."""
    if controller.waiting.listing is None:
        text = yield from held_program(controller.waiting, controller.nonces)
        controller.waiting.listing = Listing(text)
    if controller.waiting.position == frozenset():
        return 0  # nothing runs: no program's text can come in between
    answer = yield from fence(controller.nonces)
    return int(answer.values[0]) if answer.kind is Kind.VALUES else 0


def sent(controller: Controller, data: bytes, source: str) -> None:
    """Keeps account of what a line changes: a program started, edited, erased; the port turned into a data port."""
    if source in ("poll", "stop") or not data.endswith(b"\r") or not data.isascii():
        return
    statements = parse_line(data[:-1].decode("ascii")).statements
    begins = source != SETTLING and not only_reads(data) and not all(map(starts_nothing, statements))
    if controller.stop_state is StopState.STOPPED and begins:
        controller.show_stop(StopState.READY)
    for statement in statements:
        if not isinstance(statement, nodes.Command):
            continue
        if statement.name == "XQ":
            controller.waiting.started(_target(statement))
        elif statement.name in REPLACES and source == "user":
            controller.set_listing(None)
        elif statement.name == "CI" and len(statement.arguments) > 2:
            third = statement.arguments[2]
            controller.waiting.data_mode = isinstance(third, nodes.Number) and third.scaled != 0
            controller.door.question = controller.waiting.question


def starts_nothing(statement: nodes.Statement) -> bool:
    """Whether it ends something, or only sets what a later start will use."""
    if not isinstance(statement, nodes.Command):
        return isinstance(statement, nodes.Nothing)
    settings = {name for name in parameter_names(MODELS["ssc4"]) if name not in ACTING}
    return statement.name in ENDING or statement.name in settings


def _target(statement: nodes.Command) -> str:
    target = statement.arguments[0] if statement.arguments else None
    if isinstance(target, nodes.Target):
        if target.label is not None:
            return f"#{target.label}"
        if isinstance(target.line, nodes.Number):
            return str(target.line.scaled // nodes.ONE)
    return ""
