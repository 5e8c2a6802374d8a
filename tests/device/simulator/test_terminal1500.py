"""The TERM-1500: display, escape commands and keys (dmc-1412-1414.txt l.5161-5408), and at work on port 2."""

from __future__ import annotations

import pytest

from codegen.models import model
from device.simulator.simulation import Simulation
from device.terminal1500 import HAND_HELD, PANEL, Terminal
from tests.device.simulator.bench import MS

BLANK = " " * 20


def shown(data: bytes) -> Terminal:
    """A terminal that has got these characters."""
    terminal = Terminal()
    terminal.receive(data)
    return terminal


def filled() -> Terminal:
    """Four rows of letters, the cursor in row 2, column 3."""
    return shown(b"a" * 20 + b"b" * 20 + b"c" * 20 + b"d" * 20 + b"\x1bY\x21\x22")


# -------------------------------------------------------------------- display


def test_four_rows_of_twenty() -> None:
    terminal = shown(b"one\r\ntwo\r\nthree\r\nfour")
    assert terminal.lines == tuple(text.ljust(20) for text in ("one", "two", "three", "four"))
    assert (terminal.row, terminal.column) == (3, 4)


def test_a_fifth_line_scrolls() -> None:
    assert [line.strip() for line in shown(b"1\r\n2\r\n3\r\n4\r\n5").lines] == ["2", "3", "4", "5"]


def test_a_full_line_goes_on_below_and_a_return_behind_it_costs_no_row() -> None:
    assert shown(b"x" * 21).lines[:2] == ("x" * 20, "x".ljust(20))
    assert shown(b"x" * 20 + b"\r\ny").lines[:2] == ("x" * 20, "y".ljust(20))


def test_marked_characters_are_shown_and_counted() -> None:
    terminal = shown(bytes(byte | 0x80 for byte in b"HI"))  # CW1; the terminal wants space parity (l.5322)
    assert terminal.lines[0] == "HI".ljust(20) and terminal.parity_errors == 2


# -------------------------------------------------------------------- escapes


@pytest.mark.parametrize(
    ("letters", "place"),
    [("A", (0, 2)), ("B", (2, 2)), ("C", (1, 3)), ("D", (1, 1)), ("H", (0, 0)), ("E", (0, 0)), ("I", (1, 2))],
)
def test_the_cursor_moves(letters: str, place: tuple[int, int]) -> None:
    terminal = filled()
    terminal.receive(f"\x1b{letters}".encode())
    assert (terminal.row, terminal.column) == place


@pytest.mark.parametrize("letter", "ABCD")
def test_the_cursor_stops_at_the_edge_and_never_scrolls(letter: str) -> None:
    terminal = filled()
    before = terminal.lines
    terminal.receive(f"\x1b{letter}".encode() * 30)
    assert terminal.lines == before
    place = (terminal.row, terminal.column)
    assert place == {"A": (0, 2), "B": (3, 2), "C": (1, 19), "D": (1, 0)}[letter]


def test_position_by_row_and_column() -> None:
    # 1F hex is added: row 1 is 20 hex, column 20 is 33 hex; the manual prints 3F for it (l.5268), which is the edge too
    for column in (0x33, 0x3F):
        terminal = shown(b"\x1bY\x20" + bytes((column,)) + b"X")
        assert terminal.lines[0] == " " * 19 + "X"
    assert shown(b"\x1bY\x23\x20Z").lines[3] == "Z".ljust(20)


@pytest.mark.parametrize(
    ("letter", "lines"),
    [
        ("E", (BLANK, BLANK, BLANK, BLANK)),
        ("I", (BLANK, BLANK, BLANK, BLANK)),
        ("J", ("a" * 20, "bb".ljust(20), BLANK, BLANK)),
        ("K", ("a" * 20, "bb".ljust(20), "c" * 20, "d" * 20)),
        ("M", ("a" * 20, BLANK, "c" * 20, "d" * 20)),
        ("H", ("a" * 20, "b" * 20, "c" * 20, "d" * 20)),
    ],
)
def test_erasing(letter: str, lines: tuple[str, ...]) -> None:
    terminal = filled()
    terminal.receive(f"\x1b{letter}".encode())
    assert terminal.lines == lines


