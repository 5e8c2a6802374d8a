"""Plant files: every key is read, every mistake is one sentence."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

import pytest

import resources
from device.simulator.motion import Motion
from device.simulator.plant import Drive, Place, Plant
from device.simulator.plant_file import PlantUnreadable, load_plants, read_plants

EVERYTHING = """
[axis.x]
drive = "current"
amplifier_gain = 1.0
torque_constant = 0.1
inertia = 2.0e-4
resistance = 2.0
inductance = 0.004
tachometer_gain = 0.1
load_inertia = 0.0
coupling_stiffness = 0.0
coupling_damping = 0.0
delay_samples = 0
gravity = 0.0
torque_ripple = 0.0
encoder_noise = 0.0
viscous_friction = 0.0
coulomb_friction = 0.0
encoder_lines = 1000
backlash = 0
main = "motor"
auxiliary = "motor"
auxiliary_ratio = 1.0
peak_current = 1e9
magnetic_cycle = 1333.333
hall_inputs = 5
hall_offset = 30
hall_order = "213"
phases_swapped = true
home_switch = [900, 1000]
forward_limit = 100000
reverse_limit = -100000
index_at = 137
motor_reversed = true
amplifier_enable = "always"
dead_channel = "b"
limits_swapped = true
home_stuck = true
"""


def test_every_key_is_known() -> None:
    plant = read_plants(EVERYTHING)["X"]
    named = {line.split(" = ")[0] for line in EVERYTHING.splitlines() if " = " in line}
    assert named == {field.name for field in fields(Plant)}
    assert (plant.home_switch, plant.hall_inputs, plant.phases_swapped) == ((900.0, 1000.0), 5, True)


def test_the_defaults_are_the_manuals_motor() -> None:
    # dmc-1412-1414.txt l.4370-4376
    plant = read_plants("[axis.w]\n")["W"]
    assert plant == Plant()
    assert (plant.torque_constant, plant.inertia, plant.resistance, plant.inductance) == (0.1, 2.0e-4, 2.0, 0.004)
    assert plant.drive is Drive.CURRENT
    assert plant.main is Place.MOTOR


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("x", "not a plant file: "),
        ("[motor]\n", "a plant file holds tables such as [axis.x], not motor"),
        ("[axis.q]\n", "axis.q: the axes are x, y, z and w"),
        ("[axis.x]\nmass = 1\n", "axis.x: mass is not something a plant file can say"),
        ("[axis.x]\ninertia = 0\n", "axis.x: inertia must be above 0, not 0"),
        ("[axis.x]\ninertia = nan\n", "axis.x: inertia must be a number, not nan"),
        ('[axis.x]\ngravity = "1"\n', "axis.x: gravity must be a number, not '1'"),
        ("[axis.x]\nbacklash = -1\n", "axis.x: backlash must not be negative, but is -1"),
        ("[axis.x]\ndelay_samples = 33\n", "axis.x: delay_samples must be a whole number from 0 to 32, not 33"),
        ('[axis.x]\ndrive = "steam"\n', 'axis.x: drive must be one of "current", "voltage", "velocity", "stepper"'),
        ('[axis.x]\nmain = "external"\n', 'axis.x: main must be one of "motor", "load"'),
        ("[axis.x]\nhome_switch = 5\n", "axis.x: home_switch must be two positions in brackets"),
        ("[axis.x]\nhome_switch = [2, 1]\n", "axis.x: home_switch must begin with its lower end"),
        ("[axis.x]\nphases_swapped = 1\n", "axis.x: phases_swapped must be true or false, not 1"),
    ],
)
def test_mistakes_are_one_sentence(text: str, sentence: str) -> None:
    with pytest.raises(PlantUnreadable) as caught:
        read_plants(text)
    assert str(caught.value).startswith(sentence)
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_there_or_not_text(tmp_path: Path) -> None:
    with pytest.raises(PlantUnreadable, match="No such file"):
        load_plants(tmp_path / "none.toml")
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(PlantUnreadable, match="not a text file"):
        load_plants(tmp_path / "bytes.toml")


@pytest.mark.parametrize(
    "path", sorted((Path(resources.__file__).parent / "plants").glob("*.toml")), ids=lambda p: p.stem
)
def test_the_plants_that_come_along_run(path: Path) -> None:
    plants = load_plants(path)
    motion = Motion(4, [plants.get(letter, Plant()) for letter in "XYZW"])
    assert plants
    assert motion.run(200) == 200
