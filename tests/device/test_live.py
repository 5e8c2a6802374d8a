"""Live values: right under any number format, never more than the line's share, stale when old."""

from __future__ import annotations

import itertools
import math
import re

import numpy as np
import pytest

from codegen.models import MODELS, model
from device import live
from device.poll import SHARE, requests
from device.ring import Ring
from device.wire import framed
from tests.device.bench import Bench
from tests.long import count, record


@pytest.mark.parametrize("name", ["ssc1", "ssc4", "dmc1412", "dmc1414"])
def test_every_live_value_can_be_read(name: str) -> None:
    bench = Bench(name).ready()
    bench.controller.watch("all", bench.controller.columns)
    bench.run(12.0)
    row = bench.controller.last()
    assert [key for key in bench.controller.columns if math.isnan(row.value(key))] == []


FORMATS = ["PF 10.0", "PF 5.2", "PF -4", "VF 1.0", "VF -8.4", "LZ 1", "LZ 0", "EO 1", "CW 1", "CW 2"]


@pytest.mark.parametrize("settings", FORMATS)
def test_values_are_the_same_under_any_format(settings: str) -> None:
    bench = Bench("ssc4").ready()
    bench.controller.watch("a", ["position.x", "position.y", "inputs", "torque.x"])
    bench.ask("DP -1234567,89")
    bench.ask(settings)
    bench.run(2.0)
    row = bench.controller.last()
    assert (row.value("position.x"), row.value("position.y"), row.value("inputs")) == (-1234567, 89, 255)
    assert not row.stale("position.x", bench.controller.clock())
    assert [notice for notice in bench.controller.notices() if notice.kind == "message"] == []


def test_reading_never_clears_the_error_code() -> None:
    bench = Bench("ssc4").ready()
    bench.controller.watch("all", bench.controller.columns)
    assert not bench.result(bench.controller.ask("SP 99999999")).accepted
    bench.run(5.0)
    assert bench.ask("TC").strip() == "006"


READ = re.compile(
    r'MG\{\^30\},"[a-z0-9]{2}"(,[_A-Z0-9@\[\]]+\{F\d+\.\d\})+,\{\^31\}'
)  # a format of its own behind each


def test_live_values_are_read_with_a_format_of_their_own_and_nothing_else() -> None:
    """safety.md, 3: never TP or `?` in the user's PF, never TC."""
    bench = Bench("ssc4").ready()
    bench.controller.watch("all", bench.controller.columns)
    before = len(bench.sent)
    bench.run(5.0)
    lines = bytes(bench.sent[before:]).decode("ascii").split("\r")[1:-1]
    assert len(lines) > 30
    assert [line for line in lines if READ.fullmatch(line) is None] == []


def test_nothing_the_user_set_is_otherwise_after_a_session() -> None:
    """safety.md, 3: what the link changes it sets back; it changes no format, echo or mark at all."""
    bench = Bench("ssc4").ready()
    settings = bench.simulation.unit.state.settings
    for command in ("PF 5.2", "VF -8.4", "LZ 0", "CW 1", "EO 1"):
        bench.ask(command)
    before = dict(settings)
    bench.controller.watch("all", bench.controller.columns)
    bench.run(2.0)
    assert bench.result(bench.controller.download("#A\nPR 5\nEN").future).verified
    assert bench.result(bench.controller.burn_program()).accepted
    assert not bench.result(bench.controller.ask("QQ 5")).accepted
    bench.controller.stop()
    bench.run(1.0)
    bench.controller.close()
    assert dict(settings) == before


TURNING = "#A\nN=0\n#B\nN=N+1\nJP #B"


def travelled(bench: Bench, seconds: float) -> tuple[float, float]:
    """Shares of the time in which characters went out and came back."""
    came = 0
    transmit = bench.simulation.transmit

    def counted(port: int) -> bytes:
        nonlocal came
        data: bytes = transmit(port)
        came += len(data)
        return data

    bench.simulation.transmit = counted
    bench.sent.clear()
    bench.run(seconds)
    bench.simulation.transmit = transmit
    whole = seconds / bench.controller.line.byte_s
    return len(bench.sent) / whole, came / whole


