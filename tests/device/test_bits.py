"""Bits are called what they are, and their edges lie where the machine's inputs, outputs and switches changed."""

from __future__ import annotations

import dataclasses as dc
import math
from pathlib import Path

import numpy as np
import pytest

from codegen.models import MODELS
from codegen.setup import Setup
from device.bits import signals, worth
from device.capture import Capture, Channel, Plan
from device.capture_file import load, save
from device.capturing import capture
from device.roll import Roll
from device.waves import Wave, drawn
from tests.device.test_capture import done, moving
from tests.rig import Rig

INPUTS, OUTPUTS, SWITCHES = Channel("inputs"), Channel("outputs"), Channel("switches", "X")
NAMED = Setup(model="ssc2", input_names=("", "", "Clamp", *("",) * 5), output_names=("Glue", *("",) * 7))


def happening(rig: Rig, plan: Plan, *happens: tuple[float, str, float]) -> tuple[Capture, list[float]]:
    """A capture, and when each thing happened: seconds after the first recorded sample."""
    job = capture(rig.controller, plan, setup=NAMED)
    rig.until(lambda: rig.simulation.unit.state.recording.index)
    state, at = rig.simulation.unit.state.recording, []
    first = state.sample - state.index * state.interval
    for after, what, value in happens:
        rig.run(after)
        rig.simulation.stimulus(what, value)
        at.append(rig.simulation.unit.sample - first)
    found = done(rig, job)
    return found, [samples * found.tm / 1_024_000 for samples in at]


def edges(wave: Wave) -> list[tuple[float, bool]]:
    return [(float(at), bool(on)) for at, on in zip(wave.times[1:], wave.on[1:], strict=True)]


def test_captured_bits_change_when_the_inputs_do() -> None:
    """Bit n - 1 is input n (OP 6 is outputs 2 and 3, dmc-1412-1414.txt l.3928); each edge within one interval."""
    rig = moving()
    rig.type("OP 6")
    happens = ((0.1, "in3", 0.0), (0.08, "in8", 0.0), (0.06, "in3", 1.0), (0.05, "in1", 0.0))
    found, at = happening(rig, Plan((INPUTS, OUTPUTS), 2, 140), *happens)
    shown = {signal.label: wave for signal, wave in drawn(found, INPUTS, None)}
    assert list(shown) == ["Input 1", "Input 3 Clamp", "Input 8"]  # what changed, and what has a name
    wanted = {
        "Input 1": [(at[3], False)],
        "Input 3 Clamp": [(at[0], False), (at[2], True)],
        "Input 8": [(at[1], False)],
    }
    for label, wave in shown.items():
        assert wave.on[0] and [on for _, on in edges(wave)] == [on for _, on in wanted[label]]
        np.testing.assert_allclose(
            [when for when, _ in edges(wave)], [when for when, _ in wanted[label]], atol=1.01 * found.interval_s
        )
    timing = shown["Input 3 Clamp"].timing(-math.inf, math.inf)
    whole = 139 * found.interval_s
    assert (timing.falls, timing.rises) == (1, 1) and timing.known_s == pytest.approx(whole)
    assert timing.on_s == pytest.approx(whole - (at[2] - at[0]), abs=2 * found.interval_s)
    (glue, low), *others = drawn(found, OUTPUTS, None)
    assert glue.label == "Output 1 Glue" and others == [] and not low.on.any()  # none changed: only the named one
    high = [signal.label for signal, wave in drawn(found, OUTPUTS, range(8)) if wave.on.all()]
    assert high == ["Output 2", "Output 3"]


