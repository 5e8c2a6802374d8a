"""A port that another program has is named with that program."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from device.transport import LineSettings, OpenFailed
from device.transport.holder import holder_of, rival_of

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux shows the open files of other programs")

HOLD = """
import fcntl, sys
port = open(sys.argv[1], "rb+", buffering=0)
fcntl.flock(port, fcntl.LOCK_EX)
print("open", flush=True)
sys.stdin.readline()
"""


@pytest.fixture
def port() -> Iterator[str]:
    master, slave = os.openpty()
    name = os.ttyname(slave)
    os.close(slave)
    yield name
    os.close(master)


@pytest.fixture
def other(port: str) -> Iterator[int]:
    """Another program that has the port open and locked."""
    process = subprocess.Popen([sys.executable, "-c", HOLD, port], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert process.stdout is not None and process.stdout.readline() == b"open\n"
    yield process.pid
    process.communicate(b"\n")


def test_opening_names_the_program_that_has_it(port: str, other: int) -> None:
    from device.transport.serial_port import SerialPort

    with pytest.raises(OpenFailed) as failed:
        SerialPort(port, LineSettings(baud=9600))
    name = Path(f"/proc/{other}/comm").read_text().strip()
    assert str(failed.value) == f"{port} is in use by {name} (process {other}); close it there and try again."


def test_nobody_has_a_free_port_and_we_are_not_our_own_rival(port: str) -> None:
    assert holder_of(port) == ""
    ours = os.open(port, os.O_RDWR | os.O_NOCTTY)
    assert holder_of(port) == ""
    os.close(ours)


def test_who_is_behind_a_pseudo_terminal_is_no_rival(port: str, other: int) -> None:
    assert str(other) in holder_of(port)
    assert rival_of(port) == ""


def test_a_studio_is_called_by_its_name(tmp_path: Path) -> None:
    process = tmp_path / "4711"
    (process / "fd").mkdir(parents=True)
    (process / "fd" / "3").symlink_to("/dev/ttyUSB7")
    (process / "comm").write_text("python3\n")
    (process / "cmdline").write_bytes(b"python3\0-m\0app\0")
    (tmp_path / "17").mkdir()  # one that has ended meanwhile
    assert holder_of("/dev/ttyUSB7", tmp_path) == "another Twoletter Studio (process 4711)"
    (process / "comm").write_text("minicom\n")
    assert holder_of("/dev/ttyUSB7", tmp_path) == "minicom (process 4711)"
    assert holder_of("/dev/ttyUSB8", tmp_path) == ""
