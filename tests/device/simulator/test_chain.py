"""Daisy chains: who listens, who answers, what passes (dmc-1412-1414.txt l.1300-1324)."""

from __future__ import annotations

from pathlib import Path

import pytest

from codegen.models import model
from device.simulator.chain import Chain, make_chain
from device.simulator.eeprom import Eeprom, read_eeproms
from device.simulator.process import SimulatorProcess
from device.simulator.simulation import Simulation
from tests.device.simulator.bench import MS, Bench
from tests.device.simulator.test_server import connect, until


class Host:
    """The host at the end of a chain's line."""

    def __init__(self, count: int = 2, name: str = "dmc1412", eeproms: list[Eeprom] | None = None, **more: int) -> None:
        self.chain: Chain = make_chain(model(name), None, eeproms or read_eeproms(None, count), **more)

    def type(self, text: str, ms: float = 40) -> str:
        self.chain.receive(1, text.encode("latin-1"))
        return self.wait(ms)

    def wait(self, ms: float) -> str:
        self.chain.advance(round(ms * MS))
        return self.chain.transmit(1).decode("latin-1")

    def positions(self) -> list[int]:
        return [simulation.unit.motion.reference(0) for simulation in self.chain.units]


def test_two_controllers_on_one_line() -> None:
    host = Host()
    assert host.type("%0\r") == ":"  # l.1316-1324
    assert host.type("PR 500\r") == ":"
    assert host.type("%1\r") == ":"
    assert host.type("PR 700\r") == ":"
    assert host.type("!BG\r") == ":"  # only address 0 answers
    host.wait(1000)
    assert host.positions() == [500, 700]


def test_two_ssc_with_their_jumpers() -> None:
    host = Host(name="ssc4")  # SSC manual l.1199: JP20
    for line in ("%0", "PR 500,1000,2000,1500", "%1", "PR 700,1500,2500", "!BG"):
        assert host.type(line + "\r") == ":", line
    host.wait(2000)
    assert host.positions() == [500, 700]
    assert host.type("RPXYZ\r") == " 0000000700, 0000001500, 0000002500\r\n:"


def test_only_the_addressed_one_answers() -> None:
    host = Host(8)
    assert host.type("!NUMBER=0\r") == ":"
    for place in range(8):
        assert host.type(f"%{place}\r") == ":"
        assert host.type(f"NUMBER={place + 1}\r") == ":"
    assert host.type("NUMBER={F2.0}\r") == " 08\r\n:"
    assert host.type("!NUMBER={F2.0}\r") == " 01\r\n:"
    assert host.type("%3;NUMBER={F2.0}\r") == " 04\r\n:"
    assert host.type("XY 5\r") == "?"
    assert host.type("TC\r").startswith("001")
    assert host.type("!XY 5\r") == "?"
    assert host.type("%4;TC\r").startswith("001")  # it was refused there too, silently


def test_before_the_first_choice_address_0_is_talked_to() -> None:
    host = Host()
    assert host.type("V=1\r") == ":"
    assert "V" not in host.chain.units[1].unit.state.variables
    host.type("%1;RS\r", 1500)
    assert host.type("TC\r") == "000\r\n:"  # %1 stays until the next one, also over a reset
    assert host.type("%0;V={F1.0}\r") == " 1\r\n:"


def test_an_address_nobody_has_is_silent() -> None:
    host = Host()
    assert host.type("%5\r") == ""
    assert host.type("TC\r") == ""
    assert host.type("%0\r") == ":"
    assert host.type("%9\r") == "?"
    assert host.type("TC\r").startswith("006")


def test_stop_reaches_all_while_one_waits() -> None:
    host = Host(3)
    host.type("!JG 1000\r")
    host.type("!BG\r")
    host.type("%1\r")
    assert host.type("AM\r") == ""  # address 1 does not take commands until its motion ends
    host.type("!ST\r", 500)
    assert host.chain.units[0].unit.moving() is False
    assert host.chain.units[2].unit.moving() is False
    assert host.chain.units[1].unit.moving() is True


def test_what_programs_send_comes_to_the_host() -> None:
    host = Host(3)
    host.chain.units[2].load_program('#A\nMG "FROM TWO"\nEN')
    host.chain.units[2].execute("#A")
    assert host.wait(50) == "FROM TWO\r\n"


def test_download_to_one() -> None:
    host = Host()
    host.type("%1\r")
    assert host.type("DL\r#A\rEN\r\\") == ":"
    assert host.chain.units[1].unit.state.program == ("#A", "EN")
    assert host.chain.units[0].unit.state.program == ()


