"""Every diagnosis of the connection doctor, over a pseudo-terminal to a simulated controller with that fault."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from app.cli.calls import call
from codegen.models import model
from codegen.rates import JUMPERS, RATES, setting_words
from device.doctor import Diagnosis, Doctor, Trouble, examination
from device.doctor_answers import Answered, judged
from device.doctor_ports import group_of, holders
from device.download import Job
from device.simulator.process import SimulatorProcess
from device.simulator.uart_faults import mistimed
from device.transport import LineSettings, OpenFailed, Transport, open_transport
from device.transport.serial_port import SerialPort
from tests.device.test_latency import NO_PTY
from tests.long import is_long
from tests.slower import queued_s

LINE = LineSettings(baud=19200)
pytestmark = [NO_PTY, pytest.mark.paced]


@pytest.fixture(scope="module")
def process() -> Iterator[SimulatorProcess]:
    with SimulatorProcess("ssc2", pty=True, baud=19200) as process:
        process.state()  # it has started
        yield process


@pytest.fixture
def machine(process: SimulatorProcess, monkeypatch: pytest.MonkeyPatch) -> Iterator[SimulatorProcess]:
    if not is_long():
        monkeypatch.setattr("device.doctor.SPEEDS", (9600, 19200))
    process.stimulus("fault", "none")
    yield process
    process.stimulus("fault", "none")
    port = open_transport(process.address, LINE)  # nothing of it stays for the next
    port.write(b"\r")
    while port.read(0.2):
        continue
    port.close()


class Wires(SerialPort):
    """The pseudo-terminal with the handshake wires it lacks: CTS as the simulated port has it, RTS/CTS as a driver."""

    machine: SimulatorProcess
    wired = True  # whether the cable has the wire

    def clear_to_send(self) -> bool | None:
        return self.wired and bool(self.machine.state()["clear_to_send"])

    def write(self, data: bytes) -> int:
        held = self._line.handshake in ("rts", "both") and not self.clear_to_send()
        return 0 if held else super().write(data)


def examined(
    machine: SimulatorProcess, line: LineSettings = LINE, port: type[SerialPort] = SerialPort
) -> tuple[Diagnosis, bytes]:
    """The diagnosis, and every byte that was sent for it."""
    sent = bytearray()

    def opened(address: str, line: LineSettings) -> Transport:
        transport = port(address, line)
        write = transport.write

        def recorded(data: bytes) -> int:
            sent.extend(data)
            return write(data)

        transport.write = recorded  # type: ignore[method-assign]
        return transport

    diagnosis = Doctor(machine.address, line, Job(), open_=opened).examine()
    print(diagnosis.words)
    called = re.sub(rb"%[0-7]\r", b"", bytes(sent))  # only where nothing answered at all
    silent = diagnosis.trouble in (Trouble.SILENT, Trouble.HELD, Trouble.ADDRESSED)
    assert called == bytes(sent) or silent or line.address is not None
    assert called.replace(b"\x12\x16", b"").strip(b"\r") == b""  # nothing but these ever leaves
    return diagnosis, bytes(sent)


def test_a_controller_that_answers(machine: SimulatorProcess) -> None:
    found, sent = examined(machine)
    assert found.trouble is Trouble.NONE
    assert (found.baud, found.model) == (19200, model("ssc2"))
    assert "SSC, two axes" in found.sentence
    assert sent == b"\r\x12\x16"


def test_silence(machine: SimulatorProcess) -> None:
    machine.stimulus("fault", "silent")
    found, _ = examined(machine)
    assert found.trouble is Trouble.SILENT
    assert "power light" in found.words
    assert "crossed" in found.words


def test_one_that_was_silenced_by_calling_another_address(machine: SimulatorProcess) -> None:
    """It says nothing until its own number is called (dmc-1412-1414.txt l.1304); as installed that is 0."""
    port = open_transport(machine.address, LINE)
    port.write(b"%5\r")
    time.sleep(0.1)
    port.close()
    found, sent = examined(machine)
    assert found.trouble is Trouble.ADDRESSED and sent.endswith(b"%0\r\x12\x16")
    assert "has the address 0 and was silent because another one was called" in found.sentence
    assert found.baud == 19200 and found.model == model("ssc2")
    found, _ = examined(machine)  # it listens again
    assert found.fine


def test_the_addresses_of_a_chain() -> None:
    """The one that is asked for answers, or those that do are named; afterwards one of them listens."""
    with SimulatorProcess("ssc1", pty=True, baud=19200, chain=3) as chain:
        chain.state()
        found, sent = examined(chain, replace(LINE, address=2))
        assert found.fine and b"%2\r" in sent
        found, _ = examined(chain, replace(LINE, address=5))
        assert found.trouble is Trouble.ADDRESSED and not found.fine
        assert found.sentence == f"No controller with address 5 answers at {chain.address}; these do: 0, 1, 2."
        found, _ = examined(chain)
        assert found.fine


def test_its_own_echo(machine: SimulatorProcess) -> None:
    machine.stimulus("fault", "echo")
    found, sent = examined(machine)
    assert found.trouble is Trouble.ECHO
    assert "hears itself" in found.sentence
    assert sent == b"\r"


def test_something_else_is_left_alone(machine: SimulatorProcess) -> None:
    machine.stimulus("fault", "foreign")
    found, sent = examined(machine)
    assert found.trouble is Trouble.FOREIGN
    assert "“machine login:”" in found.sentence
    assert sent == b"\r"


@pytest.mark.parametrize("baud", [9600, 38400, 4800, 1200] if is_long() else [38400])
def test_another_speed_is_found_by_trying(machine: SimulatorProcess, baud: int) -> None:
    """The switches as the manual has them: 19 200 is OFF OFF ON (SSC manual l.1524)."""
    machine.stimulus("fault", "speed")
    found, _ = examined(machine, LineSettings(baud=baud))
    assert found.trouble is Trouble.SPEED
    assert found.baud == 19200
    assert f"answers at 19200 baud (switches 1200 OFF, 9600 OFF, 19.2K ON, HSHK ON), not at {baud}" in found.sentence


def test_garbage_that_no_speed_explains(machine: SimulatorProcess) -> None:
    class Noise(SerialPort):
        def read(self, timeout_s: float) -> bytes:
            return bytes(byte ^ 0xA5 for byte in super().read(timeout_s))

    found, _ = examined(machine, port=Noise)
    assert found.trouble is Trouble.GARBAGE
    assert "8 bits, no parity, 1 stop bit" in found.words


def test_cts_low(machine: SimulatorProcess) -> None:
    Wires.machine, Wires.wired = machine, True
    machine.stimulus("fault", "held")
    found, _ = examined(machine, LineSettings(baud=19200, handshake="rts"), Wires)
    assert found.trouble is Trouble.HELD
    assert "CTS is low" in found.sentence


def test_a_cable_without_handshake_lines(machine: SimulatorProcess) -> None:
    Wires.machine, Wires.wired = machine, False
    found, _ = examined(machine, LineSettings(baud=19200, handshake="rts"), Wires)
    assert found.trouble is Trouble.NOT_WIRED
    assert "CTS line of the cable is not wired" in found.sentence
    found, _ = examined(machine, LINE, Wires)
    assert found.fine
    assert "leave the handshake at “none”" in found.words


def test_a_port_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["doctor", "--port", "/dev/ttyNOT0"]) == 1
    assert "There is no port /dev/ttyNOT0." in capsys.readouterr().out


def test_no_permission(machine: SimulatorProcess) -> None:
    """Whoever runs the tests may be allowed everything, so the system's refusal is put in; the group is the port's."""

    def refused(address: str, line: LineSettings) -> Transport:
        raise OpenFailed("no") from PermissionError(13, "Permission denied", address)

    found = Doctor(machine.address, LINE, Job(), open_=refused).examine()
    assert found.trouble is Trouble.PERMISSION
    assert f'"sudo usermod -aG {group_of(machine.address)} $USER"' in found.words
    import grp

    assert group_of(machine.address) == grp.getgrgid(os.stat(machine.address).st_gid).gr_name


def test_a_busy_port_and_by_whom(machine: SimulatorProcess) -> None:
    hold = (
        "import serial,sys,time; p=serial.Serial(sys.argv[1],exclusive=True); print('open',flush=True); time.sleep(60)"
    )
    rival = subprocess.Popen([sys.executable, "-c", hold, machine.address], stdout=subprocess.PIPE, text=True)
    try:
        assert rival.stdout is not None
        assert rival.stdout.readline() == "open\n"
        found = Doctor(machine.address, LINE, Job()).examine()
        assert found.trouble is Trouble.BUSY
        assert f"(process {rival.pid})" in found.sentence
        assert holders(machine.address) == [
            f"{Path(f'/proc/{rival.pid}/comm').read_text().strip()} (process {rival.pid})"
        ]
    finally:
        rival.kill()
        rival.wait()
        assert rival.stdout is not None
        rival.stdout.close()


def test_it_tells_how_far_it_is_and_can_be_cancelled(machine: SimulatorProcess) -> None:
    machine.stimulus("fault", "silent")
    phases: list[str] = []
    asking = threading.Event()

    def progress(job: Job[Diagnosis]) -> None:
        phases.append(job.phase)
        if job.phase.startswith("Asking"):
            asking.set()

    job = examination(machine.address, LINE, progress)
    assert asking.wait(20.0)
    began, queued = time.monotonic(), queued_s()
    job.cancel()
    assert job.future.result(5.0).trouble is Trouble.CANCELLED
    assert time.monotonic() - began - (queued_s() - queued) < 1.0  # without what other programs took
    assert phases[:3] == [f"Opening {machine.address}", "Listening", "Asking at 19200 baud"]


def test_on_the_command_line(machine: SimulatorProcess, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["doctor", "--port", machine.address, "--baud", "19200"]) == 0
    assert "answers." in capsys.readouterr().out
    machine.stimulus("fault", "echo")
    assert call(["doctor", "--port", machine.address]) == 1
    assert "hears itself" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("came", "what"),
    [
        (b"", Answered.NOTHING),
        (b"\x00\x11", Answered.NOTHING),
        (b":", Answered.PROMPT),
        (b"?", Answered.PROMPT),
        (b"\r\n:", Answered.PROMPT),
        (b"\xc8\xc5\xcc\xcc\xcf\r\n:", Answered.PROMPT),  # a message of a program, marked in bit 7
        (b"\r", Answered.ECHO),
        (b"\r\nlogin:", Answered.TEXT),
        (b"\r\nlogin: ", Answered.TEXT),
        (b">>> ", Answered.TEXT),
        (b"\xf8\x06\x80", Answered.GARBAGE),
        (b"x", Answered.GARBAGE),
    ],
)
def test_answers_to_a_return(came: bytes, what: Answered) -> None:
    assert judged(came) is what


def test_characters_at_the_wrong_speed() -> None:
    """Worked out on paper: 0x0D at half the receiver's speed; every bit is seen twice, start bit first."""
    assert mistimed(b"A:\r", 9600, 9600) == b"A:\r"
    # sender's bits 0 1 0 1 1 0 0 0 0 1, each twice: start 0, then 0 11 00 11 1 | then 1 and 0000 0000 …
    assert mistimed(b"\r", 9600, 19200)[0] == 0b11100110
    assert mistimed(b"\r", 19200, 9600) != b"\r"