@pytest.mark.parametrize("polarity", [-1, 1])
def test_recorded_switches_say_the_same_in_both_polarities(polarity: int) -> None:
    """_TS as RD records it: 3 and 2 are limits not active, 1 home, 0 latch not armed (commands.md, TS; l.3433).

    CN 1 turns the level of an active switch round (l.4111), and with it nothing of "not active".
    """
    rest, tripped = (1.0, 0.0) if polarity < 0 else (0.0, 1.0)
    rig = moving()
    for name in ("fls_x", "rls_x"):
        rig.simulation.stimulus(name, rest)
    rig.type(f"CN {polarity}", "AL X")
    happens = ((0.1, "fls_x", tripped), (0.08, "rls_x", tripped), (0.06, "fls_x", rest), (0.05, "in1", 0.0))
    found, _ = happening(rig, Plan((SWITCHES,), 2, 140), *happens)
    shown = {signal.label: (signal, wave) for signal, wave in drawn(found, SWITCHES, None)}
    said = {label: [signal.bit.words[int(each)] for each in wave.on] for label, (signal, wave) in shown.items()}
    assert said == {
        "Forward limit X": ["free", "at limit", "free"],
        "Reverse limit X": ["free", "at limit"],
        "Latch X": ["armed", "not armed"],
    }
    forward, reverse = (shown[name][1].times[1] for name in ("Forward limit X", "Reverse limit X"))
    assert reverse - forward == pytest.approx(0.08, abs=2 * found.interval_s)


def test_only_what_the_model_has_is_a_track() -> None:
    """A DMC-141x has 7 inputs and 3 outputs (l.1125, l.3905); what RD leaves out of TS is told live only."""
    small = MODELS["dmc1412"]
    assert [each.label for each in signals(OUTPUTS, None, small)] == ["Output 1", "Output 2", "Output 3"]
    assert len(signals(INPUTS, None, small)) == 7
    assert {each.bit.number for each in signals(SWITCHES, None, small)} == {3, 2, 1, 0}
    assert {each.bit.number for each in signals(SWITCHES, None, small, live=True)} == {7, 6, 5, 3, 2, 1, 0}
    assert signals(Channel("position", "X"), None, small) == ()


def test_which_tracks_are_drawn() -> None:
    known, unnamed = signals(INPUTS, NAMED, None), signals(INPUTS, None, None)

    def numbers(*asked: object, live: bool = False) -> list[int]:
        return [each.bit.number + 1 for each in worth(*asked, live=live)]  # type: ignore[arg-type]

    assert numbers(known, None, {0}) == [1, 3]
    assert numbers(known, (6, 1), {0}) == [2, 7]  # those that were chosen, and no others
    assert numbers(unnamed, None, {5}) == [6]
    assert numbers(unnamed, None, ()) == list(range(1, 9))
    assert numbers(unnamed, None, {5}, live=True) == list(range(1, 9))
    assert numbers(known, None, {5}, live=True) == [3, 6]


def test_a_period_and_the_time_on_are_those_of_a_square() -> None:
    """On for 0.2 s of each 0.5 s, from 0.1 s on."""
    times = np.arange(0, 3, 0.01)
    values = np.where((times - 0.1) % 0.5 < 0.2 - 1e-9, 4.0, 0.0)
    values[times < 0.1 - 1e-9] = 0.0
    found = Capture((INPUTS,), values[None, :], 1, 1000.0, moments=times, setup=NAMED)
    ((signal, wave),) = drawn(found, INPUTS, None)
    whole = wave.timing(-math.inf, math.inf)
    assert signal.label == "Input 3 Clamp" and (whole.rises, whole.falls) == (6, 6)
    assert whole.period_s == pytest.approx(0.5) and whole.on_s == pytest.approx(6 * 0.2)
    part = wave.timing(0.2, 0.85)  # on until 0.3 and from 0.6 to 0.8
    assert (part.rises, part.falls) == (1, 2) and part.on_s == pytest.approx(0.1 + 0.2)
    assert part.known_s == pytest.approx(0.65) and part.period_s == pytest.approx(0.5)  # between the falls
    assert wave.at(0.29) is True and wave.at(0.31) is False and wave.at(3.5) is None
    assert math.isnan(wave.timing(5, 6).on_s)


