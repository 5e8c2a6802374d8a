"""Ports and who answers at them; types are never guessed."""

from __future__ import annotations

import os
import socket
import sys

import pytest

from codegen.models import model
from device.api import Controller, Kind, NoticeKind, State
from device.find import Found, ports, probe
from device.identify import model_of
from device.transport import LineSettings, OpenFailed, TransportLost, open_transport
from device.transport.scripted import Scripted
from device.transport.serial_port import why_not

NO_PTY = pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals there")
LINE = LineSettings()


def look(transport: Scripted, *, used: bool = True, yes: bool = True) -> Found | str:
    opened = {"open_": lambda address, line: transport, "clock": transport.clock}
    return probe("/dev/ttyX", LINE, used_before=used, ask=lambda question: yes, **opened)


def test_a_controller_that_names_itself() -> None:
    transport = Scripted((b"\x12\x16", b"DMC1520 Rev 2.0h\r\n:"))
    found = look(transport)
    assert found == Found("/dev/ttyX", "DMC1520 Rev 2.0h", model("ssc2"))
    transport.assert_finished()


def test_only_a_return_and_the_revision_are_ever_sent() -> None:
    transport = Scripted((b"\x12\x16", b""), (b"\r", b""))
    assert look(transport) == (
        "Nothing that speaks two-letter code answers at /dev/ttyX; check speed, cable and power."
    )
    assert transport.everything_sent == b"\x12\x16\r"


def test_one_that_only_prompts_is_found_without_a_type() -> None:
    transport = Scripted((b"\x12\x16", b""), (b"\r", b":"))
    assert look(transport) == Found("/dev/ttyX", "", None)


def test_a_port_never_used_is_asked_about_and_left_alone() -> None:
    transport = Scripted()
    assert look(transport, used=False, yes=False) == "/dev/ttyX was left alone."
    assert transport.everything_sent == b""


NAMES = [
    ("DMC1510 Rev 2.0h", "ssc1"),
    ("DMC1540 Rev 1.3", "ssc4"),
    ("DMC1412 Rev 1.0i", "dmc1412"),
    ("DMC1414 Rev 1.0", "dmc1414"),
]


@pytest.mark.parametrize(("text", "name"), NAMES)
def test_known_texts(text: str, name: str) -> None:
    assert model_of(text) is model(name)


@pytest.mark.parametrize("text", ["DMC1425 Rev 1.0i", "DMC4040 Rev 1.1", "HELLO", "", "DMC1560 Rev 1"])
def test_unknown_texts_are_never_guessed(text: str) -> None:
    assert model_of(text) is None


def test_an_unknown_controller_is_asked_about_once_and_remembered_by_its_serial_number() -> None:
    script = (
        (b"\x12\x16", b"DMC1425 Rev 1.0i\r\n:"),
        (b'MG{^30},"aa",_BN{F10.0},{^31}\r', b"\x1eaa 0000000777\x1f\r\n:"),
        (b'TP;MG{^30},"ba",{^31}\r', b" 0000000001, 0000000002\r\n:\x1eba\x1f\r\n:"),
        (b'MG{^30},"ca",TIME{F10.0},_TM{F5.0},{^31}\r', b"\x1eca 0000001024 01000\x1f\r\n:"),
        (b'MG{^30},"da",_XQ0{F4.0},{^31}\r', b"\x1eda-0001\x1f\r\n:"),
    )
    transport = Scripted(*script)
    controller = Controller(lambda: transport, kind=Kind.MACHINE, clock=transport.clock, threaded=False)
    while controller.state is not State.READY:
        controller.link.step()
        assert transport.now < 5
    assert controller.model is None
    assert controller.axes == "XY"
    assert any("not known" in n.text for n in controller.notices() if n.kind is NoticeKind.IDENTIFIED)
    assert controller.choose_model("ssc2") == 777
    assert "position.y" in controller.columns
    assert controller.known_models == {777: "ssc2"}


def test_nothing_but_return_and_revision_goes_to_something_that_does_not_answer() -> None:
    transport = Scripted()
    transport.write = lambda data: sent.append(data) or len(data)  # type: ignore[method-assign,func-returns-value]
    sent: list[bytes] = []
    controller = Controller(lambda: transport, kind=Kind.MACHINE, clock=transport.clock, threaded=False)
    while transport.now < 10:
        controller.link.step()
    assert controller.state is State.LOST
    assert "Nothing that speaks" in controller.state_text
    assert set(sent) == {b"\x12\x16", b"\r"}


def test_ports_used_before_come_first() -> None:
    found = ports()
    used = [found[-1].device] if found else []
    again = ports(used)
    assert [port.device for port in again if port.used_before] == used
    assert again[0].used_before if found else again == []


def test_a_port_that_is_not_there() -> None:
    with pytest.raises(OpenFailed, match=r"There is no port|did not open"):
        open_transport("/dev/ttyNOTHING" if sys.platform != "win32" else "COM250")


def test_an_address_that_is_none() -> None:
    with pytest.raises(OpenFailed, match="is not an address"):
        open_transport("socket://nowhere")


def test_nobody_listens() -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        number = free.getsockname()[1]
    with pytest.raises(OpenFailed, match="Nothing answers"):
        open_transport(f"socket://127.0.0.1:{number}")


def test_reasons_in_words() -> None:
    assert (
        "usermod -aG dialout" in why_not("/dev/ttyUSB0", PermissionError(13, "Permission denied"))
        or sys.platform == "win32"
    )
    assert "in use by another program" in why_not("/dev/ttyUSB0", OSError(16, "Device or resource busy"))
    assert "plug in" in why_not("/dev/ttyUSB0", FileNotFoundError(2, "No such file or directory"))


@NO_PTY
def test_a_pseudo_terminal_opens_as_a_serial_port_for_us_alone() -> None:
    controller, device = os.openpty()
    name = os.ttyname(device)
    port = open_transport(name, LineSettings(baud=19200))
    try:
        assert port.write(b"TP\r") == 3
        assert os.read(controller, 10) == b"TP\r"
        os.write(controller, b" 0000000001\r\n:")
        assert port.read(1.0).startswith(b" 0000")
        with pytest.raises(OpenFailed, match="in use by another program"):
            open_transport(name, LineSettings(baud=19200))
        os.close(controller)
        os.close(device)
        with pytest.raises(TransportLost):
            for _ in range(5):
                port.read(0.1)
    finally:
        port.close()


def test_tcp_both_ways_and_the_end() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        line = open_transport(f"socket://127.0.0.1:{server.getsockname()[1]}")
        there, _ = server.accept()
        assert line.write(b"TP\r") == 3
        assert there.recv(10) == b"TP\r"
        there.sendall(b":")
        assert line.read(2.0) == b":"
        assert line.read(0.01) == b""
        there.close()
        with pytest.raises(TransportLost, match="closed the connection"):
            line.read(2.0)
        line.close()


def test_the_time_of_a_byte() -> None:
    assert LineSettings(baud=9600).byte_s == pytest.approx(10 / 9600)
    assert LineSettings(baud=9600, bits=7, parity="even", stop_bits=2).byte_s == pytest.approx(11 / 9600)
    assert LineSettings(baud=None).byte_s == 0
