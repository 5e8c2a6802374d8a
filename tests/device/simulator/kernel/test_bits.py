"""The compiled loop, the plain one, and every way of cutting a run give the same bits."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from device.simulator.kernel import compiled, layout
from device.simulator.loops import thrifty_loop
from device.simulator.motion import Motion, Register
from device.simulator.plant import Drive, Place, Plant
from tests.device.simulator.kernel.scenario import mixed_run


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_compiled_and_plain_give_the_same_bits(seed: int) -> None:
    one, other = mixed_run(True, 12000, 10**6, seed), mixed_run(False, 12000, 10**6, seed)
    assert one[1].tobytes() == other[1].tobytes()
    assert one[0].tobytes() == other[0].tobytes()


@pytest.mark.parametrize("batch", [1, 7, 100])
def test_every_batch_size_gives_the_same_bits(batch: int) -> None:
    whole, cut = mixed_run(True, 20000, 10**6), mixed_run(True, 20000, batch)
    assert whole[1].tobytes() == cut[1].tobytes()
    differing = numpy.flatnonzero(whole[0].view(numpy.int64) != cut[0].view(numpy.int64))
    assert set(differing) <= {layout.TRIPS}


machines = st.builds(
    Plant,
    drive=st.sampled_from(list(Drive)),
    amplifier_gain=st.floats(0.2, 5.0),
    inertia=st.floats(1e-5, 1e-3),
    inductance=st.sampled_from([0.0, 0.004]),
    load_inertia=st.sampled_from([0.0, 1e-4, 2e-3]),
    coupling_stiffness=st.sampled_from([0.0, 5.0, 1e4]),
    coupling_damping=st.sampled_from([0.0, 0.02]),
    delay_samples=st.integers(0, 3),
    gravity=st.floats(-1.0, 1.0),
    torque_ripple=st.sampled_from([0.0, 0.1]),
    encoder_noise=st.sampled_from([0.0, 2.0]),
    viscous_friction=st.sampled_from([0.0, 0.003]),
    coulomb_friction=st.sampled_from([0.0, 0.01]),
    backlash=st.sampled_from([0.0, 5.0]),
    main=st.sampled_from([Place.MOTOR, Place.LOAD]),
    peak_current=st.sampled_from([2.0, 1e9]),
)


@given(machines, st.integers(0, 2**31))
def test_any_machine_gives_the_same_bits_and_stays_finite(plant: Plant, seed: int) -> None:
    states = []
    for made in (True, False):
        motion = Motion(1, [plant], seed=seed, compiled=made)
        motion.set(0, Register.MOTOR_TYPE, 2 if plant.drive is Drive.STEPPER else 1)
        motion.set(0, Register.KI, 1)
        motion.begin_position(0, 4000)
        motion.run(150)
        motion.load(0, 0.5)
        motion.push(0, 7)
        motion.run(100)
        motion.motor_off(0)
        motion.run(50)
        states.append(motion.snapshot())
    assert states[0].tobytes() == states[1].tobytes()
    assert numpy.isfinite(states[0]).all()


def test_the_mixed_run_really_moves_everything() -> None:
    state, rows = mixed_run(True, 20000, 10**6)
    assert numpy.isfinite(state).all()
    for axis in range(4):
        assert numpy.ptp(rows[:, 1 + 4 * axis]) > 1000
        assert numpy.ptp(rows[:, 2 + 4 * axis]) > 1000


def test_without_numba_the_plain_loop_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "numba", None)
    compiled.compiled_loop.cache_clear()
    thrifty_loop.cache_clear()  # other tests of this process may have taken the compiled loop by now
    try:
        motion = Motion(1)
        assert not motion.compiled
        with pytest.raises(compiled.CompilerMissing, match="numba cannot be loaded"):
            Motion(1, compiled=True)
    finally:
        compiled.compiled_loop.cache_clear()
        thrifty_loop.cache_clear()


def test_a_snapshot_gives_any_moment_again() -> None:
    motion = Motion(2)
    motion.set(0, Register.JOG_SPEED, 20000)
    motion.begin_jog(0)
    motion.run(777)
    moment = motion.snapshot()
    motion.run(1000)
    end = motion.snapshot()
    motion.restore(moment)
    assert motion.sample == 777
    motion.run(1000)
    assert motion.snapshot().tobytes() == end.tobytes()


def test_the_cache_is_named_after_the_sources() -> None:
    assert compiled.cache_folder().name == f"kernel-{compiled.source_version()}"
    assert set(compiled.MODULES) | {"compiled"} == {
        path.stem for path in compiled.Path(compiled.__file__).parent.glob("*.py") if not path.stem.startswith("_")
    }


def test_no_two_slots_share_a_place() -> None:
    names = [name for name in vars(layout) if name.isupper()]
    axis_names = names[names.index("SPEED_V") : names.index("DELAY_RING")]
    assert [getattr(layout, name) for name in axis_names] == list(range(len(axis_names)))
    assert len(axis_names) <= layout.DELAY_RING
    header = names[names.index("AXES") : names.index("WATCH")]
    places = [getattr(layout, name) for name in header]
    assert places == sorted(set(places))
    assert layout.ANALOG_1 >= layout.INPUT_1 + 8
    assert max(places) < layout.WATCH


def test_a_cache_that_can_not_be_written_is_not_needed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    monkeypatch.setattr(compiled, "cache_folder", lambda: blocked / "kernel-x")
    assert compiled.make_cache_folder() is None


def test_caches_that_nothing_uses_are_dropped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("kernel-old", "kernel-beside", "kernel-new", "other"):
        (tmp_path / name).mkdir()
    for name in ("kernel-old", "kernel-new", "other"):
        os.utime(tmp_path / name, (1.0, time.time() - 2 * compiled.UNUSED_S))
    monkeypatch.setattr(compiled, "cache_folder", lambda: tmp_path / "kernel-new")
    compiled.drop_old_caches()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["kernel-beside", "kernel-new", "other"]
    compiled.make_cache_folder()
    assert (tmp_path / "kernel-new").stat().st_mtime == pytest.approx(time.time(), abs=60)  # in use again
