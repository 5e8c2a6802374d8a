"""Served in real time: a process of its own on a socket or a pseudo-terminal, paced, controlled by lines."""

from __future__ import annotations

import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from device.simulator.process import SimulatorFailed, SimulatorProcess

TRIES = 5  # a busy computer keeps a process waiting now and then; what does not keep its time fails each of them
pytestmark = pytest.mark.paced


def connect(address: str) -> socket.socket:
    host, _, port = address.removeprefix("socket://").rpartition(":")
    client = socket.create_connection((host, int(port)), timeout=20)
    client.settimeout(20)
    return client


def until(client: socket.socket, end: bytes) -> bytes:
    data = b""
    while not data.endswith(end):
        more = client.recv(4096)
        assert more, data
        data += more
    return data


def when_settled(simulator: SimulatorProcess) -> None:
    """It has started, and loads nothing any more."""
    give_up = time.monotonic() + 120
    while not simulator.state()["compiled"]:
        assert time.monotonic() < give_up
        time.sleep(0.05)


def test_commands_over_a_socket() -> None:
    with SimulatorProcess("ssc4") as simulator:
        client = connect(simulator.address)
        client.sendall(b"PR 500;SP 20000;BGX;AMX\r")
        assert until(client, b"::::") == b"::::"
        client.sendall(b'MG "AT",_RPX{F4.0}\rTC1\r')
        assert until(client, b":0\r\n:") == b"AT 0500\r\n:0\r\n:"
        simulator.stimulus("in1", 0)
        client.sendall(b"AI-1;TI\r")
        assert until(client, b"\r\n:") == b":254\r\n:"
        state = simulator.state()
        assert state["axes"]["X"]["commanded"] == 500
        assert state["received"][-1][1] == 13
        assert abs(state["received"][-1][0] - time.monotonic()) < 5


def test_a_second_client_takes_over() -> None:
    with SimulatorProcess("ssc1") as simulator:
        first = connect(simulator.address)
        first.sendall(b"V1=5\r")
        assert until(first, b":") == b":"
        second = connect(simulator.address)
        second.sendall(b"V1={F2.0}\r")
        assert until(second, b":") == b" 05\r\n:"
        assert first.recv(10) == b""


def test_two_clients_on_ports_1_and_2() -> None:
    program = b'DL\r#A\rCI ,1\r#B\rJP#B\r#COMINT\rMG{P2}"GOT",P2NM{F4.0}\rEN0,1\r\\'
    with SimulatorProcess("ssc2", port2="127.0.0.1:0") as simulator:
        host, operator = connect(simulator.address), connect(simulator.address2)
        host.sendall(program)
        assert until(host, b":") == b":"
        host.sendall(b"XQ #A\r")
        assert until(host, b":") == b":"
        for number in range(1, 6):
            operator.sendall(f"{number}\r".encode())
            host.sendall(f"MG {number}{{F2.0}}\r".encode())
            assert until(operator, b"\r\n") == f"GOT {number:04d}\r\n".encode()
            assert until(host, b":") == f" {number:02d}\r\n:".encode()
        operator.sendall(b"TPX\r")  # no command there (SSC manual l.1243)
        assert until(operator, b"\r\n") == b"GOT 0000\r\n"
        again = connect(simulator.address2)
        again.sendall(b"9\r")
        assert until(again, b"\r\n") == b"GOT 0009\r\n"


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals")
def test_port_2_on_a_pseudo_terminal() -> None:
    import os
    import select

    with SimulatorProcess("ssc1", port2="pty") as simulator:
        host = connect(simulator.address)
        terminal = os.open(simulator.address2, os.O_RDWR | os.O_NOCTTY)
        host.sendall(b'MG{P2}"HELLO"\r')
        assert until(host, b":") == b":"
        data = b""
        while not data.endswith(b"\n"):
            assert select.select([terminal], [], [], 20)[0]
            data += os.read(terminal, 100)
        os.close(terminal)
        assert data == b"HELLO\r\n"


def test_port_2_of_a_chain_is_that_of_its_last_controller() -> None:
    with SimulatorProcess("dmc1412", chain=3, port2="127.0.0.1:0") as simulator:
        host, end = connect(simulator.address), connect(simulator.address2)
        host.sendall(b'%2\rMG{P2}"END"\r')
        assert until(host, b"::") == b"::"
        assert until(end, b"\r\n") == b"END\r\n"


@pytest.mark.alone
def test_real_time_is_kept() -> None:
    with SimulatorProcess("ssc1") as simulator:
        client = connect(simulator.address)
        client.sendall(b"\r")
        until(client, b":")
        off: list[float] = []
        while not off or (min(off) > 0.15 and len(off) < TRIES):
            began = time.monotonic()
            client.sendall(b"WT 512\r")
            until(client, b":")
            off.append(abs(time.monotonic() - began - 0.5))
        assert min(off) <= 0.15


@pytest.mark.alone
@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals")
def test_a_paced_pseudo_terminal() -> None:
    import os
    import select

    with SimulatorProcess("ssc4", pty=True, baud=1200) as simulator:
        when_settled(simulator)
        terminal = os.open(simulator.address, os.O_RDWR | os.O_NOCTTY)
        seconds = 18 * 10 / 1200  # 4 characters there, 14 back
        late: list[float] = []
        while not late or (not -0.02 < late[-1] < 0.25 and len(late) < TRIES):
            began, data = time.monotonic(), b""
            os.write(terminal, b"TPX\r")
            while not data.endswith(b"\r\n:"):
                assert select.select([terminal], [], [], 20)[0]
                data += os.read(terminal, 100)
            late.append(time.monotonic() - began - seconds)
            assert data == b" 0000000000\r\n:"
        os.close(terminal)
        assert -0.02 < late[-1] < 0.25


def test_an_ended_process_is_said() -> None:
    simulator = SimulatorProcess("ssc1")
    simulator.close()
    with pytest.raises(SimulatorFailed):
        simulator.stimulus("in1", 0)


def test_it_ends_when_its_owner_does() -> None:
    command = [sys.executable, "-m", "device.simulator", "--control"]
    root = Path(__file__).resolve().parents[3]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=root, text=True)
    assert process.stdout is not None
    assert process.stdout.readline().startswith("listening on 127.0.0.1:")
    process.communicate(timeout=30)
    assert process.returncode == 0


@pytest.mark.parametrize("options", [["--controller", "ssc9"], ["--plant", "/no/such.toml"], ["--tcp", "256.0.0.1:0"]])
def test_unusable_options_are_one_sentence(options: list[str]) -> None:
    root = Path(__file__).resolve().parents[3]
    result = subprocess.run(
        [sys.executable, "-m", "device.simulator", *options], cwd=root, capture_output=True, text=True, timeout=60
    )
    assert result.returncode == 2
    assert result.stderr.startswith("twoletter: ")
    assert result.stderr.count("\n") == 1


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processor time is read from /proc")
def test_an_idle_controller_costs_little() -> None:
    import os

    def used(pid: int) -> float:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    with SimulatorProcess("ssc4") as simulator:
        client = connect(simulator.address)
        client.sendall(b"\r")
        until(client, b":")
        when_settled(simulator)
        before, began = used(simulator.pid), time.monotonic()
        client.sendall(b"WT 3072\r")  # three seconds
        until(client, b":")
        assert (used(simulator.pid) - before) / (time.monotonic() - began) < 0.05
