"""The controller's end of the line: prompts, replies, echo, error codes, byte-split robustness, flow control."""

from __future__ import annotations

import pytest

from tests.device.simulator.bench import MS, Bench


def test_prompts_and_replies_of_the_manual() -> None:
    bench = Bench()
    assert bench.type("\r") == ":"  # dmc-1412-1414.txt l.546
    assert bench.type("TPX\r") == " 0000000000\r\n:"  # l.550, with the ten digits of PF 10.0
    assert bench.type("PR 4000\r") == ":"  # l.1378
    assert bench.type("PR ?\r") == " 0000004000\r\n:"
    assert bench.type("bg\r") == "?"  # l.1396
    assert bench.type("TC1\r") == "1 Unrecognized command\r\n:"  # l.1403


def test_every_command_of_a_line_has_its_prompt() -> None:
    assert Bench().type("DP 0;PR 100;TPX\r") == ":: 0000000000\r\n:"


def test_after_an_error_the_rest_of_the_line_is_dropped() -> None:
    bench = Bench()
    assert bench.type("PR 1;XX;PR 2\r") == ":?"
    assert bench.ask("PR ?") == " 0000000001"


def test_line_feeds_and_control_characters_are_ignored() -> None:
    assert Bench().type("\nTP\x01X\n\r\n") == " 0000000000\r\n:"


def test_backspace_takes_a_character_back() -> None:
    assert Bench().type("TPY\x08X\r") == " 0000000000\r\n:"


def test_echo() -> None:
    bench = Bench()
    assert bench.type("EO1\r") == ":"
    assert bench.type("TPX\r") == "TPX\r\n 0000000000\r\n:"
    assert bench.type("EO0\r") == "EO0\r\n:"
    assert bench.type("TPX\r") == " 0000000000\r\n:"


def test_too_long_a_line_is_error_5() -> None:
    bench = Bench()
    assert bench.type("NO " + "x" * 78 + "\r") == "?"
    assert bench.ask("TC1") == "5 Input buffer full"


def test_revision_needs_no_return() -> None:
    assert Bench("ssc3").type("\x12\x16") == "DMC1530 Rev 2.0h\r\n:"
    assert Bench("dmc1412").type("\x12\x16").startswith("DMC1412 Rev")


SESSION = 'PR 4000;SP 20000\rBGX\rTPX;bg;TPX\rTC1\rV1=10;V1=\r\x12\x16MG "a;b",V1{F4.2}\rAMX\rMG _RPX\r'


def answer_in_pieces(pieces: list[str]) -> str:
    bench = Bench()
    answer = "".join(bench.type(piece, ms=5) for piece in pieces)
    return answer + bench.wait(2000)


def test_bytes_cut_anywhere_give_the_same_replies() -> None:
    whole = answer_in_pieces([SESSION, ""])
    for cut in range(1, len(SESSION)):
        parts = answer_in_pieces([SESSION[:cut], SESSION[cut:]])
        # TPX in the middle of the move tells another position when it comes later: digits are not compared
        assert [c for c in parts if not c.isdigit()] == [c for c in whole if not c.isdigit()], cut
    assert whole.endswith(": 0000004000.0000\r\n:")


def test_overrun_without_handshake_is_error_5() -> None:
    bench = Bench(baud=38400, handshake=False)
    bench.type("WT 500\r", ms=20)
    answer = bench.type("TPX\r" * 100, ms=400)  # the port is busy waiting: the receive buffer runs over
    assert "?" in answer + bench.wait(2000)
    assert bench.simulation.unit.state.error_code in (1, 5)


def test_with_handshake_nothing_is_lost() -> None:
    bench = Bench(baud=38400, handshake=True)
    bench.type("WT 500\r", ms=20)
    answer = bench.type("TPX\r" * 100, ms=400) + bench.wait(5000)
    assert answer.count(" 0000000000\r\n:") == 100
    assert "?" not in answer


def test_a_trippoint_from_the_port_delays_the_following_commands() -> None:
    bench = Bench("dmc1412")  # dmc-1412-1414.txt l.988-991
    assert bench.type("PR 100\rWT 1000\rBG\r", ms=100) == ":"
    assert bench.position() == 0
    assert bench.wait(870) == ""  # 1000 samples are 976.6 ms
    assert bench.wait(20) == "::"
    bench.wait(100)
    assert bench.position() == 100


def test_program_output_is_unsolicited_with_bit_7_after_cw1() -> None:
    bench = Bench()
    bench.load('#A\nMG "HI"\nTPX\nV1=3\nV1={F2.0}\nEN')
    bench.type("CW1\r")
    answer = bench.type("XQ#A\r")
    plain = answer.encode("latin-1")
    marked = bytes(byte & 0x7F for byte in plain if byte & 0x80)
    assert bytes(byte for byte in plain if not byte & 0x80) == b":"
    assert marked == b"HI\r\n 0000000000\r\n 03\r\n"


def test_a_full_fifo_holds_the_program() -> None:
    bench = Bench()  # CW,0: dmc-1412-1414.txt l.1335
    bench.load('#A\nN=0\n#B\nMG "0123456789012345678901234567890123456789"\nN=N+1\nJP#B,N<50\nEN')
    bench.simulation.uarts[0].set_host_ready(False, bench.simulation.ticks)
    bench.simulation.execute("#A")
    bench.wait(2000)
    assert bench.simulation.unit.state.variables["N"] // 65536 in (3, 4)  # 128 places, 42 characters each
    assert bench.simulation.state()["threads"][0]["waiting_for"] == "output"
    bench.simulation.uarts[0].set_host_ready(True, bench.simulation.ticks)
    assert bench.wait(2000).count("0123456789\r\n") == 50