def test_sounds_and_styles() -> None:
    terminal = shown(b"\x1bT\x1bL\x1bP\x1bO")
    assert list(terminal.sounds) == ["short bell", "long bell", "click", "alert"]
    for letters, name, on in (("F", "underscore", True), ("R", "blinking", True), ("U", "key_click", True)):
        terminal.receive(f"\x1b{letters}".encode())
        assert getattr(terminal, name) is on
    for letters, name in (("G", "underscore"), ("S", "blinking"), ("V", "key_click")):
        terminal.receive(f"\x1b{letters}".encode())
        assert getattr(terminal, name) is False


def test_it_tells_who_it_is() -> None:
    assert bytes(shown(b"\x1bZ").answers) == b"TT1" + b"1.0"


def test_an_unknown_escape_shows_nothing() -> None:
    assert shown(b"\x1bqOK").lines[0] == "OK".ljust(20)


# ----------------------------------------------------------------------- keys


def keyed(keys: tuple[tuple[object, ...], ...], kind: str) -> list[list[object]]:
    """The codes of a keypad as the manual prints them: a character, or its number."""
    return [[getattr(key, kind) for key in row] for row in keys]


def codes(*rows: str) -> list[list[int]]:
    """Rows of a map: characters, numbers in brackets, `_` for nothing."""
    names = {"_": 0, "SPACE": 32, "BKSPC": 8, "ENTER": 13, "ESC": 27, "CTRL": 0, "SHIFT": 0}

    def code(word: str) -> int:
        if word in names:
            return names[word]
        return int(word[1:-1]) if word.startswith("(") else ord(word)

    return [[code(word) for word in row.split()] for row in rows]


def test_hand_held_keys() -> None:  # l.5204-5222; minus and dot beside the 0 are not printed
    assert keyed(HAND_HELD, "alone") == codes(
        "(22) (23) (24) (25) (26)", "_ 1 2 3 _", "_ 4 5 6 _", "_ 7 8 9 _", "_ - 0 . _", "CTRL SHIFT SPACE BKSPC ENTER"
    )
    assert keyed(HAND_HELD, "shifted") == codes(
        "A B C D E", "F G H I J", "K L M N O", "P Q R S T", "U V W X Y", "CTRL SHIFT Z , ?"
    )
    assert keyed(HAND_HELD, "controlled") == codes(
        "(18) (16) (9) (4) (17)", '(19) (2) ! " %', "* + / $ ;", "< > \\ [ ]", "^ - @ { }", "CTRL SHIFT ESC = #"
    )


def test_panel_keys() -> None:  # l.5236-5251; the dot is not printed
    assert keyed(PANEL, "alone") == codes(
        "(22) _ 1 2 3 _", "(23) _ 4 5 6 _", "(24) _ 7 8 9 _", "(25) _ - 0 . _", "(26) CTRL SHIFT SPACE BKSPC ENTER"
    )
    assert keyed(PANEL, "shifted") == codes(
        "A F G H I J", "B K L M N O", "C P Q R S T", "D U V W X Y", "E CTRL SHIFT Z , ?"
    )
    assert keyed(PANEL, "controlled") == codes(
        '(18) (19) (2) ! " %', "(16) * + / $ ;", "(9) < > \\ [ ]", "(4) ^ - @ { }", "(17) CTRL SHIFT ESC = #"
    )


