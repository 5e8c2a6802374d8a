"""Bytes ↔ replies: whatever a program sends in between, a read is right or discarded, never taken from other text."""

from __future__ import annotations

import time
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from device.wire import NOTHING, Frame, Kind, Prompts, Proof, Revision, Shape, Upload, Wire, framed, nonces

TEXT = st.text(alphabet=":?\r\n 0123456789-.ABab\"'", max_size=40).map(lambda text: text.encode("ascii"))
SHAPES = (Shape(10, 0), Shape(8, 0), Shape(2, 4), Shape(3, 0), Shape(10, 4))
VALUE = st.integers(-999, 999)


def as_sent(value: int, shape: Shape) -> bytes:
    """A number as a local format prints it: sign column, leading zeros (dmc-1412-1414.txt l.3676)."""
    whole = min(abs(value), 10**shape.digits - 1)
    text = f"{'-' if value < 0 else ' '}{whole:0{shape.digits}d}"
    return (text + ("." + "0" * shape.decimals if shape.decimals else "")).encode()


def reply(nonce: str, values: list[int], shapes: list[Shape]) -> bytes:
    body = b"".join(as_sent(value, shape) for value, shape in zip(values, shapes, strict=True))
    return b"\x1e" + nonce.encode() + body + b"\x1f\r\n:"


def fed(wire: Wire, data: bytes, cuts: list[int]) -> list[object]:
    """Feeds the bytes cut at these places; all answers that came out."""
    answers: list[object] = []
    places = sorted({cut % (len(data) + 1) for cut in cuts} | {0, len(data)})
    for start, end in pairwise(places):
        wire.feed(data[start:end])
        answer = wire.answer()
        if answer is not None:
            answers.append(answer)
    return answers


@given(st.data())
def test_a_read_between_any_texts_is_right_at_any_cut(data: st.DataObject) -> None:
    wire, marks = Wire(), nonces()
    pending = b""
    told = b""
    for _ in range(data.draw(st.integers(1, 4))):
        shapes = data.draw(st.lists(st.sampled_from(SHAPES), min_size=1, max_size=4))
        values = [data.draw(VALUE) if shape.digits > 2 else data.draw(st.integers(-99, 99)) for shape in shapes]
        before, after = data.draw(TEXT), data.draw(TEXT)
        nonce = next(marks)
        wire.expect(Frame(nonce, tuple(shapes)), framed(nonce, [("_TPX", shape) for shape in shapes]))
        stream = pending + before + reply(nonce, values, shapes) + after
        answers = fed(wire, stream, data.draw(st.lists(st.integers(0, 500), max_size=6)))
        assert len(answers) == 1
        assert answers[0].kind is Kind.VALUES
        assert answers[0].values == tuple(float(value) for value in values)
        told += before + after
    seen = "\n".join([*wire.left.lines(), wire.left.rest])
    assert seen.replace("\r", "").replace("\n", "") == told.decode().replace("\r", "").replace("\n", "")


@given(st.data())
def test_text_inside_a_frame_spoils_it_but_is_never_taken_for_a_value(data: st.DataObject) -> None:
    shapes = data.draw(st.lists(st.sampled_from(SHAPES), min_size=1, max_size=3))
    values = [data.draw(st.integers(-99, 99)) for _ in shapes]
    whole = reply("aa", values, shapes)
    stream = whole
    for _ in range(data.draw(st.integers(1, 3))):
        place = data.draw(st.integers(0, len(stream)))
        stream = stream[:place] + data.draw(TEXT) + stream[place:]
    wire = Wire()
    wire.expect(Frame("aa", tuple(shapes)))
    answers = fed(wire, stream, data.draw(st.lists(st.integers(0, 500), max_size=6)))
    answer = answers[0] if answers else wire.give_up()
    if answer.kind is Kind.VALUES:
        assert answer.values == tuple(float(value) for value in values)
    else:
        assert answer.kind is Kind.UNCERTAIN
        assert answer.values == ()


@given(TEXT, st.lists(st.integers(0, 200), max_size=4))
def test_an_accepted_command_is_proved_between_any_texts(text: bytes, cuts: list[int]) -> None:
    wire = Wire()
    wire.expect(Proof("ab", 1, NOTHING), 'SP 5;MG{^30},"ab",{^31}')
    answers = fed(wire, text + b":" + b"\x1eab\x1f\r\n:" + text, cuts)
    assert [answer.kind for answer in answers] == [Kind.ACCEPTED]
    assert answers[0].text == ""