def running(bench: Bench) -> Bench:
    bench.result(bench.controller.download(TURNING).future)
    assert bench.result(bench.controller.execute("A", anyway=True)).accepted
    bench.controller.watch("all", bench.controller.columns)
    bench.run(1.0)
    return bench


@pytest.mark.parametrize("baud", [9600, 19200, 38400])
def test_beside_a_program_reading_takes_less_than_its_share_of_the_line(baud: int) -> None:
    out, back = travelled(running(Bench("ssc4", baud=baud).ready()), 10.0)
    assert 0.5 * SHARE <= max(out, back) <= SHARE + 0.02


@pytest.mark.parametrize("baud", [9600, 19200, 38400])
def test_while_nothing_runs_reading_takes_most_of_the_line(baud: int) -> None:
    """A start is noticed at once: the first second of a program is read at its own pace already."""
    bench = Bench("ssc4", baud=baud).ready()
    bench.controller.watch("all", bench.controller.columns)
    bench.run(1.0)
    assert 0.6 <= sum(travelled(bench, 5.0)) <= 0.82
    bench.result(bench.controller.download(TURNING).future)
    assert bench.result(bench.controller.execute("A", anyway=True)).accepted
    assert max(travelled(bench, 1.0)) <= SHARE + 0.06


@pytest.mark.parametrize("baud", [9600, 19200, 38400])
def test_all_of_the_line_where_it_is_asked_for(baud: int) -> None:
    bench = running(Bench("ssc4", baud=baud).ready())
    bench.controller.hurry(True)
    used = sum(travelled(bench, count(5, 20)))
    record(f"share of the line at {baud} when asked to hurry", "pytest tests/device/test_live.py", None, used, "of 1")
    print(f"{baud} baud: {100 * used:.1f} % of the line")
    assert used >= 0.9
    assert bench.controller.line_share == pytest.approx(used, abs=0.06)
    bench.controller.hurry(False)
    bench.run(1.0)
    assert max(travelled(bench, 5.0)) <= SHARE + 0.02


def test_two_axes_are_seen_move_while_nothing_runs() -> None:
    """What a picture of two axes needs at 19 200 baud."""
    bench = Bench("ssc2").ready()
    bench.controller.watch("picture", [*live_keys("position", "commanded", "moving"), "inputs", "outputs"])
    bench.run(3.0)
    assert bench.controller.rate_hz >= 9.0
    print(f"{bench.controller.rate_hz:.1f} readings/s")


@pytest.mark.parametrize(("name", "baud"), [("ssc1", 9600), ("ssc2", 9600), ("ssc4", 9600), ("ssc4", 38400)])
def test_the_error_is_the_difference_of_the_places_that_stand_beside_it(name: str, baud: int) -> None:
    """“The position error, which is the difference between the commanded position and the actual position”
    (dmc-1412-1414.txt l.932), also while an axis moves and the line is slow: all three are of one exchange."""
    bench = Bench(name, baud=baud).ready()
    axes = bench.controller.axes.lower()
    shown = [f"{each}.{axis}" for axis in axes for each in ("position", "at", "commanded", "error", "velocity")]
    bench.controller.watch("display", [*shown, "inputs", "outputs"])
    for command in ("SH", "JG 20000", "BG X"):
        bench.ask(command)
    bench.run(8.0)
    places = set()
    for _ in range(count(2000, 20000)):
        bench.step()
        row = bench.controller.last()
        for axis in axes:
            position, commanded, error = (row.value(f"{each}.{axis}") for each in ("at", "commanded", "error"))
            assert error == commanded - position, axis
            assert row.time(f"at.{axis}") == row.time(f"commanded.{axis}") == row.time(f"error.{axis}")
            places.add(position)
    assert len(places) > 3 and max(places) > 20_000


def live_keys(*names: str) -> list[str]:
    return [live.key(name, axis) for name in names for axis in "XY"]


def test_closing_a_panel_lowers_traffic_and_its_values_become_unknown() -> None:
    bench = Bench("ssc4").ready()
    controller = bench.controller
    controller.watch("one", ["position.x"])
    controller.watch("two", ["inputs"])
    bench.run(1.0)
    controller.watch("two", ())
    bench.run(1.0)
    row = controller.last()
    assert math.isnan(row.value("inputs"))
    assert row.value("position.x") == 0
    assert controller.rate_hz > 0


