"""Play-back of taught rows: row by row, stopped by everything, the same ends as the program that is made of it."""

from __future__ import annotations

import dataclasses as dc
import math
from concurrent.futures import Future
from functools import partial
from itertools import pairwise
from typing import Any

import pytest

from codegen.setup import Setup, Unit
from codegen.teach import Row, Table, counts_of
from device.api import LinkError, NotAllowed, Places
from device.setup_transfer import burn_setup
from device.teach import Action, Move, PlayBack, Played, approach, passes
from device.teach_actions import actions_of, ends_of
from device.teach_time import seconds_of
from tests.device.bench import Bench
from tests.long import record

AXIS = dc.replace(Setup().axes[0], unit=Unit.MM, counts_per_unit="1000", reverse_limit="-50", forward_limit="200")
SETUP = Setup(model="ssc2", axes=(AXIS,) * 4)
PACE = Row(speed="50", acceleration="1024", deceleration="1024")
SLOW = ({"X": 20_000, "Y": 20_000}, {"X": 1_024_000, "Y": 1_024_000})


def place(x: str, y: str, **more: str) -> Row:
    return dc.replace(PACE, x=x, y=y, **more)


ROWS = (
    Row(output="0x0F"),
    place("2", "1", output="-2"),
    place("4", "3", wait="3"),
    place("6", "3", sweep="-180", through="on"),
    place("7.5", "3.25", pause="200"),
    Row(wait="-3", output="8"),
    place("0", "0"),
)


class Playing:
    """A table on its way."""

    def __init__(self, rows: tuple[Row, ...] = ROWS, step: bool = False, **more: Any) -> None:
        table = Table(("mm", "mm"), rows)
        self.bench = Bench("ssc2").ready()
        self.bench.ask("SH")
        first = next(row for row in rows if row.moves)
        actions = actions_of(table, SETUP, approach(counts_of(first, SETUP), *SLOW))
        self.play, future = self.bench.controller.motion.undertake(partial(PlayBack.of, actions, "teach", step, **more))
        self.future: Future[Played] = future

    def until_row(self, row: int) -> Playing:
        self.bench.run_until(lambda: self.play.row == row)
        return self

    @property
    def places(self) -> tuple[int, int]:
        axes = self.bench.simulation.state()["axes"]
        return axes["X"]["commanded"], axes["Y"]["commanded"]

    @property
    def outputs(self) -> int:
        return int(self.bench.simulation.unit.state.outputs)


def test_rows_move_wait_switch_and_pause_in_their_order() -> None:
    playing = Playing().until_row(2)
    assert playing.outputs & 0x0F == 0x0D  # all four on, then 2 off
    playing.bench.simulation.stimulus("in3", 0)
    playing.bench.run(1.5)
    assert playing.play.doing == "Row 3 waits until input 3 is high." and playing.places == (4000, 3000)
    playing.bench.simulation.stimulus("in3", 1)
    playing.until_row(4)
    playing.bench.run_until(lambda: playing.play.doing == "Row 5 pauses 0.2 s.")
    began = playing.bench.loopback.clock()
    playing.bench.run_until(lambda: playing.play.row == 5)
    assert 0.2 <= playing.bench.loopback.clock() - began < 0.3
    assert playing.places == (7500, 3250)
    playing.bench.run(0.5)
    assert playing.play.doing == "Row 6 waits until input 3 is low."
    playing.bench.simulation.stimulus("in3", 0)
    played = playing.bench.result(playing.future)
    assert (played.finished, played.sentence, playing.places) == (True, "Played back.", (0, 0))
    assert playing.outputs == 0x8D
    for name, number in (("_SPX", 25000), ("_VS", 25000), ("_ACY", 256000)):  # as they were (l.5000 of the facts)
        assert float(playing.bench.ask(f"MG {name}")) == number


def test_step_by_step_holds_before_each_row() -> None:
    playing = Playing((place("1", "1"), place("2", "1"), place("2", "2")), step=True)
    for row, expected in enumerate([(0, 0), (1000, 1000), (2000, 1000)]):
        playing.bench.run_until(lambda: playing.play.holds)
        playing.bench.run(0.5)
        assert (playing.places, playing.play.doing) == (expected, f"Row {row + 1} is next.")
        playing.play.go_on()
        playing.bench.run(0.1)
    assert playing.bench.result(playing.future).finished and playing.places == (2000, 2000)