@given(TEXT, st.lists(st.integers(0, 200), max_size=4))
def test_a_refused_command_is_never_taken_for_accepted(text: bytes, cuts: list[int]) -> None:
    wire = Wire()
    wire.expect(Proof("ab", 1, NOTHING), 'SP 5;MG{^30},"ab",{^31}')
    assert fed(wire, text + b"?" + text, cuts) == []
    assert wire.question
    assert wire.give_up().kind is Kind.UNCERTAIN


@given(st.lists(st.integers(0, 60), max_size=5))
def test_the_mark_of_unsolicited_bytes_makes_no_difference(cuts: list[int]) -> None:
    """CW1 sets bit 7 of everything sent unasked, MG from the port included (dmc-1412-1414.txt l.1332)."""
    wire = Wire()
    wire.expect(Frame("aa", (Shape(10, 0),)))
    marked = bytes(byte | 0x80 for byte in b"HELLO\r\n\x1eaa-0000000021\x1f\r\n")
    answers = fed(wire, marked + b":", cuts)
    assert answers[0].values == (-21.0,)
    assert wire.left.lines() == ["HELLO"]
    assert wire.left.rest == ""


@given(st.booleans(), st.lists(st.integers(0, 80), max_size=5))
def test_echo_on_or_off_is_the_same(echo: bool, cuts: list[int]) -> None:
    wire = Wire()
    line = framed("aa", [("_TPX", Shape(10, 0))])
    wire.expect(Frame("aa", (Shape(10, 0),)), line)
    answers = fed(wire, (line.encode() + b"\r\n" if echo else b"") + b"\x1eaa 0000000007\x1f\r\n:", cuts)
    assert answers[0].values == (7.0,)
    assert wire.left.lines() == []
    assert wire.left.rest == ""


def test_an_old_frame_is_not_the_answer_to_a_new_request() -> None:
    wire = Wire()
    wire.expect(Frame("ab", (Shape(3, 0),)))
    wire.feed(b"\x1eaa 111\x1f\r\n:\x1eab 222\x1f\r\n:")
    answer = wire.answer()
    assert answer is not None
    assert answer.values == (222.0,)
    assert wire.left.lines() == []


def test_a_plain_command_counts_its_prompts() -> None:
    wire = Wire()
    wire.expect(Prompts(2))
    wire.feed(b":")
    assert wire.answer() is None
    wire.feed(b" 0000000021\r\n:")
    answer = wire.answer()
    assert answer is not None
    assert (answer.kind, answer.text) == (Kind.ACCEPTED, " 0000000021")


def test_data_of_a_proved_query() -> None:
    wire = Wire()
    wire.expect(Proof("ab", 1))
    wire.feed(b"-0000000009, 0000000005\r\n:\x1eab\x1f\r\n:")
    answer = wire.answer()
    assert answer is not None
    assert (answer.text, answer.certain) == ("-0000000009, 0000000005", True)


def test_a_query_with_text_in_between_is_uncertain() -> None:
    wire = Wire()
    wire.expect(Proof("ab", 1))
    wire.feed(b"12:30?\r\n 0000000021\r\n:\x1eab\x1f\r\n:")
    answer = wire.answer()
    assert answer is not None
    assert not answer.certain


def test_an_upload_ends_at_control_z() -> None:
    wire = Wire()
    wire.expect(Upload())
    wire.feed(b'#A\r\nMG "A:B?"\r\nEN\r\n\x1a')
    assert wire.answer() is None
    wire.feed(b"\r\n:")
    answer = wire.answer()
    assert answer is not None
    assert answer.text == '#A\r\nMG "A:B?"\r\nEN\r\n'


def test_the_revision() -> None:
    wire = Wire()
    wire.expect(Revision())
    wire.feed(b"DMC1540 Rev 2.0h\r\n:")
    answer = wire.answer()
    assert answer is not None
    assert answer.text == "DMC1540 Rev 2.0h"


def test_a_prompt_without_line_end_stands_there() -> None:
    wire = Wire()
    wire.feed(b"ENTER LENGTH")
    assert wire.left.rest == "ENTER LENGTH"
    assert wire.left.lines() == []