def test_where_things_move_is_read_more_often_than_what_rarely_changes() -> None:
    """With everything watched: position and moving in every round, all others within a bounded time, none forgotten."""
    bench = Bench("ssc4").ready()
    controller = bench.controller
    controller.watch("all", controller.columns)
    bench.run(15.0)
    times: dict[str, set[float]] = {key: set() for key in controller.columns}
    for _ in range(400):
        bench.run(0.05)
        row = controller.last()
        for key in controller.columns:
            times[key].add(row.time(key))
            assert not row.stale(key, controller.clock()), key
    quick = min(len(times[key]) for key in ("position.x", "position.w", "moving.x", "moving.w"))
    often = ("position", "moving", "inputs", "thread", "time")
    others = [len(found) for key, found in times.items() if not key.startswith(often)]
    assert quick > 3 * max(others)
    assert min(others) >= 4  # in 20 s
    assert controller.rate_hz > 1.5  # 4 axes at 19 200 baud, 30 % of the line


@pytest.mark.parametrize("baud", [9600, 19200, 38400])
def test_a_program_runs_hardly_slower_while_it_is_watched(baud: int) -> None:
    """Its cycle time with everything read is at most 5 % longer than without (safety.md, 3)."""
    turns: list[float] = []
    for watched in (False, True):
        bench = Bench("ssc4", baud=baud).ready()
        bench.result(bench.controller.download("#A\nN=0\n#B\nN=N+1\nJP #B").future)
        if watched:
            bench.controller.watch("all", bench.controller.columns)
        bench.result(bench.controller.execute("A", anyway=True))
        start, before = bench.loopback.clock(), bench.simulation.state()["variables"]["N"]
        bench.run(count(2, 10))
        turns.append((bench.simulation.state()["variables"]["N"] - before) / (bench.loopback.clock() - start))
    longer = 100 * (turns[0] / turns[1] - 1)
    record(f"cycle of a watched program at {baud}, longer by", "pytest tests/device/test_live.py", None, longer, "%")
    print(f"{baud} baud: a cycle is longer by {longer:.2f} %")
    assert longer <= 5.0


@pytest.mark.parametrize("name", [name for name in MODELS if name != "smartmotor"])
def test_requests_fit_the_controllers_lines_and_hold_every_key_once(name: str) -> None:
    found = model(name)
    keys = live.columns(found)
    lines = requests(keys, found.columns)
    assert sorted(key for line in lines for key, _, _ in line) == sorted(keys)
    for line in lines:
        reads = dict.fromkeys((expression, shape) for _, expression, shape in line)  # two keys may share one
        assert len(framed("xx", list(reads))) <= found.columns


def test_rows_keep_what_was_read_with_its_own_time() -> None:
    ring = Ring(("a", "b"), size=8)
    assert math.isnan(ring.last().value("a"))
    ring.write({"a": 1.0}, 10.0)
    ring.write({"b": 2.0}, 11.0)
    row = ring.last()
    assert (row.value("a"), row.time("a"), row.value("b"), row.time("b")) == (1.0, 10.0, 2.0, 11.0)
    assert math.isnan(row.value("unknown"))
    ring.write({"b": 3.0}, 12.0, keep=["b"])
    assert math.isnan(ring.last().value("a"))


def test_old_values_are_stale() -> None:
    ring = Ring(("a",))
    ring.period_s = 0.1
    ring.write({"a": 1.0}, 10.0)
    assert not ring.last().stale("a", 10.5)
    assert ring.last().stale("a", 11.0)
    assert ring.last().stale("b", 10.0)


def test_the_tail_goes_round() -> None:
    ring = Ring(("a",), size=5)
    for number in range(12):
        ring.write({"a": float(number)}, float(number))
    assert np.array_equal(ring.tail(3)[:, 0], [9.0, 10.0, 11.0])
    assert np.array_equal(ring.tail_times(2)[:, 0], [10.0, 11.0])
    assert len(ring.tail(100)) == 4


def test_every_row_of_the_table_is_complete() -> None:
    for row, other in itertools.combinations(live.ROWS, 2):
        assert row.name != other.name
    for row in live.ROWS:
        assert row.label and row.dimension and row.expression
        assert ("{axis}" in row.expression) == row.per_axis