@pytest.mark.parametrize("how", ["let go", "stop", "watch", "cable", "switch", "another"])
def test_everything_that_stops_it_stops_all_of_it(how: str) -> None:
    playing = Playing((place("1", "1"), place("90", "80"), place("1", "1"))).until_row(1)
    playing.bench.run(0.8)
    assert not playing.bench.still()
    controller = playing.bench.controller
    if how == "let go":
        controller.motion.release("teach")
    elif how == "stop":
        controller.stop()
    elif how == "watch":
        controller.release_control()
    elif how == "cable":
        playing.bench.loopback.unplugged = True
    elif how == "switch":
        playing.bench.simulation.stimulus("fls_y", 0)
    else:
        playing.bench.raw(b"ST\r")
    playing.bench.run_until(playing.future.done, 30)
    playing.bench.run(1.0)
    if how == "cable":  # nothing can be sent: the row in hand comes to its own end, and no other follows
        playing.bench.run(5.0)
        assert playing.places == (90_000, 80_000)
    assert playing.bench.still()
    error = playing.future.exception()
    if how in ("let go", "watch"):
        assert error is None and not playing.future.result().finished
    else:
        assert isinstance(error, LinkError)
    if how == "switch":
        assert "row 2" in str(error) and "limit switch" in str(error)
    if how not in ("watch", "cable"):  # what runs next may brake by them
        read = controller.read("_SPX", "_ACX", "_DCY", "_VS", "_VD")
        assert playing.bench.result(read) == (25_000, 256_000, 256_000, 25_000, 256_000)


def test_what_a_play_back_needs_is_not_burned() -> None:
    """Nothing moves while it waits for an input, and BN would be taken: with the speeds of the approach."""
    playing = Playing((place("2", "1", wait="-3"), place("4", "3")))
    bench = playing.bench
    bench.run_until(lambda: playing.play.doing.startswith("Row 1 waits"))
    assert bench.still()
    for future in (bench.controller.ask("BN"), burn_setup(bench.controller)):
        with pytest.raises(NotAllowed, match="Not burned: Play-back is under way; its speeds would be kept"):
            bench.result(future)
    bench.controller.motion.release("teach")
    bench.run_until(playing.future.done)
    assert bench.result(bench.controller.ask("BN")).accepted


def test_outputs_are_switched_only_while_io_control_is_on() -> None:
    rows = (place("1", "1"), Row(output="3"), Row(pause="300"), Row(output="4"), place("5", "5"))
    allowed = [True]
    playing = Playing(rows, switches=lambda: allowed[0]).until_row(2)
    allowed[0] = False
    playing.bench.run_until(playing.future.done)
    with pytest.raises(NotAllowed, match="row 4: I/O control was switched off meanwhile"):
        playing.future.result()
    assert playing.outputs == 0b0100 and playing.places == (1000, 1000)


def test_it_is_refused_in_watch_with_a_motor_off_and_while_another_hand_holds() -> None:
    playing = Playing((place("1", "1"), place("2", "1")))
    with pytest.raises(NotAllowed, match="moved by hand already"):
        playing.bench.result(playing.bench.controller.motion.hold("X", 1e4, 1e6, 1e6, "mouse"))
    playing.bench.result(playing.future)
    motion = playing.bench.controller.motion
    make = partial(PlayBack.of, (Action(0, Move(("VM XY",), (0, 0))),), "teach", False)
    playing.bench.ask("MO")
    with pytest.raises(NotAllowed, match="motor of axis X is off"):
        playing.bench.result(motion.undertake(make)[1])
    playing.bench.controller.release_control()
    with pytest.raises(NotAllowed, match="Watch"):
        playing.bench.result(motion.undertake(make)[1])


