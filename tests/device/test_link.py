"""The link byte by byte: exactly these bytes, in this order, and what comes of the answers."""

from __future__ import annotations

import pytest

from device.api import Controller, Kind, LinkError, LinkLost, NotAllowed, NoticeKind, State, StopState
from device.transport import LineSettings, OpenFailed, TransportLost
from device.transport.scripted import Scripted

HELLO = (
    (b"\x12\x16", b"DMC1412 Rev 1.0a\r\n:"),
    (b'MG{^30},"aa",_BN{F10.0},{^31}\r', b"\x1eaa 0000001234\x1f\r\n:"),
    (b'MG{^30},"ba",TIME{F10.0},_TM{F5.0},{^31}\r', b"\x1eba 0000001024 01000\x1f\r\n:"),
    (b'MG{^30},"ca",_XQ0{F4.0},{^31}\r', b"\x1eca-0001\x1f\r\n:"),
    (b'MG{^30},"da",_XQ1{F4.0},{^31}\r', b"\x1eda-0001\x1f\r\n:"),
)


def talking(*script: tuple[bytes, bytes], kind: Kind = Kind.SIMULATOR) -> tuple[Scripted, Controller]:
    """A connected controller that has said hello; then the script."""
    transport = Scripted(*HELLO, *script)
    line = LineSettings(baud=None)
    controller = Controller(lambda: transport, kind=kind, line=line, clock=transport.clock, threaded=False)
    controller.poller.set_columns = lambda names: None  # type: ignore[method-assign]
    while controller.state is not State.READY:
        controller.link.step()
        assert transport.now < 5
    return transport, controller


def finish(controller: Controller, transport: Scripted, seconds: float = 2.0) -> None:
    end = transport.now + seconds
    while transport.now < end:
        controller.link.step()


def test_hello() -> None:
    transport, controller = talking()
    assert controller.identity is not None
    assert (controller.identity.text, controller.identity.serial) == ("DMC1412 Rev 1.0a", 1234)
    assert controller.model is not None
    assert controller.model.name == "dmc1412"
    transport.assert_finished()


def test_a_command_and_its_proof() -> None:
    transport, controller = talking((b'SP 1000;MG{^30},"ea",{^31}\r', b":\x1eea\x1f\r\n:"))
    reply = controller.ask("SP 1000")
    finish(controller, transport)
    assert reply.result(0).accepted
    transport.assert_finished()
    shown = [line.text for line in controller.traffic() if line.source == "user"]
    assert shown == ["SP 1000", ":"]


def test_a_refusal_is_proved_and_explained() -> None:
    transport, controller = talking(
        (b'SP -1;MG{^30},"ea",{^31}\r', b"?"),
        (b'MG{^30},"fa",_TC{F3.0},{^31}\r', b"\x1efa 006\x1f\r\n:"),
    )
    reply = controller.ask("SP -1")
    finish(controller, transport)
    assert not reply.result(0).accepted
    assert reply.result(0).reason == "SP -1: refused, error 6, Number out of range."
    transport.assert_finished()


def test_a_question_mark_in_a_message_is_no_refusal() -> None:
    transport, controller = talking((b'SP 1000;MG{^30},"ea",{^31}\r', b"READY?\r\n:\x1eea\x1f\r\n:"))
    reply = controller.ask("SP 1000")
    finish(controller, transport)
    assert reply.result(0).accepted
    assert [n.text for n in controller.notices() if n.kind is NoticeKind.MESSAGE] == ["READY?"]


def test_no_answer_is_a_lost_link() -> None:
    transport, controller = talking((b'SP 1000;MG{^30},"ea",{^31}\r', b""))
    reply = controller.ask("SP 1000")
    finish(controller, transport)
    with pytest.raises(LinkLost, match="No answer to “SP 1000”"):
        reply.result(0)


def test_an_error_of_the_program_is_a_fault() -> None:
    """`?` and the line's number and text (dmc-1412-1414.txt, error handling)."""
    transport, controller = talking()
    transport.say(b"?003 PR5000\r\n")
    finish(controller, transport)
    assert [(n.kind, n.text) for n in controller.notices()][-1] == (NoticeKind.FAULT, "?003 PR5000")


