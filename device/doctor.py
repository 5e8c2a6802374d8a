"""What is wrong with a connection, in words: listens first, sends only a carriage return and control-R control-V.

Where nothing comes back at any speed it also calls the eight addresses of a daisy chain (`%0` to `%7`). Every diagnosis
is one sentence and the next steps.
"""

from __future__ import annotations

import errno
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

from codegen.models import Model
from codegen.rates import RATES, setting_words
from device.doctor_answers import PROMPT, Answered, judged
from device.doctor_ports import group_of, holders
from device.doctor_steps import BEHIND_A_SOCKET, ECHOED, HELD, NO_CTS, STRAIGHT
from device.door import REVISION, choose
from device.download import Job
from device.find import ports
from device.identify import model_of
from device.transport import LineSettings, OpenFailed, Transport, TransportLost, Wired, open_transport

LISTEN_S = 0.3
ANSWER_S = 0.7
TRY_S = 0.35  # for an answer at another speed
QUIET_S = 0.06  # after a prompt: then it is all
SPEEDS = (9600, 19200, 38400, 4800, 1200, 300)
ADDRESSES = 8  # of a daisy chain (dmc-1412-1414.txt l.1302)
SHOWN = 40  # characters of a foreign answer


class Trouble(StrEnum):
    """What was found."""

    NONE = "fine"
    ADDRESS = "no address"
    MISSING = "port missing"
    PERMISSION = "no permission"
    BUSY = "busy"
    SILENT = "silence"
    ADDRESSED = "another address was called"
    HELD = "not clear to send"
    ECHO = "own echo"
    SPEED = "another speed"
    GARBAGE = "garbage"
    FOREIGN = "no controller of ours"
    NOT_WIRED = "handshake not wired"
    LOST = "connection broke"
    CANCELLED = "cancelled"


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """One sentence, the next steps, and what to set: `baud` is where the controller answers."""

    trouble: Trouble
    sentence: str
    steps: tuple[str, ...] = ()
    baud: int | None = None
    text: str = ""
    model: Model | None = None

    @property
    def fine(self) -> bool:
        return self.trouble is Trouble.NONE

    @property
    def of_the_line(self) -> bool:
        """Whether something is wrong between the port and the controller, not with the port or this computer."""
        line = (Trouble.SILENT, Trouble.HELD, Trouble.SPEED, Trouble.GARBAGE, Trouble.NOT_WIRED, Trouble.LOST)
        return self.trouble in line

    @property
    def words(self) -> str:
        """The sentence, then the steps, a line each."""
        return "\n".join([self.sentence, *(f"  - {step}" for step in self.steps)])


class Cancelled(Exception):
    """The person gave up."""


