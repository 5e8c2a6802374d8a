"""Who is there: revision text, controller type, axes and serial number; an unknown text is never guessed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from codegen.models import MODELS, Model
from device.door import choose
from device.tasks import LinkLost, Send, Steps, Wait
from device.wire import Answer, Frame, Kind, Prompts, Proof, Revision, Shape, framed

if TYPE_CHECKING:
    from codegen.setup import Setup

LISTEN_S = 0.1
REVISION = b"\x12\x16"
TEXTS = ((r"DMC ?-?15([1-4])0\b", "ssc{}"), (r"\bSSC ?-?([1-4])\b", "ssc{}"), (r"DMC ?-?(1412|1414)\b", "dmc{}"))


@dataclass(frozen=True, slots=True)
class Identity:
    """What the controller said about itself; `model` None when its text is not known."""

    text: str
    model: Model | None
    axes: str
    serial: int | None = None


def model_of(text: str) -> Model | None:
    """The controller type a revision text names, or None: never a guess."""
    for pattern, name in TEXTS:
        match = re.search(pattern, text, re.IGNORECASE)
        if match is not None:
            return MODELS.get(name.format(match.group(1)))
    return None


def who(identity: Identity | None, model: Model | None) -> str:
    """Which controller is connected, in words: what it calls itself, its type, its serial number."""
    if identity is None:
        return "a controller that was not asked yet"
    kind = model.title if model is not None else "of unknown type"
    number = f"serial number {identity.serial}" if identity.serial else "no serial number"
    return f"{identity.text or 'a controller without a name'} ({kind}; {number})"


def mismatch(identity: Identity | None, model: Model | None, setup: Setup) -> str:
    """How the connected controller differs from the one a setup was written for, as one sentence, or nothing.

    A serial number counts where the setup states one; a controller without one (0) cannot prove that it is the same.
    """
    written = f"The setup was written for {setup.limits.title}"
    wanted = setup.serial_number.strip()
    if identity is None or model is None or model.name != setup.model:
        return f"{written}; connected is {who(identity, model)}."
    if identity.axes and identity.axes != setup.letters:
        return f"{written}; the controller tells of {len(identity.axes)}: {identity.axes}."
    if wanted and not (wanted.isdigit() and identity.serial and int(wanted) == identity.serial):
        return f"{written} with serial number {wanted}; connected is {who(identity, model)}."
    return ""


def identify(nonces: Iterator[str], address: int | None = None) -> Steps[Identity]:
    """Listens, then asks for the revision; where the text is unknown, counts the axes in the answer to TP."""
    yield Wait(LISTEN_S)
    if address is not None:
        yield Send(choose(address), Prompts(1), timeout_s=1.0)
    text = yield from _revision()
    if not text:
        if (yield Send(b"\r", Prompts(1), timeout_s=1.0)).kind is Kind.SILENT:
            raise LinkLost(_nobody(address))
        text = yield from _revision()  # the answer was late or disturbed
    model = model_of(text)
    serial = yield from _serial(nonces)
    if model is not None:
        return Identity(text, model, model.axes, serial)
    axes = yield from _count_axes(nonces)
    if not text and not axes:
        raise LinkLost(_nobody(address))
    return Identity(text, None, axes, serial)


def _nobody(address: int | None) -> str:
    if address is not None:
        return f"No controller with address {address} answers in the chain; check SA, CC, cables and power."
    return "Nothing that speaks two-letter code answers here; check speed, cable and power."


def _revision() -> Steps[str]:
    answer = yield Send(REVISION, Revision(), timeout_s=1.0)
    return answer.text if answer.kind is Kind.ACCEPTED else ""


def _serial(nonces: Iterator[str]) -> Steps[int | None]:
    answer = yield from read_surely(nonces, ("_BN", Shape(10, 0)))
    return int(answer.values[0]) if answer.kind is Kind.VALUES else None


def _count_axes(nonces: Iterator[str]) -> Steps[str]:
    nonce = next(nonces)
    answer = yield Send(f"TP;{framed(nonce, ())}\r".encode(), Proof(nonce), timeout_s=1.0)
    if answer.kind is not Kind.ACCEPTED or not answer.certain or not answer.text:
        return ""
    return "XYZW"[: answer.text.count(",") + 1]


def read_once(nonces: Iterator[str], *reads: tuple[str, Shape], timeout_s: float = 0.6) -> Steps[Answer]:
    """One framed read."""
    nonce = next(nonces)
    shapes = tuple(shape for _, shape in reads)
    return (yield Send(framed(nonce, reads).encode() + b"\r", Frame(nonce, shapes), timeout_s, refusal_s=0.05))


def read_surely(nonces: Iterator[str], *reads: tuple[str, Shape]) -> Steps[Answer]:
    """A read that is asked once more where it was disturbed (by half a line somebody left, for instance)."""
    answer = yield from read_once(nonces, *reads)
    if answer.kind is not Kind.VALUES:
        answer = yield from read_once(nonces, *reads)
    return answer


def fence(nonces: Iterator[str], timeout_s: float = 0.6) -> Steps[Answer]:
    """A read that is always valid: once it is answered, everything sent before it has been worked off."""
    return (yield from read_once(nonces, ("_TC", Shape(3, 0)), timeout_s=timeout_s))