def test_the_manuals_examples_of_keys() -> None:
    keys = HAND_HELD[::-1]  # [m,n]: column m, row n from below (l.5224)
    terminal = Terminal()
    assert terminal.press(keys[2 - 1][1 - 1], shift=True) == b"U"
    assert terminal.press(keys[1 - 1][5 - 1], control=True) == b"#"
    assert terminal.press("SPACE", control=True) == b"\x1b"  # CTRL SPACE sends ESC (l.5259)
    assert terminal.press("CTRL") == b"" and terminal.press("U") == b""


def test_control_shift_f1_configures() -> None:
    terminal = Terminal()
    assert terminal.press("F1", shift=True, control=True) == b"" and terminal.configuring


def test_names_of_keys() -> None:
    for keys in (HAND_HELD, PANEL):
        names = [key.name for row in keys for key in row]
        assert len(names) == 30 == len(set(names))
        assert {"F1", "F5", "0", "9", "SPACE", "BKSPC", "ENTER", "CTRL", "SHIFT"} <= set(names)


# -------------------------------------------------------------------- at work


class Operator:
    """A terminal on port 2 of a simulated controller."""

    def __init__(self, name: str, program: str, *, baud: int | None = None) -> None:
        self.simulation = Simulation(model(name), baud=baud)
        self.simulation.load_program(program)
        self.simulation.execute(0)
        self.terminal = Terminal(PANEL)
        self.wait(60)

    def wait(self, ms: int) -> None:
        for _ in range(ms):
            self.simulation.advance(MS)
            self.terminal.receive(self.simulation.transmit(2))
            if self.terminal.answers:
                self.simulation.receive(2, bytes(self.terminal.answers))
                self.terminal.answers.clear()

    def press(self, *keys: str) -> None:
        for key in keys:
            self.simulation.receive(2, self.terminal.press(key))
            self.wait(20)

    def type(self, text: str) -> None:
        for character in text:
            self.simulation.receive(2, self.terminal.type(character))
            self.wait(5)

    @property
    def rows(self) -> list[str]:
        return [line.rstrip() for line in self.terminal.lines]

    def variable(self, name: str) -> float:
        return self.simulation.unit.state.variables[name] / 65536

    def positions(self) -> list[int]:
        return [self.simulation.unit.motion.reference(axis) for axis in self.simulation.unit.axes()]

    def speed(self) -> float:
        """Commanded counts a second (of 1024 samples) over the next 100 samples."""
        before = self.positions()[0]
        self.simulation.advance(100 * 1000)
        return (self.positions()[0] - before) * 10.24


def test_example_1() -> None:  # l.5348-5352
    program = '#A\nCC 9600,0,0,1\nV1=3.14\nMG{P2} "Hello There", V1{F2.1}\nIN{P2} "Enter Value", NUM\nEN'
    operator = Operator("dmc1412", program)
    assert operator.rows[0] == "Hello There 03.1"
    assert operator.rows[1] == "Enter Value"
    operator.type("42.5")
    assert operator.rows[1] == "Enter Value42.5"  # echo by CC's last field
    operator.press("ENTER")
    assert operator.variable("NUM") == 42.5
    assert not operator.simulation.unit.running()


KEYS_MOVE = """#A
CI 0,2
CC 9600,0,0,1
MG {P2} "press F1 to start X"
MG {P2} "Press F2 to start Y"
#B;JP#B;EN
#COMINT
JS #XMOVE,P2CH=F1
JS #YMOVE,P2CH=F2
EN0,1
#XMOVE;PR1000;BGX;EN
#YMOVE;PR,1000;BGY;EN"""


def test_example_2_function_keys_move_the_axes() -> None:  # l.5358-5373; note 2: CI has two fields here
    operator = Operator("ssc2", KEYS_MOVE)
    assert operator.rows[:2] == ["press F1 to start X", "Press F2 to start Y"]
    operator.press("F3")
    operator.wait(500)
    assert operator.positions() == [0, 0]
    operator.press("F1")
    operator.wait(500)
    assert operator.positions() == [1000, 0]
    operator.press("F2")
    operator.wait(500)
    assert operator.positions() == [1000, 1000]
    operator.press("F1")
    operator.wait(500)
    assert operator.positions() == [2000, 1000]