def test_how_a_controller_is_set_to_a_speed() -> None:
    """SSC manual l.1520-1525, dmc-1412-1414.txt l.478-481."""
    assert setting_words(38400, model("ssc1")) == "switches 1200 OFF, 9600 ON, 19.2K ON, HSHK ON"
    assert setting_words(1200, model("dmc1412")) == "jumper 9600 set, jumper 38.4K set"
    assert setting_words(4800, model("dmc1414")) == ""
    assert set(JUMPERS) < set(RATES)


class Silent(Transport):
    """An open socket behind which nobody answers."""

    def read(self, timeout_s: float) -> bytes:
        return b""

    def write(self, data: bytes) -> int:
        return len(data)

    def close(self) -> None:
        """Nothing is open."""


def test_a_socket_has_no_speed() -> None:
    """The speed belongs to the serial line behind it: the connection is spoken of."""
    with SimulatorProcess("ssc1", pty=False) as machine:
        machine.state()  # it serves
        told = Doctor(machine.address, LineSettings(baud=9600, handshake="both"), Job()).examine()
    assert told.fine and "baud" not in told.sentence
    ticks = iter(range(10**6))
    silent = Doctor("socket://10.0.0.9:4000", LINE, Job(), open_=lambda *_: Silent(), clock=lambda: next(ticks) / 10)
    told = silent.examine()
    assert told.trouble is Trouble.SILENT and told.sentence.startswith("The connection to socket://10.0.0.9:4000 is")
    assert "no speed" not in told.words
