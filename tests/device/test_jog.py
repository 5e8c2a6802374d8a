"""Planned moves by hand: what they say before the start, what they do, what they leave behind (safety.md, 4)."""

from __future__ import annotations

import math
from concurrent.futures import Future

import pytest

from codegen.fields import Dimension
from codegen.numbers import parse_number
from codegen.setup import Axis, Setup, Unit
from device.api import Ended, Kind, LinkError, NeedsConfirmation, NotAllowed, Places, Routine, StopState, jog
from device.jog import axes_driven
from device.simulator.plant_file import load_plants
from tests.device.bench import Bench

RAMP = 256_000


def bench_on(name: str = "ssc4", *commands: str, **more: object) -> Bench:
    bench = Bench(name, **more).ready()  # type: ignore[arg-type]
    for command in ("SH", *commands):
        bench.ask(command)
    return bench


def places(bench: Bench) -> dict[str, int]:
    return {letter: axis["commanded"] for letter, axis in bench.simulation.state()["axes"].items()}


def go(bench: Bench, plan: jog.Plan, **more: object) -> Ended:
    future: Future[Ended] = bench.controller.motion.go(plan, **more)  # type: ignore[arg-type]
    return bench.result(future)


def test_one_increment() -> None:
    bench = bench_on()
    plan = jog.by("Y", -3000, 20_000, RAMP, RAMP)
    assert plan.ghost(bench.result(bench.controller.motion.look("Y"))) == {"Y": -3000}
    ended = go(bench, plan)
    assert ended.places == {"Y": -3000}
    assert ended.codes == {"Y": 1}  # stopped at the commanded position (dmc-1412-1414.txt, SC)
    assert places(bench) == {"X": 0, "Y": -3000, "Z": 0, "W": 0}
    assert bench.result(bench.controller.read("_SPY", "_ACY", "_DCY")) == (25_000, 256_000, 256_000)


def test_a_place_asks_for_homed() -> None:
    bench = bench_on("ssc2")
    with pytest.raises(NeedsConfirmation, match="X was not seen homed"):
        go(bench, jog.to("X", 5000, 20_000, RAMP, RAMP))
    assert places(bench)["X"] == 0
    assert go(bench, jog.to("X", 5000, 20_000, RAMP, RAMP), homed="X").places == {"X": 5000}
    assert go(bench, jog.to("X", -700, 20_000, RAMP, RAMP), confirmed=True).places == {"X": -700}


@pytest.mark.parametrize("cut", [False, True])
def test_speeds_that_cannot_be_put_back_are_told(cut: bool) -> None:
    """In Watch, and when the line is lost, nothing may be sent any more."""
    bench = Bench("ssc2", kind=Kind.MACHINE).ready()
    bench.controller.take_control()
    for command in ("SH", "SP 31000", "AC 512000"):
        bench.ask(command)
    future = bench.controller.motion.go(jog.by("X", 100_000, 20_000, RAMP, RAMP))
    bench.run_until(lambda: places(bench)["X"] > 1000)
    bench.controller.notices()
    if cut:
        bench.loopback.unplugged = True
    else:
        bench.controller.release_control()
    bench.controller.watch("test", ["position.x"])
    bench.run_until(lambda: not bench.controller.control)
    told = [notice.text for notice in bench.controller.notices()]
    before = "Before it: SP 31000; AC 512000; DC 256000."
    assert f"Move X by 100000 counts: let go, and its speeds and ramps stay in the controller. {before}" in told
    bench.loopback.unplugged = False
    bench.run_until(future.done)
    assert bench.result(bench.controller.read("_SPX")) == (20_000,)


@pytest.mark.parametrize(
    ("counts", "word"), [(12_000, "forward limit, 10000 counts"), (-600, "reverse limit, -500 counts")]
)
def test_a_limit_is_said_before_the_start(counts: int, word: str) -> None:
    bench = bench_on("ssc2", "FL 10000;BL -500")
    with pytest.raises(NeedsConfirmation, match=word):
        go(bench, jog.by("X", counts, 20_000, RAMP, RAMP))
    assert places(bench)["X"] == 0