def test_live_tracks_have_every_change_of_the_bits() -> None:
    """Over the byte stream: what the poll has read of TI, bit by bit; the changes are kept beside, and only they."""
    rig = Rig(model="ssc2").ready()
    roll = Roll(("inputs",))
    rig.controller.watch("scope", ("inputs",), each_round=("inputs",))
    rig.controller.hurry(True)
    roll.take(rig.controller.poller.ring)
    changes, told = roll.changes(INPUTS), []
    for number, value in ((3, 0), (5, 0), (3, 1), (3, 0)):
        rig.run(0.4)
        roll.take(rig.controller.poller.ring)
        rig.simulation.stimulus(f"in{number}", value)
        told.append((number, bool(value), roll.end))
    rig.run(0.4)
    roll.take(rig.controller.poller.ring)
    known = {each.bit.number: each for each in signals(INPUTS, NAMED, None, live=True)}
    for number in (3, 5, 1):
        mine = [(at, on) for which, on, at in told if which == number]
        wave = changes.wave(known[number - 1], -math.inf, math.inf)
        assert wave.on[0] and [on for _, on in edges(wave)] == [on for _, on in mine]
        for (seen, _), (happened, _) in zip(edges(wave), mine, strict=True):
            assert happened < seen <= happened + 0.1
    assert changes.changed == 0b10100 and changes.track.count == 5 < roll.tracks["inputs"].count
    later = Roll(("inputs", "position.x"), before=roll).changes(INPUTS)  # another channel is taken in
    assert later.changed == 0b10100 and later.track.count == 5


@pytest.mark.parametrize("name", ["bits.csv", "bits.npz"])
def test_a_file_keeps_the_byte_and_a_table_has_the_bits_beside_it(name: str, tmp_path: Path) -> None:
    """The bits are columns behind; the file is what it was, and what is read back has the same tracks."""
    names = ("", 'Door, "left"', *("",) * 6)
    setup = dc.replace(NAMED, input_names=names)
    values = np.array([[255.0, 253.0, 255.0], [0b1110, 0b0110, 0b1110]])
    found = Capture((INPUTS, SWITCHES), values, 1, 1000.0, model="ssc2", when="2026-11-23 08:00:00", setup=setup)
    save(tmp_path / name, found)
    again = load(tmp_path / name)
    np.testing.assert_array_equal(again.values, values)
    assert [each.label for each, _ in drawn(again, INPUTS, None)] == ['Input 2 Door, "left"']
    if name.endswith(".csv"):
        _, heads, *lines = (tmp_path / name).read_text().splitlines()
        table = dict(zip(heads.split(","), zip(*(line.split(",") for line in lines), strict=True), strict=True))
        assert table["Inputs"] == ("255", "253", "255") and table["Switches X"] == ("14", "6", "14")
        assert table["Input 2 Door left"] == ("1", "0", "1") and table["Input 1"] == ("1", "1", "1")
        assert table["Forward limit X (1: at limit)"] == ("0", "1", "0")
        assert len(table) == 1 + 2 + 8 + 4


def test_very_many_live_changes_are_drawn_from_pieces() -> None:
    """Input 1 turns with each value, input 2 only once: the first is a band of both levels, the second one edge."""
    roll, count = Roll(("inputs",)), 40_000
    times = np.arange(count) * 0.02
    roll.tracks["inputs"].add(times, np.arange(count) % 2 + np.where(times >= 400, 2.0, 0.0))
    changes = roll.changes(INPUTS)
    first, second, *_ = signals(INPUTS, None, None, live=True)
    band, step = changes.wave(first, 0, 800), changes.wave(second, 0, 800)
    assert 1500 < len(band.times) <= 2000 and not band.whole and math.isnan(band.timing(0, 800).on_s)
    ((at, on),) = edges(step)
    assert on and at == pytest.approx(400, abs=0.8) and band.at(5.0) is None
    near = changes.wave(second, 399, 401)
    assert near.whole and edges(near)[0][0] == pytest.approx(400) and near.timing(399, 401).rises == 1