def test_with_cw_1_output_is_thrown_away_and_the_program_goes_on() -> None:
    bench = Bench()
    bench.load('#A\nCW,1\nN=0\n#B\nMG "0123456789012345678901234567890123456789"\nN=N+1\nJP#B,N<50\nEN')
    bench.simulation.uarts[0].set_host_ready(False, bench.simulation.ticks)
    bench.simulation.execute("#A")
    bench.wait(2000)
    assert bench.simulation.unit.state.variables["N"] // 65536 == 50
    bench.simulation.uarts[0].set_host_ready(True, bench.simulation.ticks)
    assert len(bench.wait(2000)) == 128


def test_xoff_holds_replies() -> None:
    bench = Bench()
    assert bench.type("\x13TPX\r") == ""
    assert bench.type("\x11") == " 0000000000\r\n:"


@pytest.mark.parametrize("baud", [300, 9600, 38400])
def test_a_paced_line_takes_its_time(baud: int) -> None:
    bench = Bench(baud=baud)
    characters = len("TPX\r") + len(" 0000000000\r\n:")
    seconds = characters * 10 / baud
    bench.simulation.receive(1, b"TPX\r")
    bench.simulation.advance(round(seconds * 1000 * MS) - MS // 2)
    early = bench.simulation.transmit(1)
    bench.simulation.advance(2 * MS)
    assert not early.endswith(b":")
    assert (early + bench.simulation.transmit(1)).endswith(b"\r\n:")


def test_stop_burst_in_command_mode() -> None:
    bench = Bench()
    bench.load("#A;JP#A")
    bench.simulation.execute("#A")
    answer = bench.type("\x11\x1b\\ST\rST\r")
    assert answer == "?:"
    assert not bench.simulation.unit.running()


def test_xon_is_heard_while_a_long_answer_waits() -> None:
    bench = Bench()
    program = "\n".join(["#A", *["NO 0123456789"] * 30, "EN"])  # far more than the 128 characters of l.1333
    bench.load(program)
    bench.type("\x13")
    assert bench.type("UL\r", ms=100) == ""
    answer = bench.type("\x11", ms=100)
    assert answer == program.replace("\n", "\r\n") + "\r\n\x1a:"


@pytest.mark.parametrize(("field", "calls"), [(1, 1), (2, 4)])
def test_characters_of_a_command_interrupt_too(field: int, calls: int) -> None:
    # dmc-1412-1414.txt l.3565-3576: m is the interrupt of port 1, o alone makes its characters data
    bench = Bench("dmc1412")
    bench.load(f"#A\nN=0\nCI {field}\n#B\nJP#B\n#COMINT\nN=N+1\nEN,1")
    bench.simulation.execute("#A")
    bench.wait(20)
    for character in "TC1\r":
        bench.type(character, ms=10)
    assert bench.simulation.unit.state.variables["N"] // 65536 == calls


@pytest.mark.parametrize("handshake", [0, 1])
def test_port_2_holds_the_program_only_with_handshake(handshake: int) -> None:
    # CC m,n: n=1 handshake (dmc-1412-1414.txt l.1291); a full FIFO of 128 characters stops the program (l.1333)
    bench = Bench("dmc1412")
    bench.type(f"CC 9600,{handshake},0,0\r")
    bench.load('#A\nN=0\n#B\nMG{P2}"123456789012345678"\nN=N+1\nJP#B,N<50\nEN')
    bench.simulation.uarts[1].set_host_ready(False, bench.simulation.ticks)
    bench.simulation.execute("#A")
    bench.wait(2000)
    count = bench.simulation.unit.state.variables["N"] // 65536
    assert count in (6, 7) if handshake else count == 50  # 20 characters each
    assert bench.simulation.unit.running() is bool(handshake)
    bench.simulation.uarts[1].set_host_ready(True, bench.simulation.ticks)
    bench.wait(2000)
    assert bench.simulation.transmit(2).count(b"8\r\n") == 50


def test_a_trace_slows_the_program_by_the_line() -> None:
    # l.2672: every line of the trace waits for room; 300 baud carries 30 characters a second
    bench = Bench(baud=300)
    bench.load("#A\nN=N+1\nJP#A")
    bench.type("N=0;TR1\r", ms=1000)
    bench.simulation.execute("#A")
    bench.wait(20_000)
    characters = len("001 N=N+1\r\n") + len("002 JP#A\r\n") + len("000 #A\r\n")
    assert bench.simulation.unit.state.variables["N"] / 65536 == pytest.approx((20 * 30 + 128) / characters, rel=0.15)


def test_a_stop_comes_through_where_both_directions_are_held() -> None:
    bench = Bench()
    bench.load("#A\nWT 10\nJP#A")
    bench.simulation.execute("#A")
    bench.type("\x13")
    bench.type("MG 1\r" * 200, ms=500)  # the answers fill the FIFO, then the commands the receive buffer: CTS holds
    assert not bench.simulation.port.clear_to_send
    bench.type("\x11\x1b\\ST\rST\r", ms=1000)  # the burst of STOP begins with XON
    assert not bench.simulation.unit.running()
    assert bench.simulation.port.clear_to_send