def test_a_row_beyond_a_limit_is_named() -> None:
    ends = ends_of(Table(("mm", "mm"), (Row(wait="1"), place("1", "2"), place("150", "-20"))), SETUP)
    places = Places({"X": 0, "Y": 0}, {"X": 200_000, "Y": 200_000}, {"X": -50_000, "Y": -10_000})
    assert passes(ends, places, SETUP) == "Row 3: -20 mm lies beyond the reverse limit of Y, -10 mm."
    assert passes(ends[:1], places, SETUP) == ""


@pytest.mark.parametrize("count", ["1000", "500"])
def test_an_arc_that_swings_beyond_a_limit_of_the_controller_is_named(count: str) -> None:
    """Half a circle from (20, 0) to (20, 20) counter-clockwise has its middle at (20, 10), so it comes to X 30."""
    axes = (AXIS, dc.replace(AXIS, counts_per_unit=count), AXIS, AXIS)
    setup = dc.replace(SETUP, axes=axes)
    ends = ends_of(Table(("mm", "mm"), (place("20", "0"), place("20", "20", sweep="180"), place("0", "0"))), setup)
    far = {"X": 200_000, "Y": 200_000}
    assert passes(ends, Places({"X": 0, "Y": 0}, {**far, "X": 30_001}, {"X": -1, "Y": -1}), setup) == ""
    words = "Row 2: 30 mm lies beyond the forward limit of X, 29 mm."
    assert passes(ends, Places({"X": 0, "Y": 0}, {**far, "X": 29_000}, {"X": -1, "Y": -1}), setup) == words


def trapezoid_s(counts: float, speed: float = 50_000, ramp: float = 1_024_000) -> float:
    """How long a line lasts: to its speed and back (speed²/ramp counts), or half way up and down again."""
    if counts >= speed**2 / ramp:
        return counts / speed + speed / ramp
    return 2 * math.sqrt(counts / ramp)


def test_rows_that_only_move_follow_each_other_with_one_exchange() -> None:
    """At 19 200 baud: a digit back and the next move's 48 characters are 30 ms; live values do not come between."""
    rows = tuple(place(f"{1 + n % 5}", f"{n * 7 % 4}") for n in range(12))
    playing = Playing(rows)
    playing.bench.controller.watch("panel", [f"{name}.{axis}" for name in ("position", "error") for axis in "xy"])
    playing.until_row(1)
    began = playing.bench.loopback.clock()
    assert playing.bench.result(playing.future).finished
    took = playing.bench.loopback.clock() - began
    ways = [(1000 * math.dist(*((float(row.x), float(row.y)) for row in pair)), pair) for pair in pairwise(rows)]
    each = (took - sum(trapezoid_s(counts) for counts, _ in ways)) / len(ways)
    record(
        "teach: from one row that moves to the next, 19 200 baud", "pytest tests/device/test_teach.py", None, each, "s"
    )
    assert 0 < each < 0.07
    sent = [line.text for line in playing.bench.controller.traffic() if line.direction == ">" and "BG S" in line.text]
    assert len(sent) == len(ways)


def test_how_long_a_move_lasts_is_told_by_its_commands() -> None:
    """Lines from the start of the path, half a circle of 1000 counts, another speed on the way, half the ratio."""
    pace = ("VS 50000", "VA 1024000", "VD 1024000")
    assert seconds_of((*pace, "VP 3000,4000", "VE", "BG S")) == pytest.approx(trapezoid_s(5000))
    assert seconds_of((*pace, "LI 300,-400", "LE")) == pytest.approx(trapezoid_s(500))
    bow = seconds_of((*pace, "VP 10000,0", "CR 1000,180,-180", "VP 12000,5000", "VE"))
    assert bow == pytest.approx(trapezoid_s(10_000 + 1000 * math.pi + 5000))
    two = seconds_of((*pace, "LI 50000", "LI 50000<25000", "LE"))
    assert two == pytest.approx(1 + 2 + 50_000 / 2_048_000 + 25_000 / 2_048_000)
    assert seconds_of((*pace, "LI 50000", "LE"), 0.5) == pytest.approx(trapezoid_s(50_000, 25_000))
    assert seconds_of(("PA 5", "BG X")) == 0
