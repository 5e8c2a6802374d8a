"""Motion commands, registers and status of the simulated controller against the manuals and closed forms."""

from __future__ import annotations

import pytest

from codegen.twoletter.problems import ERROR_TEXTS
from device.simulator.eeprom import Eeprom
from device.simulator.plant import Plant
from tests.device.simulator.bench import MS, Bench


@pytest.mark.parametrize(
    ("command", "question", "reply"),
    [
        ("KP 6", "KP?", " 0006.00"),  # dmc-1412-1414.txt l.979
        ("AC 150000", "AC?", " 00149504"),  # multiples of 1024, rounded down
        ("SP 3185", "SP?", " 00003184"),  # even
        ("SP -3185", "SP?", " 00003184"),  # sign taken away
        ("JG -4001", "JG?", "-00004000"),
        ("KI 0.5", "KI?", " 0000.500"),
        ("TL 9.9982", "TL?", " 9.9982"),
        ("IT 0.5", "IT?", " 0.5000"),
        ("ER 200", "ER?", " 00200"),  # l.4121
        ("PF 6.2", "PF?", " 06.2"),
        ("PR 100", "PR?", " 0000000100"),
    ],
)
def test_registers_keep_what_their_grain_allows(command: str, question: str, reply: str) -> None:
    bench = Bench("dmc1412")
    bench.ask(command)
    assert bench.ask(question) == reply


@pytest.mark.parametrize(
    ("name", "reply"),
    [
        ("SP", "25000"),
        ("AC", "256000"),
        ("DC", "256000"),
        ("KP", "6.00"),
        ("KD", "64.00"),
        ("KI", "0.000"),
        ("TL", "9.9982"),
        ("IL", "9.9982"),
        ("ER", "16384"),
        ("OE", "0"),
        ("FL", "2147483647"),
        ("BL", "-2147483648"),
        ("IT", "1.0000"),
        ("TW", "32766"),
        ("MT", "1.0"),
        ("TM", "1000"),
    ],
)
def test_factory_values(name: str, reply: str) -> None:
    bench = Bench("dmc1412")
    bench.ask("LZ1")
    assert bench.ask(f"{name}?").strip() == reply


@pytest.mark.parametrize(
    "command",
    ["SP 8000002", "AC 0", "KP 1024", "TL 10", "ER 32768", "OP 256", "SB 9", "IT 0", "TM 100", "FL 2147483648"],
)
def test_out_of_range_keeps_the_old_value(command: str) -> None:
    bench = Bench("ssc4")
    name = command[:2]
    before = bench.simulation.unit.state.registers.get(name, bench.simulation.unit.state.settings.get(name))
    code = bench.refused(command)
    assert code == 6
    after = bench.simulation.unit.state.registers.get(name, bench.simulation.unit.state.settings.get(name))
    assert after == before


def test_axis_lists() -> None:
    bench = Bench("ssc4")
    bench.ask("SP 1000,2000,,4000")
    assert bench.ask("LZ1;SP ?,?,?,?").removeprefix(":") == " 1000, 2000, 25000, 4000"
    bench.ask("SP ,500")
    assert bench.ask("SP ,?") == " 500"
    bench.ask("PRZ=7")
    assert bench.ask("PR ,,?") == " 7"
    bench.ask("DP -9,5,0,7")
    assert bench.ask("TP") == "-9, 5, 0, 7"  # dmc-1412-1414.txt l.3793-3804
    assert bench.ask("LZ0;TP").removeprefix(":") == "-0000000009, 0000000005, 0000000000, 0000000007"
    bench.ask("DP -5,5,0,7")
    assert bench.ask("TP{F2.2}") == "-05.00, 05.00, 00.00, 07.00"  # l.3814
    assert bench.ask("TP{$4.2}") == "$FFFB.00,$0005.00,$0000.00,$0007.00"


@pytest.mark.parametrize(
    ("model", "command"), [("ssc2", "PR ,,5"), ("ssc2", "BGZ"), ("ssc1", "TPY"), ("dmc1412", "PRY=5")]
)
def test_axes_that_are_not_there(model: str, command: str) -> None:
    assert Bench(model).refused(command) == 90


def move_time(distance: float, speed: float, acceleration: float, deceleration: float) -> float:
    """Seconds of a trapezoidal move."""
    return distance / speed + speed / (2 * acceleration) + speed / (2 * deceleration)


def test_a_profiled_move_takes_the_time_of_its_trapezoid() -> None:
    bench = Bench("dmc1412")  # dmc-1412-1414.txt l.915-922
    bench.load("#A\nPR 10000\nSP 20000\nAC 100000\nDC 100000\nBG\nAM\nEN")
    bench.simulation.execute("#A")
    bench.simulation.run_until_idle(5000 * MS)
    assert bench.position() == 10000
    assert bench.simulation.ticks / MS / 1000 == pytest.approx(move_time(10000, 20000, 99328, 99328) + 0.003, abs=0.003)