class Doctor:
    """One examination of one address."""

    def __init__(
        self,
        address: str,
        line: LineSettings,
        job: Job[Diagnosis],
        *,
        open_: Callable[[str, LineSettings], Transport] = open_transport,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.address, self.line, self.job = address, line, job
        self._open, self._clock = open_, clock
        self._done = 0

    def examine(self) -> Diagnosis:
        """Everything in order; never raises for what the world does."""
        try:
            return self._examine()
        except OpenFailed as reason:
            return self._not_opened(reason)
        except TransportLost as reason:
            return Diagnosis(Trouble.LOST, str(reason), ("Plug the adapter in again and repeat this.",))
        except Cancelled:
            return Diagnosis(Trouble.CANCELLED, "The examination was cancelled; nothing was changed.")

    # ------------------------------------------------------------ the course

    def _examine(self) -> Diagnosis:
        self._say(f"Opening {self.address}")
        transport = self._open(self.address, self.line)
        try:
            if others := holders(self.address):
                return self._busy(others)
            self._say("Listening")
            heard = self._listen(transport, LISTEN_S)
            self._say(f"Asking{self._speed}")
            came = self._ask(transport, ANSWER_S)
            what, ready = judged(came), _clear(transport)
            if what is Answered.PROMPT:
                return self._who(transport, ready) if self.line.address is None else self._in_chain(transport, ready)
        finally:
            transport.close()
        if what is Answered.ECHO:
            return self._echo()
        if what is Answered.TEXT and judged(heard) is not Answered.GARBAGE:
            return self._foreign(came)
        handshake = self.line.handshake in ("rts", "both") and not self._has_no_speed
        if handshake and (found := self._without_handshake()):
            return found
        if found := self._other_speeds():
            return found
        if what is Answered.GARBAGE or judged(heard) is Answered.GARBAGE:
            return self._garbage()
        return (None if came or heard else self._by_address()) or self._silent(ready)

    def _by_address(self) -> Diagnosis | None:
        """One that is not called by its number says nothing, not even a prompt (dmc-1412-1414.txt l.1304)."""
        self._say("Calling the addresses of a daisy chain")
        transport = self._open(self.address, self.line)
        try:
            for number in range(ADDRESSES):
                if self._calls(transport, number):
                    return self._called(number, self._who(transport, None))
        finally:
            transport.close()
        return None

    def _in_chain(self, transport: Transport, ready: bool | None) -> Diagnosis:
        """Whether the address answers that will be called; if not, those that do."""
        wanted = self.line.address
        self._say(f"Calling address {wanted}")
        if wanted is not None and self._calls(transport, wanted):
            return self._who(transport, ready)
        there = [number for number in range(ADDRESSES) if number != wanted and self._calls(transport, number)]
        if there:
            self._calls(transport, there[0])  # the last one that was called may not exist
        return Diagnosis(
            Trouble.ADDRESSED,
            f"No controller with address {wanted} answers at {self.address}; these do: "
            f"{', '.join(map(str, there)) or 'none'}.",
            ("Choose one of these where you connect.", "Or look at address and power of the missing one."),
            self.line.baud,
        )

    def _calls(self, transport: Transport, number: int) -> bool:
        """Calls an address; whether somebody prompts."""
        transport.write(choose(number))
        return judged(self._listen(transport, TRY_S, prompt=True)) is Answered.PROMPT

    def _called(self, number: int, found: Diagnosis) -> Diagnosis:
        return Diagnosis(
            Trouble.ADDRESSED,
            f"The controller at {self.address} has the address {number} and was silent because another one was called "
            f"(% and a number); now it listens again.",
            (
                "Connect: it goes on listening until another address is called.",
                "In a daisy chain every other controller is silent now; % and its number calls it.",
            ),
            *(self.line.baud, found.text, found.model),
        )

    def _without_handshake(self) -> Diagnosis | None:
        """The same speed without RTS/CTS: whoever answers now is held by a line that is not there."""
        self._say("Asking without handshake")
        found = self._try(replace(self.line, handshake="none"))
        if found is None or found.trouble is not Trouble.NONE:
            return None
        return Diagnosis(
            Trouble.NOT_WIRED,
            f"The controller at {self.address} answers only without handshake: the CTS line of the cable is not wired.",
            NO_CTS,
            self.line.baud,
            found.text,
            found.model,
        )

    def _other_speeds(self) -> Diagnosis | None:
        if self.line.baud is None or self._has_no_speed:
            return None
        for baud in (each for each in SPEEDS if each != self.line.baud and each in RATES):
            self._say(f"Asking at {baud} baud")
            found = self._try(replace(self.line, baud=baud, handshake="none"))
            if found is not None and found.fine:
                if late := self._try(self.line):  # it was only slow, or the speed does not matter (USB)
                    return late
                here = setting_words(self.line.baud, found.model)
                steps = [f"Choose {baud} baud here."]
                steps += (
                    [f"Or set the controller to {self.line.baud} baud ({here}) and switch it off and on."]
                    if here
                    else []
                )
                there = setting_words(baud, found.model)
                return Diagnosis(
                    Trouble.SPEED,
                    f"The controller at {self.address} answers at {baud} baud ({there}), not at {self.line.baud}.",
                    tuple(steps),
                    baud,
                    found.text,
                    found.model,
                )  # fmt: skip
        return None

    def _try(self, line: LineSettings) -> Diagnosis | None:
        """A carriage return with other settings."""
        transport = self._open(self.address, line)
        try:
            self._listen(transport, QUIET_S)
            came = self._ask(transport, TRY_S)
            if judged(came) is not Answered.PROMPT:
                self._listen(transport, QUIET_S)
                came = self._ask(transport, TRY_S) if came else b""  # half a line of garbage stood there
            return self._who(transport, None) if judged(came) is Answered.PROMPT else None
        finally:
            transport.close()

    def _who(self, transport: Transport, ready: bool | None) -> Diagnosis:
        """It prompts like a controller: its revision."""
        transport.write(REVISION)
        came = bytes(byte & 0x7F for byte in self._listen(transport, ANSWER_S, prompt=True))
        lines = [line.strip() for line in came.decode("ascii").replace("\n", "\r").split("\r")]
        text = next((line for line in reversed(lines) if len(line) > 3 and line[:1] not in ":?"), "")
        model = model_of(text)
        name = model.title if model is not None else "a controller of unknown type"
        told = f"{text} ({name})" if text else "a controller that does not name itself"
        steps = []
        if model is None:
            steps.append("Choose the type by hand when you connect.")
        if ready is False:
            steps.append("CTS is low although it answers: leave the handshake at “none” with this cable.")
        return Diagnosis(
            Trouble.NONE, f"{self.address}{self._speed}: {told} answers.", tuple(steps), self.line.baud, text, model
        )

    # ---------------------------------------------------------- the diagnoses

    def _not_opened(self, reason: OpenFailed) -> Diagnosis:
        """From the system's own error number, as far as there is one."""
        cause = reason.__cause__
        number, text = getattr(cause, "errno", None), str(cause).lower()
        if self.address.startswith("socket://"):
            trouble = Trouble.MISSING if cause is not None else Trouble.ADDRESS
            return Diagnosis(trouble, str(reason), ("Is the device server or simulator switched on?",))
        if number == errno.EACCES or "permission" in text:
            group = group_of(self.address)
            return Diagnosis(
                Trouble.PERMISSION,
                f"You have no permission to open {self.address}; it belongs to the group “{group}”.",
                (f'Run "sudo usermod -aG {group} $USER", then log out and in again.',),
            )
        if number in (errno.EBUSY, errno.EWOULDBLOCK) or "lock" in text or "busy" in text:
            return self._busy(holders(self.address))
        if number == errno.ENOENT or "no such file" in text or "could not find" in text:
            there = sorted(port.device for port in ports())
            known = f"There are: {', '.join(there)}." if there else "This computer has no serial port at all."
            return Diagnosis(
                Trouble.MISSING,
                f"There is no port {self.address}. {known}",
                ("Plug the adapter in and look whether its name appears (twoletter ports).",),
            )
        return Diagnosis(Trouble.MISSING, str(reason), ("Choose another port.",))

    def _busy(self, others: Sequence[str]) -> Diagnosis:
        whom = f"open in {' and in '.join(others)}" if others else "in use by another program"
        return Diagnosis(
            Trouble.BUSY,
            f"{self.address} is {whom}: answers would be lost between both.",
            ("Close the port there, and try again.",),
        )

    def _echo(self) -> Diagnosis:
        return Diagnosis(
            Trouble.ECHO,
            f"{self.address} gives back only what is sent: this computer hears itself.",
            ECHOED,
        )

    def _foreign(self, came: bytes) -> Diagnosis:
        shown = " ".join(came.decode("ascii", "replace").split())[:SHOWN]
        return Diagnosis(
            Trouble.FOREIGN,
            f"Something answers at {self.address} with “{shown}”, which is no prompt of a controller of ours; "
            "nothing more was sent to it.",
            ("Choose another port, or plug the cable into the controller.",),
        )

    def _garbage(self) -> Diagnosis:
        switches = setting_words(self.line.baud or 9600, None)
        return Diagnosis(
            Trouble.GARBAGE,
            f"What comes from {self.address} cannot be read, at none of the speeds a controller can be set to.",
            (
                f"Set the controller to {self.line.baud or 9600} baud ({switches}) and switch it off and on.",
                "The line must be 8 bits, no parity, 1 stop bit.",
                "Look for a loose plug, a long or unshielded cable, a missing ground.",
            ),
        )

    def _silent(self, ready: bool | None) -> Diagnosis:
        if self._has_no_speed:
            words = f"The connection to {self.address} is open, but nothing answers over it."
            return Diagnosis(Trouble.SILENT, words, BEHIND_A_SOCKET)
        if ready is False:
            return Diagnosis(
                Trouble.HELD,
                f"Nothing answers at {self.address}, and CTS is low: the other end does not say that it is ready.",
                HELD,
            )
        return Diagnosis(
            Trouble.SILENT,
            f"Nothing answers at {self.address}, at no speed.",
            (
                "Is the controller switched on? Its power light must be lit.",
                f"Transmit and receive may be crossed: use {STRAIGHT}, plugged into MAIN.",
                "Is it the right port? Pull the adapter out and see which name disappears (twoletter ports).",
                f"Set the controller to {self.line.baud or 9600} baud ({setting_words(self.line.baud or 9600, None)}).",
            ),
        )

    # -------------------------------------------------------------- the line

    @property
    def _has_no_speed(self) -> bool:
        """A socket: the speed is set where the serial line begins."""
        return "://" in self.address

    @property
    def _speed(self) -> str:
        """Behind the address, " at 9600 baud"."""
        if self._has_no_speed:
            return ""
        return f" at {self.line.baud} baud" if self.line.baud is not None else " at any speed"

    def _say(self, phase: str) -> None:
        if self.job.cancelled:
            raise Cancelled
        self._done += 1
        self.job.show(phase, self._done, 5 + len(SPEEDS))

    def _ask(self, transport: Transport, seconds: float) -> bytes:
        transport.write(b"\r")
        return self._listen(transport, seconds, prompt=True)

    def _listen(self, transport: Transport, seconds: float, prompt: bool = False) -> bytes:
        """What comes in this time; with `prompt` it ends early, shortly after a prompt."""
        end, came = self._clock() + seconds, b""
        while self._clock() < end:
            if self.job.cancelled:
                raise Cancelled
            data = transport.read(0.02)
            came += data
            if prompt and data and PROMPT.search(bytes(byte & 0x7F for byte in came)):
                end = min(end, self._clock() + QUIET_S)
        return came


def _clear(transport: Transport) -> bool | None:
    """CTS, where the port tells it."""
    return transport.clear_to_send() if isinstance(transport, Wired) else None


def examination(
    address: str,
    line: LineSettings | None = None,
    progress: Callable[[Job[Diagnosis]], None] | None = None,
    open_: Callable[[str, LineSettings], Transport] = open_transport,
) -> Job[Diagnosis]:
    """Begins one beside the caller; `job.cancel()` ends it, `job.future` gets the diagnosis."""
    job: Job[Diagnosis] = Job(progress)
    doctor = Doctor(address, line or LineSettings(), job, open_=open_)
    threading.Thread(target=lambda: job.future.set_result(doctor.examine()), name="doctor", daemon=True).start()
    return job