def test_silence_and_uncertainty_are_told_apart() -> None:
    wire = Wire()
    wire.expect(Frame("aa", (Shape(3, 0),)))
    assert wire.give_up().kind is Kind.SILENT
    wire.expect(Frame("ab", (Shape(3, 0),)))
    wire.feed(b"?")
    assert wire.give_up().kind is Kind.UNCERTAIN


def test_marks_repeat_only_after_1296() -> None:
    marks = nonces()
    assert len({next(marks) for _ in range(1296)}) == 1296


def test_a_long_upload_in_small_pieces_takes_little_time() -> None:
    """1000 lines of 80 characters, four bytes at a time, as they come at 19200 baud."""
    listing = "".join(f"NO {n:070d}\r\n" for n in range(1000))
    wire = Wire()
    wire.expect(Upload())
    stream = listing.encode() + b"\x1a\r\n:"
    start = time.process_time()
    answers = []
    for place in range(0, len(stream), 4):
        wire.feed(stream[place : place + 4])
        answers.append(wire.answer())
    assert time.process_time() - start < 2.0
    assert answers[-1] is not None
    assert answers[-1].text == listing


def test_prompts_that_a_stop_left_are_no_part_of_the_next_text() -> None:
    """`\\ST` in command mode is answered by `?`, the second `ST` by a prompt; then the proof of `ST;HX` comes."""
    wire = Wire()
    wire.left.owe(1)
    wire.left.owe(1)
    wire.expect(Proof("ab", 2, NOTHING))
    wire.feed(b"?:" + b"::" + b"\x1eab\x1f\r\n:")
    answer = wire.answer()
    assert answer is not None
    assert answer.kind is Kind.ACCEPTED
    wire.feed(b"?002 QQ 5\r\n")
    assert wire.left.lines() == ["?002 QQ 5"]


def test_prompts_of_commands_in_front_of_a_frame_are_no_text() -> None:
    wire = Wire()
    for nonce, came in (("ab", b"::"), ("cd", b":HELLO\r\n:")):
        wire.expect(Frame(nonce, (Shape(3, 0),), before=2))
        wire.feed(came + reply(nonce, [5], [Shape(3, 0)]))
        answer = wire.answer()
        assert answer is not None and answer.values == (5.0,)
        assert wire.left.rest == ""
    assert wire.left.lines() == ["HELLO"]
    wire.expect(Frame("ef", (Shape(3, 0),), before=1))
    wire.feed(b"?")  # refused: the rest of the line was not carried out
    assert wire.question and wire.give_up().kind is Kind.UNCERTAIN
    assert wire.left.rest == ""


LINES = st.lists(st.text(alphabet='A:? 0."', max_size=8).map(lambda text: f"A{text}"), max_size=2)


@given(st.data())
def test_a_refused_line_that_is_given_up_leaves_nothing_in_the_text(data: st.DataObject) -> None:
    """The `?` of a refusal stands where a line begins, behind the prompts of what was accepted on its line."""
    wire = Wire()
    told, stream = [], b""
    accepted = data.draw(st.integers(0, 3))
    for reply in [b":"] * accepted + [b"?"]:
        texts = data.draw(LINES)
        told += texts
        stream += b"".join(f"{text}\r\n".encode() for text in texts) + reply
    if data.draw(st.booleans()):
        wire.expect(Proof("ab", data.draw(st.integers(accepted + 1, 5)), NOTHING))
    else:
        wire.expect(Frame("ab", (Shape(3, 0),), before=accepted))
    assert fed(wire, stream, data.draw(st.lists(st.integers(0, 200), max_size=4))) == []
    answer = wire.give_up()
    assert (answer.kind, answer.refused) == (Kind.UNCERTAIN, True)
    assert wire.left.rest == ""
    behind = data.draw(st.text(alphabet=":?A", max_size=4))
    wire.feed(f"{behind}\r\n".encode())  # what comes afterwards is a program's, also where it looks like replies
    assert wire.left.lines() == [*told, behind]


def test_a_fault_behind_a_refusal_is_no_refusal() -> None:
    wire = Wire()
    wire.expect(Proof("ab", 1, NOTHING))
    wire.feed(b"??002 QQ 5\r\n")
    assert wire.give_up().refused
    assert wire.left.lines() == ["?002 QQ 5"]


