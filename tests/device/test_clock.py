"""A power cycle or an exchange that nobody saw: TIME against the time that has passed (safety.md, 2)."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.models import model
from device.api import Badge, Kind, LinkError, NoticeKind, State
from device.clock import Clock, Reading, Verdict
from device.simulator.simulation import Simulation
from tests.device.bench import Bench

RATE = 1024.0  # samples a second at TM 1000 (dmc-1412-1414.txt, TIME)
LISTING = "#CUTTER\nPR 1000\nEN"


def judged(last: Reading, now: Reading) -> Verdict:
    clock = Clock()
    clock.keep(last)
    return clock.judge(now)


def at(samples: float, moment: float, period: float = 1000.0) -> Reading:
    return Reading(samples, period, moment, moment + 0.02)


@given(ran=st.floats(1.0, 1e6), out=st.floats(0.1, 1e5), share=st.floats(0.0, 1.0))
def test_a_power_cycle_is_seen_however_long_the_cable_was_out(ran: float, out: float, share: float) -> None:
    """It ran `ran` s, then the cable was out; power came back after a share of that time.

    It can be told where the clock shows less than it should by more than 0.3 s and 2 parts in 1000 of the time passed.
    """
    last, now = at(ran * RATE, 50.0), at((1 - share) * out * RATE, 50.02 + out)
    behind = ran + share * out
    if behind > 0.4 + 0.0021 * out:
        assert judged(last, now) is Verdict.RESTARTED


@given(
    ran=st.floats(0.0, 1e6), out=st.floats(0.0, 1e5), drift=st.floats(-2e-4, 2e-4), tm=st.sampled_from([250, 1000, 1e4])
)
def test_a_clock_that_ran_on_is_as_expected(ran: float, out: float, drift: float, tm: float) -> None:
    rate = 1_024_000 / tm
    last, now = at(ran * rate, 50.0, tm), at((ran + out * (1 + drift)) * rate, 50.0 + out, tm)
    assert judged(last, now) is Verdict.AS_EXPECTED


def test_a_clock_ahead_is_another_one() -> None:
    assert judged(at(100 * RATE, 0.0), at(500 * RATE, 10.0)) is Verdict.ANOTHER


def test_a_clock_that_turned_over_goes_on() -> None:
    """31 bits at 1024 a second: after 24 days."""
    assert judged(at(2**31 - 512, 0.0), at(512, 1.0)) is Verdict.AS_EXPECTED


def test_a_changed_sample_time_is_no_restart() -> None:
    """TM was changed at an unknown moment between: between 1024 and 2048 samples a second."""
    for samples in (10 * 1024, 15 * 1024, 20 * 1024):
        assert judged(at(5000, 0.0), at(5000 + samples, 10.0, 500.0)) is Verdict.AS_EXPECTED
    assert judged(at(50_000, 0.0), at(9000, 10.0, 500.0)) is Verdict.RESTARTED


def machine() -> Bench:
    """A machine that holds our verified program, under Control, its clock at some seconds."""
    bench = Bench("ssc4", kind=Kind.MACHINE).ready()
    bench.controller.take_control()
    bench.result(bench.controller.download(LISTING).future)
    bench.controller.show_listing(LISTING)
    bench.run(2.5)
    assert bench.controller.program_badge is Badge.SAME
    bench.controller.notices()
    return bench


def power_cycle(bench: Bench) -> None:
    bench.simulation.stimulus("reset", 0)
    bench.simulation.stimulus("reset", 1)


def nothing_is_claimed(bench: Bench) -> None:
    """The moment it is connected again: badge unknown, Watch, said in words, no program of ours is started."""
    controller = bench.controller
    bench.run_until(lambda: controller.state is State.READY)
    assert controller.program_badge is Badge.UNKNOWN
    assert not controller.control
    assert [n.kind for n in controller.notices()].count(NoticeKind.RESTARTED) == 1
    with pytest.raises(LinkError, match="in the controller is unknown"):
        bench.result(controller.execute("CUTTER"))
    bench.run(3.0)
    assert controller.program_badge is Badge.UNKNOWN
    assert NoticeKind.RESTARTED not in [n.kind for n in controller.notices()]


@pytest.mark.parametrize("port_closed", [False, True])
def test_a_power_cycle_behind_a_pulled_cable_longer_than_the_clock_ran(port_closed: bool) -> None:
    bench = machine()
    bench.loopback.unplugged = True
    bench.run(5.0)
    assert bench.controller.state is State.LOST
    assert bench.controller.program_badge is Badge.UNKNOWN
    power_cycle(bench)
    bench.run(30.0)
    bench.loopback.unplugged = False
    if port_closed:
        bench.controller.link.drop("The port is gone.")
    nothing_is_claimed(bench)


@pytest.mark.parametrize("port_closed", [False, True])
def test_a_cable_that_was_out_with_the_power_on_changes_nothing(port_closed: bool) -> None:
    bench = machine()
    bench.loopback.unplugged = True
    bench.run(30.0)
    bench.loopback.unplugged = False
    if port_closed:
        bench.controller.link.drop("The port is gone.")
    bench.run_until(lambda: bench.controller.state is State.READY)
    assert bench.controller.program_badge is Badge.SAME
    assert not bench.controller.control
    bench.run(3.0)
    assert NoticeKind.RESTARTED not in [n.kind for n in bench.controller.notices()]


def test_a_power_cycle_between_two_readings_of_an_open_line() -> None:
    bench = machine()
    power_cycle(bench)
    bench.run_until(lambda: bench.controller.doubt)
    bench.run_until(lambda: not bench.controller.doubt)
    nothing_is_claimed(bench)


@pytest.mark.parametrize(("name", "older"), [("dmc1412", 0), ("dmc1412", 90), ("ssc4", 90)])
def test_another_controller_on_the_line_is_not_taken_for_the_one_before(name: str, older: int) -> None:
    """Another type, or the same type whose clock is ahead."""
    bench = machine()
    bench.loopback.unplugged = True
    bench.run(10.0)
    other = Simulation(model(name), None, baud=19200, compiled=False)
    other.advance((older + 30) * 1_024_000)
    began, ours = bench.loopback.clock(), other.ticks
    bench.loopback.simulation = other
    bench.controller.clock = bench.controller.link._clock = lambda: began + (other.ticks - ours) / 1_024_000
    bench.loopback.unplugged = False
    nothing_is_claimed(bench)
    assert bench.controller.model is model(name)


def test_a_new_sample_time_is_no_restart() -> None:
    bench = machine()
    bench.ask("TM 500")
    bench.run(5.0)
    bench.ask("TM 2000")
    bench.run(5.0)
    assert bench.controller.program_badge is Badge.SAME
    assert bench.controller.control


def test_stop_while_the_clock_is_in_doubt_leaves_the_doubt() -> None:
    bench = machine()
    power_cycle(bench)
    bench.run_until(lambda: bench.controller.doubt)
    bench.controller.stop()
    bench.step()
    assert bench.controller.program_badge is Badge.UNKNOWN
    bench.run_until(lambda: not bench.controller.doubt)
    nothing_is_claimed(bench)


@pytest.mark.parametrize("kind", [Kind.SIMULATOR, Kind.MACHINE])
@pytest.mark.parametrize("ran_s", [0.1, 0.6, 1.5])
def test_a_reset_soon_after_connecting_is_noticed(ran_s: float, kind: Kind) -> None:
    """The clock is back at a small number that is still ahead of the one read before."""
    bench = Bench("ssc1", kind=kind).ready()
    bench.run(ran_s)
    bench.controller.notices()
    bench.simulation.stimulus("reset", 0)
    bench.simulation.stimulus("reset", 1)
    bench.run(6.0)
    assert [notice.kind for notice in bench.controller.notices()].count(NoticeKind.RESTARTED) == 1