def test_stop_goes_before_what_is_queued() -> None:
    transport, controller = talking(
        (b"ST\r", b":"),
        (b'ST;HX;MG{^30},"ea",{^31}\r', b"::\x1eea\x1f\r\n:"),
        (b'MG{^30},"fa",_BGX{F1.0},_XQ0{F4.0},{^31}\r', b"\x1efa 1-0001\x1f\r\n:"),
        (b'MG{^30},"ga",_XQ1{F4.0},{^31}\r', b"\x1ega-0001\x1f\r\n:"),
        (b'MG{^30},"ha",_TVX{F8.0},_DCX{F10.0},{^31}\r', b"\x1eha 00020000 0000256000\x1f\r\n:"),
        (b'MG{^30},"ia",_BGX{F1.0},_XQ0{F4.0},{^31}\r', b"\x1eia 0-0001\x1f\r\n:"),
        (b'MG{^30},"ja",_XQ1{F4.0},{^31}\r', b"\x1eja-0001\x1f\r\n:"),
    )
    waiting = controller.ask("BG X")
    controller.stop()
    finish(controller, transport)
    assert controller.stop_state is StopState.STOPPED
    assert transport.discarded == 1
    with pytest.raises(LinkError, match="STOP was pressed"):
        waiting.result(0)
    transport.assert_finished()


def test_a_port_that_does_not_open_says_why_and_is_tried_again() -> None:
    transport = Scripted(*HELLO)
    tries: list[int] = []

    def opener() -> Scripted:
        tries.append(1)
        if len(tries) < 2:
            raise OpenFailed("There is no port /dev/ttyUSB7; plug in the adapter or choose another port.")
        return transport

    now = [0.0]
    controller = Controller(opener, kind=Kind.MACHINE, clock=lambda: now[0] + transport.now, threaded=False)
    controller.link.step()
    assert controller.state is State.LOST
    assert "plug in the adapter" in controller.state_text
    now[0] = 2.0
    while controller.state is not State.READY:
        controller.link.step()
        assert transport.now < 5
    assert len(tries) == 2


def test_a_lost_port_fails_what_is_under_way() -> None:
    transport, controller = talking((b'SP 1000;MG{^30},"ea",{^31}\r', b""), kind=Kind.SIMULATOR)
    reply = controller.ask("SP 1000")
    controller.link.step()
    transport.lost = True
    controller.link.step()
    with pytest.raises(LinkLost):
        reply.result(0)
    assert controller.state is State.LOST
    assert any(notice.kind is NoticeKind.LOST for notice in controller.notices())


def test_offline_everything_fails_with_a_sentence() -> None:
    controller = Controller.offline()
    with pytest.raises(LinkLost, match="Offline"):
        controller.ask("TP").result(0)
    with pytest.raises(LinkLost, match="Offline"):
        controller.upload().future.result(0)
    controller.stop()
    assert controller.stop_state is StopState.NO_LINK
    controller.close()


def test_at_most_thirty_two_bytes_wait_in_the_system() -> None:
    """At 9600 baud a byte takes 1.04 ms; what was handed over and cannot have left yet is never more than 32 bytes."""
    transport = Scripted(*HELLO)
    written: list[tuple[float, int]] = []
    write = transport.write

    def noted(data: bytes) -> int:
        written.append((transport.now, len(data)))
        return write(data)

    transport.write = noted  # type: ignore[method-assign]
    line = LineSettings(baud=9600)
    controller = Controller(lambda: transport, kind=Kind.MACHINE, line=line, clock=transport.clock, threaded=False)
    controller.poller.set_columns = lambda names: None  # type: ignore[method-assign]
    while controller.state is not State.READY:
        controller.link.step()
    clear = 0.0
    for at, count in written:
        clear = max(clear, at) + count * 10 / 9600
        assert (clear - at) * 960 <= 33


def test_letters_the_controller_does_not_know_are_refused_here() -> None:
    transport, controller = talking()
    reply = controller.ask("MG “hello”")
    finish(controller, transport)
    with pytest.raises(NotAllowed, match="knows no"):
        reply.result(0)


def test_a_held_line_is_not_confirmed() -> None:
    """CTS held: the system takes nothing."""
    transport, controller = talking()
    transport.write = lambda data: 0  # type: ignore[method-assign]
    start = transport.now
    controller.stop()
    while controller.stop_state is StopState.STOPPING:
        controller.link.step()
        assert transport.now < start + 0.55
    assert controller.stop_state is StopState.NOT_CONFIRMED


def test_transport_lost_while_stopping_is_not_confirmed() -> None:
    transport, controller = talking()

    def gone(data: bytes) -> int:
        raise TransportLost("gone")

    transport.write = gone  # type: ignore[method-assign]
    controller.stop()
    controller.link.step()
    assert controller.stop_state is StopState.NOT_CONFIRMED


def test_a_fault_inside_stops_motion_before_it_is_reported() -> None:
    transport, controller = talking()
    controller.link.step = lambda: 1 / 0  # type: ignore[method-assign,assignment,return-value]
    with pytest.raises(ZeroDivisionError):
        controller.link._run()
    assert transport.everything_sent.endswith(b"\x11\x1b\x5cST\rST\r")
    assert controller.state is State.LOST
