"""The simulated serial port: exact character times, overrun, handshake, flow control."""

from __future__ import annotations

import pytest

from device.simulator.uart import NEVER, OUTPUT_FIFO, RECEIVE_BUFFER, Uart

SECOND = 1_024_000  # ticks


def taken(uart: Uart, now: int) -> bytes:
    found = bytearray()
    while (byte := uart.take(now)) is not None:
        found.append(byte)
    return bytes(found)


@pytest.mark.parametrize("baud", [300, 1200, 9600, 19200, 38400])
def test_a_second_carries_a_tenth_of_the_baud_rate(baud: int) -> None:
    uart = Uart(baud=baud, handshake=False, receive_size=1 << 20)
    uart.receive(bytes(baud), 0)
    uart.run(SECOND - 1)
    assert len(uart.buffer) == baud // 10 - 1
    uart.run(SECOND)
    assert len(uart.buffer) == baud // 10


def test_a_character_is_there_when_its_stop_bit_is() -> None:
    uart = Uart(baud=9600)
    uart.receive(b"A", 5)
    assert uart.due_in() == 5 + 1067  # 10 bits of 1 024 000 / 9600 ticks, rounded up
    uart.run(5 + 1066)
    assert taken(uart, 0) == b""
    uart.run(5 + 1067)
    assert taken(uart, 0) == b"A"


def test_character_times_do_not_depend_on_how_they_are_looked_at() -> None:
    once, often = Uart(baud=19200), Uart(baud=19200)
    for uart in (once, often):
        uart.receive(b"x" * 50, 3)
    for tick in range(0, 20_000, 7):
        often.run(tick)
    often.run(20_000)
    once.run(20_000)
    assert list(once.history) == list(often.history)


def test_without_handshake_what_does_not_fit_is_lost() -> None:
    uart = Uart(baud=None, handshake=False)
    uart.receive(bytes(RECEIVE_BUFFER + 3), 0)
    uart.run(0)
    assert len(uart.buffer) == RECEIVE_BUFFER
    assert uart.overruns == 3


def test_with_handshake_the_host_waits_and_nothing_is_lost() -> None:
    uart = Uart(baud=38400, handshake=True)
    data = bytes(range(256)) * 4
    uart.receive(data, 0)
    uart.run(10 * SECOND)
    assert not uart.clear_to_send
    assert uart.due_in() == NEVER
    found = bytearray()
    now = 10 * SECOND
    while len(found) < len(data):
        found += taken(uart, now)
        now += SECOND
        uart.run(now)
    assert bytes(found) == data
    assert uart.overruns == 0


def test_output_leaves_in_its_time() -> None:
    uart = Uart(baud=9600)
    uart.send(b"OK\r\n", 0)
    uart.run(2 * 1066)
    assert uart.transmit() == b"O"
    uart.run(4 * 1067)
    assert uart.transmit() == b"K\r\n"


def test_output_waits_for_the_host() -> None:
    uart = Uart()
    uart.set_host_ready(False, 0)
    uart.send(b"x" * OUTPUT_FIFO, 0)
    uart.run(SECOND)
    assert uart.transmit() == b""
    assert uart.room() == 0
    uart.set_host_ready(True, SECOND)
    uart.run(SECOND)
    assert uart.transmit() == b"x" * OUTPUT_FIFO


def test_xoff_holds_output_until_xon() -> None:
    uart = Uart(xon_xoff=True)
    uart.receive(b"\x13", 0)
    uart.run(0)
    uart.send(b"abc", 0)
    uart.run(SECOND)
    assert uart.transmit() == b""
    uart.receive(b"\x11", SECOND)
    uart.run(SECOND)
    assert uart.transmit() == b"abc"
    assert taken(uart, SECOND) == b""


def test_characters_that_only_look_like_flow_control_are_left_alone() -> None:
    uart = Uart(xon_xoff=True)
    uart.receive(b"\x12\x13\x11", 0)  # ^R^S is the master reset, a ^Q ends a download (dmc-1412-1414.txt l.3408)
    uart.run(0)
    assert not uart.stopped
    assert taken(uart, 0) == b"\x12\x13\x11"
    other = Uart()
    other.receive(b"\x13", 0)
    other.run(0)
    assert taken(other, 0) == b"\x13"


def test_a_host_that_is_held_by_xoff_loses_nothing() -> None:
    uart = Uart(baud=9600, handshake=False, tells_xoff=True)
    data = bytes(range(32, 132)) * 6
    sent, now, held, found = 0, 0, False, bytearray()
    while len(found) < len(data):
        if not held and sent < len(data):  # a host that sends one character after the other until it is told to wait
            uart.receive(data[sent : sent + 1], now)
            sent += 1
        now += SECOND * 10 // 9600 + 1
        uart.run(now)
        for byte in uart.transmit():
            held = byte == 0x13
        if held or sent == len(data):
            found += taken(uart, now)
    assert bytes(found) == data
    assert uart.overruns == 0


def test_without_handshake_characters_leave_whether_the_host_is_ready_or_not() -> None:
    uart = Uart(handshake=False)
    uart.set_host_ready(False, 0)
    uart.send(b"abc", 0)
    uart.run(SECOND)
    assert uart.transmit() == b"abc"