def test_without_cc_nothing_passes() -> None:
    host = Host()
    assert host.type("CC 9600,0,0,0\r") == ":"
    assert host.type("%1\r") == ""
    assert host.type("TC\r") == ""
    assert host.type("%0\r") == ":"
    assert host.type("CC 9600,0,1,0\r") == ":"
    assert host.type("%1\r") == ":"


def test_a_general_port_commands_the_next_one() -> None:
    host = Host(name="ssc4")  # SSC manual l.1170: messages to another controller
    host.type("CC 9600,0,0,0\r")
    host.chain.units[1].unit.state.selected = True
    host.type('MG {P2} "PRX=77;BGX"\r')
    host.wait(500)
    assert host.positions()[1] == 77


def test_addresses_are_burned() -> None:
    eeproms = read_eeproms(None, 2)
    host = Host(eeproms=eeproms)
    host.type("%1;SA 6\r")
    assert host.type("BN\r", 500) == ":"
    again = Host(eeproms=eeproms)
    assert again.type("%1\r") == ""
    assert again.type("%6\r") == ":"


def test_a_file_for_each(tmp_path: Path) -> None:
    Host(eeproms=read_eeproms(tmp_path / "burned", 3))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["burned", "burned.1", "burned.2"]


def test_any_slicing_gives_the_same() -> None:
    ends = []
    for step in (1, 7, 40):
        host = Host(baud=9600)
        said = host.type("%1\rPR 300;BG\r!TP\r%0\rTC\r", 0)
        for _ in range(280 // step):
            said += host.wait(step)
        ends.append(
            (said, host.positions(), [simulation.motion.snapshot().tobytes() for simulation in host.chain.units])
        )
    assert ends[0][0].count(":") == 6
    assert " 0000000000\r\n" in ends[0][0]
    assert ends[0] == ends[1] == ends[2]


def test_alone_a_controller_answers_whatever_its_address() -> None:
    bench = Bench("dmc1412")
    assert bench.ask("SA 3") == ""
    assert bench.ask("%3") == ""
    assert bench.type("!TC\r") == ""  # address 0 would answer
    assert bench.type("%0\r") == ""
    assert bench.type("TC\r") == ""
    assert bench.type("%3\r") == ":"
    assert bench.refused("SA 8") == 6


def test_stimuli_by_place() -> None:
    host = Host()
    host.chain.stimulus("1:in1", 0)
    host.chain.stimulus("in2", 0)
    assert [simulation.state()["inputs"] & 3 for simulation in host.chain.units] == [1, 2]
    assert [state["inputs"] & 3 for state in host.chain.state()["chain"]] == [1, 2]
    with pytest.raises(KeyError, match="no controller 2"):
        host.chain.stimulus("2:in1", 0)


@pytest.mark.parametrize("count", [0, 9])
def test_a_chain_has_one_to_eight(count: int) -> None:
    with pytest.raises(ValueError, match="1 to 8"):
        Chain([Simulation(model("ssc1")) for _ in range(count)])


@pytest.mark.alone
def test_a_served_chain() -> None:
    with SimulatorProcess("dmc1412", chain=2) as simulator:
        client = connect(simulator.address)
        client.sendall(b"%1\r")
        assert until(client, b":") == b":"
        client.sendall(b"PR 700;BG;AM;RP\r")
        assert until(client, b"\r\n:") == b"::: 0000000700\r\n:"
        assert [state["axes"]["X"]["commanded"] for state in simulator.state()["chain"]] == [0, 700]


def test_the_sample_clock_of_another_controller() -> None:
    # SSC manual l.1231: TM-1 in all but one, which is the source
    host = Host(name="ssc1")
    for line in ("%0", "TM 2000", "%1", "TM -1", "!WT 1"):
        assert host.type(line + "\r") == ":", line
    before = [simulation.unit.sample for simulation in host.chain.units]
    host.wait(1000)  # true milliseconds: 512 samples of 2/1024 s
    counted = [simulation.unit.sample - was for simulation, was in zip(host.chain.units, before, strict=True)]
    assert counted == [512, 512]
    ticks = [simulation.unit.clock.tick for simulation in host.chain.units]
    assert (ticks[0] - ticks[1]) % 2000 == 0
    assert not host.chain.units[1].unit.notices
    host.type("TM 1000\r")  # its own clock again
    before = [simulation.unit.sample for simulation in host.chain.units]
    host.wait(1000)
    assert host.chain.units[1].unit.sample - before[1] == 1024