def test_the_question_of_a_program_is_no_refusal() -> None:
    """A `?` at the end of a text stays, also where it is the text of an IN that stands there."""
    wire = Wire()
    wire.expect(Proof("ab", 1, NOTHING))
    wire.feed(b"LENGTH?")
    assert not wire.give_up().refused
    assert wire.left.rest == "LENGTH?"


def test_what_was_taken_for_a_refusal_comes_back_when_the_proof_comes_late() -> None:
    wire = Wire()
    wire.expect(Proof("ab", 1, NOTHING))
    wire.feed(b"?")  # a program sent it
    assert wire.give_up().refused
    wire.feed(b"\x1eab\x1f\r\n:")
    assert (wire.left.lines(), wire.left.rest) == (["?"], "")
    assert list(wire.left.seen) == ["ab"]


def test_a_proof_that_comes_late_leaves_none_of_its_prompts() -> None:
    wire = Wire()
    wire.expect(Proof("ab", 2, NOTHING))
    assert wire.give_up().kind is Kind.SILENT
    wire.feed(b"::\x1eab\x1f\r\n:HELLO\r\n")
    assert wire.left.lines() == ["HELLO"]


@given(LINES, LINES, st.lists(st.integers(0, 60), max_size=4))
def test_only_what_looks_like_the_reply_is_the_reply(before: list[str], after: list[str], cuts: list[int]) -> None:
    wire = Wire()
    wire.expect(Proof("ab", 1, r" \$[0-9A-F]{8}\.[0-9A-F]{4}"))
    lines = [*before, " $0000000A.8000", *after]
    answers = fed(wire, "".join(f"{line}\r\n" for line in lines).encode() + b":\x1eab\x1f\r\n:", cuts)
    assert [(each.kind, each.text) for each in answers] == [(Kind.ACCEPTED, " $0000000A.8000")]
    assert wire.left.lines() == [*before, *after]


@given(LINES, st.lists(st.integers(0, 60), max_size=4))
def test_what_comes_beside_a_command_that_tells_nothing_is_a_programs(texts: list[str], cuts: list[int]) -> None:
    wire = Wire()
    wire.expect(Proof("ab", 1, NOTHING))
    told = "".join(f"{text}\r\n" for text in texts).encode()
    answers = fed(wire, told + b":\x1eab\x1f\r\n:", cuts)
    assert [(each.kind, each.text, each.certain) for each in answers] == [(Kind.ACCEPTED, "", True)]
    assert wire.left.lines() == texts


def test_marked_text_beside_an_answer_is_not_lost() -> None:
    """CW1 sets bit 7 of what a program sends (dmc-1412-1414.txt l.1332)."""
    marked = bytes(byte | 0x80 for byte in b"HELLO\r\n")
    for expected, stream in (
        (Proof("ab", 1), marked + b" 12\r\n:\x1eab\x1f\r\n:"),
        (Prompts(1), b" 12\r\n" + marked + b":"),
        (Upload(), b"#A\r\n" + marked + b"EN\r\n\x1a\r\n:"),
        (Revision(), marked + b"DMC1540 Rev 2.0h\r\n:"),
    ):
        wire = Wire()
        wire.expect(expected)
        wire.feed(stream)
        answer = wire.answer()
        assert answer is not None and "HELLO" not in answer.text
        assert wire.left.lines() == ["HELLO"], expected


@pytest.mark.parametrize("behind", [b":", b"\r\n:", b"TICK\r\n:", b"TICK\r\nTI\r\n:", b"TI:CK\r\n" + 50 * b"TICK\r\n",
                                    50 * b"TICK\r\n"])  # fmt: skip
def test_a_reading_of_the_program_ends_whatever_is_printed_behind_it(behind: bytes) -> None:
    """Its prompt may stand behind a text, within a line of it, or be lost: more than an output buffer tells."""
    wire = Wire()
    wire.expect(Upload(), "UL")
    answers = fed(wire, b"#A\r\nEN\r\n\x1a" + behind, list(range(0, len(behind), 7)))
    assert [(answer.kind, answer.text) for answer in answers] == [(Kind.ACCEPTED, "#A\r\nEN\r\n")]
