"""The TERM-1500 operator terminal: what it shows for the characters it gets, and what its keys send.

Facts: dmc-1412-1414.txt l.5161-5408. Not stated there, so decided here: a line feed on the last row scrolls; a full
line goes on in the next row with the next character; BKSPC sends 8 and ENTER 13; left and right of 0 are minus and dot
(the printed maps show the minus of the panel only, but numbers are entered with these keys).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

ROWS, COLUMNS = 4, 20
ESCAPE, BACKSPACE, LINE_FEED, RETURN = 0x1B, 0x08, 0x0A, 0x0D
FIRST_PLACE: Final = 0x20  # row 1 and column 1 of ESC Y
IDENTITY: Final = b"TT1"  # then the firmware version
SOUNDS: Final = {"T": "short bell", "L": "long bell", "P": "click", "O": "alert"}
STYLES: Final = {
    "F": ("underscore", True),
    "G": ("underscore", False),
    "R": ("blinking", True),
    "S": ("blinking", False),
    "U": ("key_click", True),
    "V": ("key_click", False),
}
MOVES: Final = {"A": (-1, 0), "B": (1, 0), "C": (0, 1), "D": (0, -1)}
CONTROL, SHIFT = "CTRL", "SHIFT"


@dataclass(frozen=True, slots=True)
class Key:
    """One key: its name, and the code it sends alone, with SHIFT and with CTRL (0: none)."""

    name: str
    alone: int = 0
    shifted: int = 0
    controlled: int = 0


def _row(plain: tuple[str | int, ...], shifted: tuple[str | int, ...], controlled: tuple[str | int, ...]) -> list[Key]:
    """A row of keys as the maps print it; a number is a code, a blank nothing."""
    return [
        Key(_name(own, upper), _code(own), _code(upper), _code(lower))
        for own, upper, lower in zip(plain, shifted, controlled, strict=True)
    ]


def _name(own: str | int, upper: str | int) -> str:
    if isinstance(own, int):
        return {0x20: "SPACE", BACKSPACE: "BKSPC", RETURN: "ENTER"}.get(own) or f"F{own - 21}"
    return own or str(upper)


def _code(entry: str | int) -> int:
    if isinstance(entry, int):
        return entry
    return ord(entry) if len(entry) == 1 else 0


_BOTTOM: Final = (
    (CONTROL, SHIFT, 0x20, BACKSPACE, RETURN),
    (CONTROL, SHIFT, "Z", ",", "?"),
    (CONTROL, SHIFT, ESCAPE, "=", "#"),
)
HAND_HELD: Final[tuple[tuple[Key, ...], ...]] = tuple(  # 6 rows of 5, the upper row first
    tuple(_row(*row))
    for row in (
        ((22, 23, 24, 25, 26), ("A", "B", "C", "D", "E"), (18, 16, 9, 4, 17)),
        (("", "1", "2", "3", ""), ("F", "G", "H", "I", "J"), (19, 2, "!", '"', "%")),
        (("", "4", "5", "6", ""), ("K", "L", "M", "N", "O"), ("*", "+", "/", "$", ";")),
        (("", "7", "8", "9", ""), ("P", "Q", "R", "S", "T"), ("<", ">", "\\", "[", "]")),
        (("", "-", "0", ".", ""), ("U", "V", "W", "X", "Y"), ("^", "-", "@", "{", "}")),
        _BOTTOM,
    )
)
PANEL: Final[tuple[tuple[Key, ...], ...]] = tuple(  # 5 rows of 6, the upper row first
    tuple(_row(*row))
    for row in (
        ((22, "", "1", "2", "3", ""), ("A", "F", "G", "H", "I", "J"), (18, 19, 2, "!", '"', "%")),
        ((23, "", "4", "5", "6", ""), ("B", "K", "L", "M", "N", "O"), (16, "*", "+", "/", "$", ";")),
        ((24, "", "7", "8", "9", ""), ("C", "P", "Q", "R", "S", "T"), (9, "<", ">", "\\", "[", "]")),
        ((25, "", "-", "0", ".", ""), ("D", "U", "V", "W", "X", "Y"), (4, "^", "-", "@", "{", "}")),
        tuple((first, *rest) for first, rest in zip((26, "E", 17), _BOTTOM, strict=True)),
    )
)


@dataclass(frozen=True, slots=True)
class Settings:
    """As the terminal is configured by CTRL-SHIFT-F1; the defaults are those recommended (l.5318)."""

    baud: int = 9600
    data_bits: int = 7
    parity: str = "space"
    display_parity_errors: bool = True
    repeat: str = "fast"
    echo: bool = False
    handshake: bool = False
    self_test: bool = False


@dataclass(slots=True)
class Terminal:
    """One terminal: give it what port 2 sends, send what `press` answers and what `answers` holds."""

    keys: tuple[tuple[Key, ...], ...] = HAND_HELD
    version: str = "1.0"
    settings: Settings = field(default_factory=Settings)
    row: int = 0
    column: int = 0
    underscore: bool = True
    blinking: bool = False
    key_click: bool = True
    configuring: bool = False  # CTRL-SHIFT-F1 was pressed
    parity_errors: int = 0  # characters with bit 7 set, as CW1 sends them
    sounds: deque[str] = field(default_factory=lambda: deque(maxlen=16))
    answers: bytearray = field(default_factory=bytearray)
    _cells: list[list[str]] = field(default_factory=lambda: [[" "] * COLUMNS for _ in range(ROWS)])
    _full: bool = False  # the last column has been written, the next character goes to the next row
    _escape: str = ""  # an escape command so far

    # ---------------------------------------------------------------- display

    @property
    def lines(self) -> tuple[str, ...]:
        """The four rows, 20 characters each."""
        return tuple("".join(cells) for cells in self._cells)

    def receive(self, data: bytes) -> None:
        """Characters from the controller."""
        for byte in data:
            if byte & 0x80:
                self.parity_errors += 1
            self._take(byte & 0x7F)

    def _take(self, code: int) -> None:
        if self._escape:
            self._escaped(chr(code))
        elif code == ESCAPE:
            self._escape = chr(ESCAPE)
        elif code == RETURN:
            self._go(self.row, 0)
        elif code == LINE_FEED:
            self._next_row()
        elif code == BACKSPACE:
            self._go(self.row, self.column - 1)
        elif code == 0x07:
            self.sounds.append(SOUNDS["T"])
        elif 0x20 <= code < 0x7F:
            self._write(chr(code))

    def _write(self, character: str) -> None:
        if self._full:
            self.column = 0
            self._next_row()
        self._cells[self.row][self.column] = character
        self._full = self.column == COLUMNS - 1
        self.column = min(self.column + 1, COLUMNS - 1)

    def _next_row(self) -> None:
        self._full = False
        if self.row < ROWS - 1:
            self.row += 1
        else:
            self._cells = [*self._cells[1:], [" "] * COLUMNS]

    def _go(self, row: int, column: int) -> None:
        """Moves the cursor, at most to the edge."""
        self.row, self.column = min(max(row, 0), ROWS - 1), min(max(column, 0), COLUMNS - 1)
        self._full = False

    # ---------------------------------------------------------------- escapes

    def _escaped(self, character: str) -> None:
        command = self._escape[1:] + character
        if command[0] == "Y" and len(command) < 3:
            self._escape += character
            return
        self._escape = ""
        letter = command[0]
        if letter == "Y":  # codes beyond the edge, as the 3F the manual prints for column 20, mean the edge
            self._go(ord(command[1]) - FIRST_PLACE, ord(command[2]) - FIRST_PLACE)
        elif letter in MOVES:
            rows, columns = MOVES[letter]
            self._go(self.row + rows, self.column + columns)
        elif letter in SOUNDS:
            self.sounds.append(SOUNDS[letter])
        elif letter in STYLES:
            name, on = STYLES[letter]
            setattr(self, name, on)
        elif letter == "Z":
            self.answers += IDENTITY + self.version.encode("ascii")
        else:
            self._erase(letter)

    def _erase(self, letter: str) -> None:
        """E and I the display, J and K from the cursor on, M the line; H only goes home."""
        row, column = self.row, self.column
        if letter in "EI":
            self._blank(range(ROWS), 0)
        elif letter == "J":
            self._blank(range(row + 1, ROWS), 0)
        if letter in "JK":
            self._blank(range(row, row + 1), column)
        elif letter == "M":
            self._blank(range(row, row + 1), 0)
        if letter in "EH":
            self._go(0, 0)

    def _blank(self, rows: range, first: int) -> None:
        for row in rows:
            self._cells[row][first:] = [" "] * (COLUMNS - first)

    # ------------------------------------------------------------------- keys

    @property
    def by_name(self) -> Mapping[str, Key]:
        """The keys by the name on their cap; the first where two have none."""
        found: dict[str, Key] = {}
        for row in self.keys:
            for key in row:
                found.setdefault(key.name, key)
        return found

    def press(self, key: Key | str, *, shift: bool = False, control: bool = False) -> bytes:
        """What a key sends (bit 7 is clear: space parity); CTRL-SHIFT-F1 opens the configuration instead."""
        pressed = self.by_name[key] if isinstance(key, str) else key
        if shift and control:
            self.configuring |= pressed.name == "F1"
            return b""
        code = pressed.shifted if shift else pressed.controlled if control else pressed.alone
        if not code:
            return b""
        if self.key_click:
            self.sounds.append(SOUNDS["P"])
        if self.settings.echo:
            self._take(code)
        return bytes((code,))

    def type(self, text: str) -> bytes:
        """The characters of a text by their keys; a KeyError names one that no key has."""
        codes: dict[int, bytes] = {}
        for row in self.keys:
            for key in row:
                for code in (key.alone, key.shifted, key.controlled):
                    codes[code] = bytes((code,))
        return b"".join(codes[ord(character)] for character in text)