def test_the_limits_of_the_setup_count_too() -> None:
    axis = Axis(unit=Unit.MM, counts_per_unit="100", forward_limit="20", maximum_speed="150")
    setup = Setup(model="ssc2").with_axis("X", axis)
    bench = bench_on("ssc2", "FL 10000")
    bench.controller.motion.setup = setup
    with pytest.raises(NeedsConfirmation, match=r"would come to 20\.01 mm and passes its forward limit, 20 mm"):
        go(bench, jog.by("X", 2001, 10_000, RAMP, RAMP))
    assert go(bench, jog.by("X", 2000, 10_000, RAMP, RAMP)).places == {"X": 2000}
    number = parse_number("150")
    assert number is not None
    assert setup.counts(Dimension.SPEED, "X", number) == 15_000
    with pytest.raises(NotAllowed, match="top speed"):
        bench.result(bench.controller.motion.hold("X", 15_100, RAMP, RAMP))


def test_a_line_of_two_axes() -> None:
    bench = bench_on("ssc4", "VS 8000;VA 204800;VD 102400")
    ended = go(bench, jog.line({"X": 3000, "Z": -4000}, 10_000, RAMP, RAMP))
    assert ended.places == {"X": 3000, "Z": -4000}
    assert bench.result(bench.controller.read("_VS", "_VA", "_VD")) == (8000, 204_800, 102_400)


def test_an_arc_ends_and_swings_where_geometry_says() -> None:
    """A quarter from 0° to 90° goes back by the radius and up by it; 180° more passes the limit on its way."""
    plan = jog.arc("XY", 5000, 0, 90, 10_000, RAMP, RAMP)
    assert plan.ghost(Places({"X": 100, "Y": 0})) == {"X": -4900, "Y": 5000}
    bench = bench_on("ssc2", "FL ,4000")
    with pytest.raises(NeedsConfirmation, match="Axis Y would come to 5000 counts"):
        go(bench, jog.arc("XY", 5000, 0, 180, 10_000, RAMP, RAMP))
    ended = go(bench, jog.arc("XY", 2500, 0, 90, 10_000, RAMP, RAMP))
    assert ended.places == pytest.approx({"X": -2500, "Y": 2500}, abs=2)
    whole = jog.arc("XY", 1000, 30, 360, 10_000, RAMP, RAMP)
    assert whole.swing["X"] == (
        pytest.approx(-1000 - 1000 * math.cos(math.radians(30)), abs=1),
        pytest.approx(1000 - 1000 * math.cos(math.radians(30)), abs=1),
    )


@pytest.mark.parametrize(
    ("plan", "words"),
    [
        (jog.by("X", 100, 0, RAMP, RAMP), "speed is 0"),
        (jog.by("X", 100, 1000, 0, RAMP), "at least 1024"),
        (jog.line({"X": 100}, 1000, RAMP, RAMP), "two axes"),
        (jog.arc("XY", 0, 0, 90, 1000, RAMP, RAMP), "radius"),
        (jog.arc("XY", 9, 0, 90, 1000, RAMP, RAMP), "takes 10 to 6000000"),
        (jog.arc("XY", 6_000_001, 0, 1, 1000, RAMP, RAMP), "takes 10 to 6000000"),
        (jog.arc("XY", 1000, 0, 0.00004, 1000, RAMP, RAMP), "not 0"),
        (jog.arc("XY", 45_001, 0, -10_000, 1000, RAMP, RAMP), "too long"),
        (jog.arc("X", 10, 0, 90, 1000, RAMP, RAMP), "two axes"),
        (jog.by("W", 100, 1000, RAMP, RAMP), "no axis W"),
    ],
)
def test_what_can_not_be_moved_is_said(plan: jog.Plan, words: str) -> None:
    bench = bench_on("ssc2")
    with pytest.raises(NotAllowed, match=words):
        go(bench, plan)


def test_a_release_stops_it_and_another_hand_is_refused() -> None:
    bench = bench_on("ssc2")
    motion = bench.controller.motion
    future = motion.go(jog.by("X", 100_000, 20_000, RAMP, RAMP), owner="panel")
    bench.run(1.0)
    assert motion.busy == "Move X by 100000 counts"
    with pytest.raises(NotAllowed, match="by hand already"):
        bench.result(motion.go(jog.by("Y", 10, 1000, RAMP, RAMP), owner="gamepad"))
    motion.release("panel")
    ended = bench.result(future)
    assert ended.codes == {"X": 4}  # stopped by ST
    assert 0 < ended.places["X"] < 40_000
    assert bench.still()


def test_stop_ends_a_line() -> None:
    bench = bench_on("ssc2")
    bench.controller.motion.go(jog.line({"X": 100_000, "Y": 100_000}, 10_000, RAMP, RAMP))
    bench.run(1.0)
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED)
    assert bench.still()
    assert bench.controller.motion.busy == ""


