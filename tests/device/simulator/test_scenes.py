"""Every named situation is what its title says."""

from __future__ import annotations

import pytest

from device.simulator.scenes import SCENES, scene, set_up
from tests.device.simulator.bench import Bench

EXPECTED = {
    "rest": ("TP", " 0000000000"),
    "forward_limit": ("MG _LFX{F1.0}", " 0"),
    "reverse_limit": ("MG _LRX{F1.0}", " 0"),
    "motor_off": ("MG _MOX{F1.0}", " 1"),
    "following_error": ("MG _MOX{F1.0},_SCX{F1.0}", " 1 8"),
    "half_way": ("MG _BGX{F1.0}", " 1"),
    "jogging": ("JG?", " 00005000"),
    "abort": ("MG _AB{F1.0}", " 0"),
    "refused": ("TC1", "1 Unrecognized command"),
    "running": ("MG _HX0{F1.0}", " 1"),
    "program_error": ("TC1", "7 Command not valid while running"),
    "input_wait": ("MG _HX0{F1.0},_XQ0{F2.0}", " 2 01"),
}


@pytest.mark.parametrize("name", list(EXPECTED))
def test_scenes(name: str) -> None:
    bench = Bench("ssc1")
    set_up(bench.simulation, name)
    bench.wait(0)
    command, answer = EXPECTED[name]
    reply = bench.ask(command)
    if name == "running":
        assert reply in (" 1", " 2")
    else:
        assert reply == answer


def test_a_waiting_prompt() -> None:
    bench = Bench("ssc1")
    set_up(bench.simulation, "prompt")
    assert bench.texts() == ["LENGTH"]
    assert bench.simulation.state()["threads"][0]["waiting_for"] == "input"


def test_all_scenes_are_tried_and_an_unknown_one_is_said() -> None:
    assert {known.name for known in SCENES} == {*EXPECTED, "prompt"}
    with pytest.raises(KeyError, match="no scene 'moon'; there are rest "):
        scene("moon")
