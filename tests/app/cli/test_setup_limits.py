"""The dry run starts with the limits of the setup (safety.md, 4)."""

from __future__ import annotations

from app.cli.limits import apply_limits
from codegen.models import MODELS
from codegen.setup import Axis, Setup, Unit
from codegen.twoletter.fixed import ONE
from device.simulator.simulation import Simulation


def registers(setup: Setup) -> dict[str, float]:
    simulation = Simulation(MODELS[setup.model])
    apply_limits(simulation, setup)
    return {name: values[0] / ONE for name, values in simulation.unit.state.registers.items()}


def test_a_new_setup_has_off_on_error_and_leaves_the_rest_as_after_a_reset() -> None:
    held = registers(Setup(model="ssc1"))
    assert (held["OE"], held["ER"], held["SP"], held["AC"]) == (1, 16384, 25000, 256000)


def test_limits_maximum_speed_and_acceleration_hold_from_the_start() -> None:
    axis = Axis(
        unit=Unit.MM, counts_per_unit="100", forward_limit="20", reverse_limit="-1", error_limit="5.009",
        torque_limit="5", maximum_speed="50", maximum_acceleration="1000", off_on_error=False,
    )  # fmt: skip
    held = registers(Setup(model="ssc1").with_axis("X", axis))
    assert (held["FL"], held["BL"], held["ER"], held["OE"], held["TL"]) == (2000, -100, 500, 0, 5)
    assert (held["SP"], held["AC"], held["DC"]) == (5000, 99328, 99328)  # 97 × 1024 is the last one below 100 000


def test_a_controller_slower_than_the_maximum_stays_so() -> None:
    axis = Axis(unit=Unit.MM, counts_per_unit="100", maximum_speed="5000", maximum_acceleration="90000")
    held = registers(Setup(model="ssc1").with_axis("X", axis))
    assert (held["SP"], held["AC"]) == (25000, 256000)