@pytest.mark.parametrize("how", ["hold", "stick", "move"])
def test_after_stop_speeds_and_ramps_are_as_they_were(how: str) -> None:
    """What runs next, and the next ST, may brake by them: DC 20480 takes 12 times as long as DC 256000."""
    bench, weak = bench_on("ssc2"), 20_480
    motion, both = bench.controller.motion, {"X": weak, "Y": weak}
    future: Future[object] = {
        "hold": lambda: motion.hold("X", 2000, weak, weak, "hand"),
        "stick": lambda: motion.drive({"X": 2000, "Y": 1000}, both, both, "hand"),
        "move": lambda: motion.go(jog.by("X", 50_000, 2000, weak, weak)),
    }[how]()  # type: ignore[no-untyped-call]
    while not bench.simulation.state()["axes"]["X"]["moving"]:
        bench.run(0.02)
        motion.renew("hand")
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED)
    assert isinstance(future.exception(), LinkError) and not motion.busy
    bench.run(0.3)
    assert bench.controller.stop_state is StopState.STOPPED  # nothing was sent that moves
    values = bench.result(bench.controller.read("_SPX", "_ACX", "_DCX", "_SPY", "_ACY", "_DCY"))
    assert values == (25_000, 256_000, 256_000) * 2  # the factory's


def test_zero() -> None:
    bench = bench_on("ssc2")
    go(bench, jog.by("X", 1234, 20_000, RAMP, RAMP))
    assert go(bench, jog.zero("X")).places == {"X": 0}
    assert go(bench, jog.zero("XY", 50)).places == {"X": 50, "Y": 50}


@pytest.mark.parametrize(
    ("routine", "code", "place"),
    [(Routine.HOME, 10, 0), (Routine.EDGE, 9, None), (Routine.INDEX, 10, 0)],
)
def test_home(routine: Routine, code: int, place: int | None, tmp_path: object) -> None:
    """HM and FI end on the index and call it 0; FE stops behind the edge (dmc-1412-1414.txt l.1145-1151)."""
    from pathlib import Path

    assert isinstance(tmp_path, Path)
    file = tmp_path / "plant.toml"
    file.write_text("[axis.x]\nhome_switch = [-2000, -1000]\nindex_at = 137\ninertia = 2.0e-5\n")
    bench = Bench("ssc2", plants=load_plants(file)).ready()
    bench.ask("SH")
    ended = go(bench, jog.home("X", routine, 4000, RAMP, RAMP))
    assert ended.codes == {"X": code}
    if place is None:
        assert -1200 < ended.places["X"] < -900
    else:
        assert abs(ended.places["X"]) <= 40  # it decelerates behind the pulse


def test_watch_refuses_everything_by_hand() -> None:
    bench = Bench("ssc2", kind=Kind.MACHINE).ready()
    for plan in (jog.by("X", 1, 1000, RAMP, RAMP), jog.zero("X"), jog.home("X", Routine.HOME, 1000, RAMP, RAMP)):
        with pytest.raises(NotAllowed, match="Watch"):
            go(bench, plan)


def test_a_refused_line_is_said_and_everything_is_put_back() -> None:
    bench = Bench("ssc2").ready()
    bench.ask("MO")
    with pytest.raises(LinkError, match=r"not started: error 20, .*\. Switch the motor on \(SH\) first"):
        go(bench, jog.by("X", 100, 2000, RAMP, RAMP))
    assert bench.result(bench.controller.read("_SPX")) == (25_000,)


@pytest.mark.parametrize(
    ("program", "driven"),
    [
        ("#A\nPR 100\nBGX\nAM\nEN", "X"),
        ("PRY=5;BGY", "Y"),
        ("SP ,,5", "Z"),
        ("BG", "XYZW"),
        ("#A\nV=_TPX\nMG V\nSB1\nWT 10\nJP #A", ""),
        ("LM XZ\nLI 5,,6\nLE\nBGS", "XZ"),
        ("VM YW\nCR 5,0,90\nVE\nBGS", "YW"),
        ("ST;AB", ""),
        ("MO X", "X"),
        ("AMX;ADY=5", ""),
    ],
)
def test_which_axes_a_program_drives(program: str, driven: str) -> None:
    assert axes_driven(program, "XYZW") == frozenset(driven)