def test_errors_of_begin() -> None:
    bench = Bench("ssc4")
    bench.ask("MOX")
    assert bench.refused("PR 100;BGX") == 20
    bench.ask("SHX")
    bench.ask("PR 20000;BGX")
    assert bench.refused("BGX") == 21
    assert bench.refused("PR 5") == 7
    assert bench.refused("DP 5") == 7
    assert bench.refused("DC 5000") == 7
    assert bench.refused("JG 5") == 13
    assert bench.ask("SP 1000;AC 5000") == ":"
    assert bench.ask("PR ,5;BGY") == ":"
    bench.ask("STX")
    bench.wait(500)
    bench.simulation.stimulus("fls_x", 0)
    bench.wait(5)
    assert bench.refused("PR 100;BGX") == 22
    assert bench.ask("TC1").startswith("0")
    assert bench.ask("PR -100;BGX") == ":"
    assert bench.refused("BGS") == 24


def test_begin_starts_all_axes_or_none() -> None:
    bench = Bench("ssc4")
    bench.ask("MOY;PR 100,100")
    assert bench.refused("BGXY") == 20
    assert bench.ask("MG _BGX{F1.0},_BGY{F1.0}") == " 0 0"


def test_jog_changes_on_the_way() -> None:
    bench = Bench("dmc1412")  # dmc-1412-1414.txt l.946-956
    bench.ask("KD 200;JG 10000;BG")
    bench.wait(1000)
    assert bench.ask("TV") == " 00010000"
    bench.ask("JG -40000")
    bench.wait(1500)
    assert bench.ask("TV") == "-00040000"
    bench.ask("ST")
    bench.wait(500)
    assert bench.ask("SC") == "004"
    assert bench.ask("MG _BG{F1.0}") == " 0"


def test_jog_speed_given_during_a_stop_is_for_the_next_jog() -> None:
    bench = Bench("ssc1")
    bench.run(
        "SH\nJG 40000\nBGX\nWT 500\nSTX\nJG -2000\nAMX\nS=_SCX\nP=_RPX\nBGX\nASX\nP=_RPX\nWT 512\nP=_RPX-P\nSTX\nEN"
    )
    variables = bench.simulation.state()["variables"]
    assert variables["S"] == 4
    assert variables["P"] == pytest.approx(-1000, abs=5)  # 512 samples at 2000 counts/s


def test_increment_position() -> None:
    bench = Bench("ssc2")
    bench.ask("PR 5000;BGX")
    bench.ask("IP 1000")
    assert bench.refused("IP -1000") == 16
    bench.wait(1500)
    assert bench.position() == 6000
    bench.ask("IP -500")  # standing: as PR and BG
    bench.wait(500)
    assert bench.position() == 5500


def test_abort_and_stop_codes() -> None:
    bench = Bench("ssc1")
    bench.load("#A;JP#A")
    bench.type("XQ#A;JG 5000;BG\r", ms=200)
    bench.ask("AB1")
    assert bench.simulation.unit.running()
    assert bench.ask("SC") == "007"
    bench.type("BG\r", ms=100)
    bench.ask("AB")
    assert not bench.simulation.unit.running()
    bench.type("XQ#A;BG\r", ms=100)
    bench.simulation.stimulus("abort", 0)
    bench.wait(20)
    assert bench.ask("SC") == "006"
    assert bench.ask("MG _AB{F1.0}") == " 0"
    assert not bench.simulation.unit.running()


def test_off_on_error() -> None:
    bench = Bench("dmc1412")
    bench.ask("ER 100;OE 1")
    bench.simulation.stimulus("position_x", 400)
    bench.wait(20)
    axis = bench.simulation.state()["axes"]["X"]
    assert (axis["stop_code"], axis["motor_on"], axis["amp_enable"]) == (8, False, False)
    assert int(bench.ask("TS")) & 0b100000  # motor off
    bench.ask("SH")
    assert bench.ask("TE") == " 0000000000"


def test_software_limits() -> None:
    bench = Bench("dmc1412")  # dmc-1412-1414.txt l.4140-4146
    bench.ask("DP 0;BL -2000;FL 2000;JG 2000;BG")
    bench.wait(2000)
    assert 2000 <= bench.position() <= 2050
    assert bench.ask("SC") == "002"


def test_tell_switches_at_rest_and_in_trouble() -> None:
    bench = Bench("ssc1")
    assert bench.ask("TS") == "015"
    bench.simulation.stimulus("fls_x", 0)
    bench.wait(2)
    assert bench.ask("TS") == "007"
    assert bench.ask("MG _LFX{F1.0},_LRX{F1.0}") == " 0 1"
    bench.ask("CN 1")
    assert bench.ask("MG _LFX{F1.0},_LRX{F1.0}") == " 0 1"
    assert bench.ask("TS") == "011"


@pytest.mark.parametrize("polarity", ["CN,-1", "CN,1"])
def test_homing_ends_at_the_index(polarity: str) -> None:
    plant = Plant(home_switch=(900, 1000), index_at=137)
    bench = Bench("dmc1412", plants={"X": plant})  # dmc-1412-1414.txt l.2325-2366
    bench.ask(f"{polarity};KD 200;SP 5000;AC 1000000;DC 1000000")
    home = bench.ask("MG _HM{F1.0}")
    assert home == (" 1" if polarity == "CN,-1" else " 0")
    start = bench.position()
    bench.ask("HM;BG")
    bench.wait(60)
    assert (bench.position() < start) is (home == " 1")


