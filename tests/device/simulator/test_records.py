"""What the host is told beside the bytes."""

from __future__ import annotations

from device.simulator.twoletter.records import Records
from tests.device.simulator.bench import Bench


def test_messages_are_joined_up_to_their_line_end() -> None:
    bench = Bench()
    bench.run('#A\nMG "A"{N}\nMG "B"\nMG "C"{N}\nIN "WHAT",W\nEN', seconds=0.1)
    assert bench.texts() == ["AB", "CWHAT"]


def test_only_the_newest_are_kept_of_a_long_run() -> None:
    records = Records()
    for number in range(1000):
        records.sent(number * 1024, 1, f"{number}\r\n")
        records.keep(200)
    assert records.messages[-1] == (999.0, 1, "999")
    assert 200 <= len(records.messages) <= 400


def test_the_trace_tells_every_line_and_the_end() -> None:
    bench = Bench()
    seen: list[tuple[int, int]] = []
    bench.simulation.on_trace = lambda ticks, thread, line: seen.append((thread, line))
    bench.run("#A\nN=0\n#L;N=N+1\nJP#L,N<2\nEN")
    assert seen == [(0, 0), (0, 1), (0, 2), (0, 3), (0, 2), (0, 3), (0, 4), (0, -1)]


def test_state_has_the_shape_of_run_json() -> None:
    bench = Bench("ssc2")
    bench.run('#A\nNAME="CAT";X1=2.5\nDM V[3];V[1]=7\nSB2\nPR 100;BGX;AMX\nEN')
    state = bench.simulation.state()
    assert state["axes"]["X"]["commanded"] == 100
    assert set(state["axes"]) == {"X", "Y"}
    assert state["outputs"] == 2
    assert state["variables"]["X1"] == 2.5
    assert state["strings"] == {"NAME": "CAT"}
    assert state["arrays"] == {"V": [0, 7, 0]}
    assert state["threads"][0] == {"running": False, "line": -1, "waiting_for": None}
