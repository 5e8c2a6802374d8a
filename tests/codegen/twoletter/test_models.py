"""Controller models: limits of the manuals, friendly refusals."""

from __future__ import annotations

import pytest

from codegen.models import MODELS, model


def test_the_models_there_are() -> None:
    assert list(MODELS) == ["ssc1", "ssc2", "ssc3", "ssc4", "dmc1412", "dmc1414", "smartmotor"]
    assert [len(MODELS[f"ssc{count}"].axes) for count in (1, 2, 3, 4)] == [1, 2, 3, 4]


def test_names_are_read_in_any_case_and_refused_with_the_list() -> None:
    assert model("SSC2") is MODELS["ssc2"]
    with pytest.raises(KeyError, match="ssc1, ssc2"):
        model("ssc9")


def test_the_dmc_141x() -> None:
    small = model("dmc1412")
    assert (small.lines, small.columns) == (250, 40)  # l.2427
    assert small.labels == small.variables == 126  # l.2487, 3183
    assert (small.arrays, small.elements, small.threads) == (6, 1000, 2)  # l.3325, 2622
    assert small.commutation and not model("dmc1414").commutation
    assert {"LM", "GA", "EA"} <= small.missing
    assert small.power_up_motor_on  # l.832


def test_the_ssc() -> None:
    large = model("ssc4")
    assert (large.lines, large.columns, large.arrays, large.elements, large.threads) == (1000, 80, 30, 8000, 4)
    assert [MODELS[name].tm_min_us for name in ("ssc1", "ssc2", "ssc3", "ssc4")] == [250, 375, 500, 500]
    assert not model("ssc1").coordinated and model("ssc2").coordinated