def test_input_and_output_commands() -> None:
    bench = Bench("dmc1412")  # l.3910-3954
    bench.ask("OP6")
    assert bench.ask("MG @OUT[1]{F1.0},@OUT[2]{F1.0},@OUT[3]{F1.0}") == " 0 1 1"
    bench.ask("CB2;SB1")
    assert bench.ask("OP?") == " 005"
    bench.simulation.stimulus("in1", 0)
    bench.ask("OB 3,@IN [1]&@IN [2];OB1,1=1")
    assert bench.ask("MG _OP{F1.0}") == " 1"
    assert bench.ask("TI") == "126"
    assert bench.refused("SB 4") == 6
    bench.simulation.stimulus("an1", 2.5)
    assert bench.ask("MG @AN[1]{F1.3}") == " 2.500"


def test_message_formats() -> None:
    bench = Bench("dmc1412")
    bench.ask('RESULT=4.1;STR="TESTME"')
    assert bench.ask('MG "The Final Value is",RESULT{F5.2}') == "The Final Value is 00004.10"  # l.3668
    bench.ask("RESULT=999999.999")
    assert bench.ask('MG "The Final Value is",RESULT{F5.2}') == "The Final Value is 99999.99"
    assert bench.ask("MG STR{S3}") == "TES"
    assert bench.type("MG {^07},{^255}\r") == "\x07\xff\r\n:"  # l.3709
    assert bench.type('MG "A"{N}\r') == "A:"
    bench.ask('MG{P2}"TO PORT 2"')
    assert bench.simulation.transmit(2) == b"TO PORT 2\r\n"


def test_formats_of_variables() -> None:
    bench = Bench("dmc1412")  # l.3840-3877
    bench.ask("V1=10")
    assert bench.ask("V1=") == " 0000000010.0000"
    assert bench.ask("VF2.2;V1=").removeprefix(":") == " 10.00"
    assert bench.ask("VF-2.2;V1=").removeprefix(":") == "$0A.00"
    assert bench.ask("VF1;V1=").removeprefix(":") == " 9"
    assert bench.ask("V1={F4.2}") == " 0010.00"
    assert bench.ask("V1={$4.2}") == "$000A.00"
    assert bench.ask('V1="ALPHA";V1={S4}').removeprefix(":") == "ALPH"


@pytest.mark.parametrize(
    ("command", "code"),
    [
        ("XX 1", 1),
        ("pr 1", 1),
        ("JP #A", 2),
        ("SP 9000000", 6),
        ("XQ #NO", 10),
        ("PR", 50),
        ("SB ?", 51),
        ('V1="TOOLONGTEXT"', 52),
        ("MG V1{Q}", 53),
        ("V1=A[1", 55),
        ("V1=_XX", 58),
        ("V1=(1+2", 59),
        ("DM A[9999]", 6),
        ("V1=NOVAR", 57),
        ("V1=@XYZ[1]", 57),
    ],
)
def test_error_codes_and_their_texts(command: str, code: int) -> None:
    bench = Bench("ssc4")
    assert bench.type(command + "\r").endswith("?")
    assert bench.ask("TC1") == f"{code} {ERROR_TEXTS[code]}"


def test_a_stepper_needs_its_jumper() -> None:
    bench = Bench("ssc2", plants={"Y": Plant(drive="stepper")})  # SSC manual l.772
    assert bench.refused("MO;MT 2") == 96
    assert bench.ask("MO;MT ,-2.5") == ":"
    assert bench.ask("MT ?,?") == " 1.0,-2.5"
    assert bench.refused("SP ,2000002") == 6  # 2 000 000 steps/s
    bench.ask("SHY;PR ,500;BGY")
    bench.wait(500)
    assert bench.ask("TDY") == " 0000000500"


def test_an_external_clock_is_said_to_be_missing() -> None:
    eeprom = Eeprom()
    bench = Bench("dmc1412", eeprom=eeprom)
    bench.ask("TM 2000;TM -1;WT 10")
    assert bench.simulation.unit.clock.period == 2000  # the last sample time goes on
    assert bench.ask("TM?") == "-00001"
    assert bench.simulation.notices == [
        "no external sample clock is connected (negative TM): the last sample time goes on"
    ]
    bench.type("BN\r", 500)  # SSC manual l.1231: burned in all but one
    assert Bench("dmc1412", eeprom=eeprom).simulation.notices == bench.simulation.notices


@pytest.mark.parametrize("operand", ["_VS", "_LM", "_AV", "_VE", "_CS"])
def test_operands_of_commands_that_a_model_has_not(operand: str) -> None:
    assert Bench("dmc1412").refused(f"MG {operand}") == 58  # commands.md 11
    assert Bench("ssc2").ask(f"MG {operand}")
