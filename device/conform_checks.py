"""The questions of the conformance script: each shows how a controller has one or more settings of the profile."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Final

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.rows import Row, Takes
from device.conform_expressions import assignments, brackets, division, numbers, operands
from device.conform_talk import NOBODY, Odd, Seen, Talk, highest
from device.simulator.twoletter.profile import ENDS
from device.simulator.twoletter.setting import Value

if TYPE_CHECKING:
    from device.conform import Session

Check = Callable[["Session"], Seen]

REFUSED: Final = {  # lines that every manual refuses, and that do nothing where they are accepted
    1: "QQ",
    2: f"JP #{NOBODY}",
    6: "LZ 9",
    11: f"LS #{NOBODY}",
    50: "PF",
    51: "TP ?",
    52: 'MG "abc',
    53: "MG {Q",
    55: f"DM {NOBODY}",
    58: "MG _QQX",
    59: "MG (1",
    82: f"MG {NOBODY}[0]",
}
RANGES: Final = {"TW": 1.0, "VR": 0.01, "VA": 1024.0, "FA": 0.25, "FV": 1.0}  # harmless at rest; what is one step more
UNLIKELY: Final = 1 << 24  # a limit beyond this is no limit
CLOCK_S: Final = 4.0
CLOCK_TOLERANCE: Final = 0.01


def prompts(session: Session) -> Seen:
    """How many prompts a line with two commands brings, and whether a return alone brings one."""
    talk = session.talk
    count = talk.line("NO;NO").data.count(b":")
    if count not in (1, 2):
        raise Odd(f"'NO;NO' brought {count} prompts")
    yield "prompt_per_command", count == 2
    yield "prompt_on_empty_line", talk.line("").data == b":"


def refused_line(session: Session) -> Seen:
    """Whether what stands behind a refused command is still carried out."""
    reply = session.talk.line('QQ;MG "Z9"')
    yield "error_ends_line", b"Z9" not in reply.data
    session.talk.code()


def longest_line(session: Session) -> Seen:
    """The longest line, by comments of the length asked."""

    def fits(count: int) -> bool:
        return session.talk.line("NO " + "x" * (count - 3)).accepted

    usual = session.assumed.line_characters
    if fits(usual) and not fits(usual + 1):
        yield "line_characters", usual
    else:
        yield "line_characters", highest(fits, 10, 512)
    session.talk.code()


def echo(session: Session) -> Seen:
    """What a return looks like in the echo; EO is set back."""
    talk = session.talk
    talk.do("EO 1")
    talk.echoing = False
    came = talk.line("NO").data
    talk.echoing = True
    talk.do("EO 0")
    talk.echoing = False
    if not came.startswith(b"NO\r"):
        raise Odd(f"EO1 echoed 'NO' as {came!r}")
    yield "echo_return", "CR LF" if came.startswith(b"NO\r\n") else "CR"


def revision(session: Session) -> Seen:
    """What ^R^V tells behind the type."""
    found = re.match(r"\S+ (.*)", session.named)
    if found is None:
        raise Odd(f"it names itself {session.named!r}")
    yield "revision", found.group(1)
    yield "copyright", session.talk.ask("CW")
    yield "serial_number", int(session.talk.number("_BN", "F10.0"))


def upload(session: Session) -> Seen:
    """What ends a program, and how many labels there are."""
    reply = session.talk.say(b"UL\r", "UL")
    if not reply.accepted:
        raise reply.odd()
    text = reply.data[:-1]
    yield "program_end", _end(text, empty=not text.replace(b"\x1a", b"").strip())
    lines = text.replace(b"\x1a", b"").decode("ascii").split("\r\n")
    if session.model.family == "ssc":
        used = len({label for line in lines for label in re.findall(r"(?:^|;)\s*#\s*([A-Za-z][A-Za-z0-9]*)", line)})
        yield "labels", used + int(session.talk.number("_DL", "F5.0"))


def _end(text: bytes, *, empty: bool) -> str:
    """What stands behind the line end of the last line."""
    for name in ("^Z CR LF", "^Z"):
        if text.endswith(ENDS[name]):
            return name
    whole = b"" if empty else b"\r\n"
    return "CR LF" if text.endswith(whole + b"\r\n") else "nothing"


def arrays(session: Session) -> Seen:
    """An array of our own: how it is uploaded, and what is refused about arrays."""
    talk, name = session.talk, session.free_array()
    talk.do(f"DM {name}[2]")
    session.restore(f"DA {name}[0]", name)
    reply = talk.line(f"QU {name}[],0,1,1")
    if not reply.accepted:
        raise reply.odd()
    yield "array_end", _end(reply.data[:-1], empty=False)
    with session.kept("VF"):
        talk.do("VF 3.1")
        shown = talk.line(f"QU {name}[],0,0,1").text
        yield "array_format", "VF" if re.match(r" ?\d{3}\.\d(?!\d)", shown) else "10.4"
    yield "dimension_again_code", talk.refusal(f"DM {name}[2]")
    yield "codes.56", talk.refusal(f"MG {name}[99]")
    free = int(re.sub(r"\D", "", talk.ask("DM ?")))
    yield "codes.66", talk.refusal(f"DM {NOBODY}[{free + 1}]")
    if talk.line(f"MG {NOBODY}[0]").accepted:
        talk.do(f"DA {NOBODY}[0]")
    talk.code()
    yield "deallocate_missing_code", talk.refusal(f"DA {NOBODY}[0]")
    session.put_back(name)


def codes(session: Session) -> Seen:
    """The code of each line that is refused."""
    with session.kept("PF"):  # should it be accepted after all
        for code, line in REFUSED.items():
            yield f"codes.{code}", session.talk.refusal(line)
    session.talk.do("LZ 0")
    if len(session.model.axes) < 4:
        yield "codes.90", session.talk.refusal("TP W")
    yield "undefined_variable_code", session.talk.refusal(f"MG {NOBODY}")


def error_code(session: Session) -> Seen:
    """What clears the error code, and how TC1 says it."""
    talk = session.talk

    def refused() -> None:
        if not talk.line("QQ").refused:
            raise Odd("'QQ' was not refused")

    refused()
    talk.line("NO")
    by_command = talk.number("_TC", "F3.0") == 0
    yield "error_code_cleared_by_good_command", by_command
    if not by_command:
        refused()
        talk.number("_TC", "F3.0")
        yield "error_code_cleared_by_operand", talk.number("_TC", "F3.0") == 0
        refused()
        talk.code()
        yield "error_code_cleared_by_reading", talk.code() == 0
    code = talk.refusal("QQ")
    refused()
    text = talk.line("TC1").text.strip()
    forms = (("1 text", f"{code} [A-Z]"), ("001 text", f"{code:03d} [A-Z]"), ("001 - text", f"{code:03d} - [A-Z]"))
    for form, pattern in forms:
        if re.match(pattern, text):
            yield "error_text", form
            return
    raise Odd(f"'TC1' was answered by {text!r}")


def formats(session: Session) -> Seen:
    """Digits and decimals of every answer that is not formatted by PF, and the sign column of the status bytes."""
    signs = set()
    for row in COMMANDS.values():
        if row.reply in (None, "PF") or not row.known_to(session.model) or not row.port:
            continue
        axis = "X" if row.takes in (Takes.AXES, Takes.AXES_OR_ONE) else ""
        line = f"{row.name}{axis}" if row.tells else f"{row.name} ?"
        sign, whole, decimals = session.talk.again(partial(_shape, session.talk, line))
        yield f"commands.{row.name}.reply", f"{len(whole)}.{len(decimals)}"
        if row.name in ("TI", "TB", "TC", "SC", "TS"):
            signs.add(bool(sign))
    if len(signs) != 1:
        raise Odd("some of TI TB TC SC TS have a sign column, some have none")
    yield "status_sign", signs.pop()


def _shape(talk: Talk, line: str) -> tuple[str, str, str]:
    """Sign column, digits and decimals of an answer."""
    reply = talk.line(line)
    found = re.fullmatch(r"([ -]?)(\d+)(?:\.(\d+))?", reply.text)
    if not reply.accepted or found is None:
        raise reply.odd()
    return found.group(1), found.group(2), found.group(3) or ""


def ranges(session: Session) -> Seen:
    """How high some harmless numbers may be; each is set back."""
    for name, step in RANGES.items():
        row = COMMANDS[name]
        high = row.range_for(session.model)[1]
        if row.known_to(session.model) and high is not None and row.reply is not None:
            with session.kept(name):
                yield f"commands.{name}.high", _highest(session.talk, row, float(high), step)


def _highest(talk: Talk, row: Row, high: float, step: float) -> Value:
    def fits(steps: int) -> bool:
        return talk.line(f"{row.name} {_plain(steps * step)}").accepted

    steps = round(high / step)
    if fits(steps) and not fits(steps + 1):
        return row.high if row.high is not None else high
    most = highest(fits, 1, min(UNLIKELY * 256, (1 << 31) - 1 if step >= 1 else UNLIKELY * 64) // max(1, int(step)))
    found = most * step
    return int(found) if found == int(found) else round(found, 4)


def _plain(number: float) -> str:
    return f"{number:.4f}".rstrip("0").rstrip(".")


def grain(session: Session) -> Seen:
    """Whether AC keeps multiples of 1024 only; it is set back."""
    with session.kept("AC"):
        session.talk.do("AC 150000")
        kept = int(session.talk.number("_ACX", "F10.0"))
    if kept not in (149504, 150000):
        raise Odd(f"AC 150000 is kept as {kept}")
    yield "commands.AC.step", 1024 if kept == 149504 else 1


def clock(session: Session) -> Seen:
    """The rate of TIME against our clock."""
    talk = session.talk
    sample = talk.number("_TM", "F5.0")
    if sample <= 0:
        raise Odd("the sample clock comes from another controller (TM is negative)")
    first, began = talk.number("TIME", "F10.0"), session.clock()
    talk.listen(CLOCK_S)
    while session.clock() - began < CLOCK_S:
        talk.listen(CLOCK_S / 10)
    rate = (talk.number("TIME", "F10.0") - first) / (session.clock() - began) * sample / 1000
    for known in (1024, 1000):
        if abs(rate / known - 1) < CLOCK_TOLERANCE:
            yield "samples_per_second", known
            return
    raise Odd(f"TIME counts {rate:.1f} a second at TM 1000")


def data_mode(session: Session) -> Seen:
    """Whether CI ,,1 takes effect while no program runs; left by escape (dmc-1412-1414.txt l.3526) and set back."""
    talk = session.talk
    talk.do("CI ,,1")
    session.restore("CI ,,0", "CI")
    alone = not talk.line("NO").data
    if alone:
        talk.say(b"\x1b")
    session.put_back("CI")
    yield "data_mode_alone", alone


def marks(session: Session) -> Seen:
    """Whether CW1 marks what MG sends when it is typed; only where --cw tells what CW is set to."""
    if session.cw is None:
        return
    talk = session.talk
    talk.do("CW 1")
    session.restore(f"CW {session.cw}", "CW")
    raw = talk.line('MG "Z9"').raw
    session.put_back("CW")
    yield "typed_message_marked", bytes((ord("Z") | 0x80,)) in raw


CHECKS: Final[tuple[tuple[str, Check], ...]] = (
    ("prompts", prompts),
    ("what follows a refusal", refused_line),
    ("error codes", codes),
    ("the error code's life", error_code),
    ("name and number", revision),
    ("echo", echo),
    ("formats", formats),
    ("numbers", numbers),
    ("division", division),
    ("brackets", brackets),
    ("assignments", assignments),
    ("operands of threads", operands),
    ("ranges", ranges),
    ("rounding of AC", grain),
    ("arrays", arrays),
    ("upload", upload),
    ("longest line", longest_line),
    ("data mode", data_mode),
    ("marks", marks),
    ("clock", clock),
)