JOG = """#AUTO
SPEEDX=10000
CI ,2
JG SPEEDX
BGX
#PRINT
MG{P2}"TO CHANGE SPEEDS"
MG{P2}"TYPE X"
MG{P2}"TYPE S TO STOP"
#JOGLOOP
JG SPEEDX
JP #JOGLOOP
EN
#COMINT
CI,0
JP #A,P2CH="X"
JP #B,P2CH="S"
ZS1;CI,2;JP#JOGLOOP
#A;JS#NUM
SPEEDX=VAL
ZS1;CI,2;JP#PRINT
#B;ST;AMX;CI,-1
MG{P2}"THE END"
ZS;EN,1
#NUM
MG{P2}"ENTER",P2CH{S},"AXIS SPEED"{N}
#NUMLOOP;CI,-1
#NMLP
JP #NMLP,P2CD<2
JP #ERROR,P2CD=2
VAL=P2NM
EN
#ERROR;CI,-1
MG{P2}"INVALID-TRY AGAIN"
JP #NMLP
EN"""


def test_the_jog_program_of_the_manual() -> None:  # l.3586-3636, {P2} in #NUM and #ERROR as was surely meant
    operator = Operator("dmc1412", JOG)
    assert operator.rows == ["TO CHANGE SPEEDS", "TYPE X", "TYPE S TO STOP", ""]
    operator.wait(300)
    assert operator.speed() == pytest.approx(10000, abs=20)
    operator.type("X")
    operator.wait(30)
    assert operator.rows[-1] == "ENTERXAXIS SPEED"
    operator.type("FAST")
    operator.press("ENTER")
    operator.wait(30)
    assert "INVALID-TRY AGAIN" in "".join(operator.rows)
    operator.type("4000")
    operator.press("ENTER")
    operator.wait(400)
    assert operator.variable("SPEEDX") == 4000
    assert operator.speed() == pytest.approx(4000, abs=20)
    operator.type("S")
    operator.wait(400)
    assert operator.rows[-2] == "THE END"
    assert not operator.simulation.unit.running() and not operator.simulation.unit.moving()


def test_status_codes_of_port_2() -> None:  # l.3541-3546
    operator = Operator("dmc1412", "#A\nS=P2CD\nJP#A")
    assert operator.variable("S") == 0
    operator.type("1")
    operator.wait(5)
    assert operator.variable("S") == 1
    operator.press("ENTER")
    assert operator.variable("S") == 3
    operator.type("AB")
    operator.press("ENTER")
    assert operator.variable("S") == 2
    operator.simulation.receive(1, b"CC 9600,0,1,0\r")
    operator.wait(20)
    assert operator.variable("S") == -1


def test_the_cursor_command_of_the_manual() -> None:  # l.5276
    operator = Operator("dmc1412", '#A\nMG{P2},{^27},"Y",{^32},{^63},{N}\nMG{P2}"E"{N}\nEN')
    assert operator.rows[0] == " " * 19 + "E"


def test_the_terminal_answers_its_name_to_a_program() -> None:
    program = '#A\nMG{P2}{^27},"Z"{N}\nWT 50\nC=P2CH\nMG C{S1}\nEN'
    operator = Operator("dmc1412", program)
    operator.wait(100)
    assert operator.simulation.messages[-1][2] == "0"  # the last character of TT11.0


def test_a_paced_port_2_takes_its_time() -> None:
    operator = Operator("dmc1412", '#A\nCC 1200,0,0,0\nWT 20\nMG{P2}"12345678901234567890"\nEN', baud=9600)
    # 22 characters at 1200 baud take 183 ms
    assert operator.rows[0] != "12345678901234567890"
    operator.wait(160)
    assert operator.rows[0] == "12345678901234567890"
