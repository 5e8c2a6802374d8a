"""In real time with four axes moving and two busy threads: little work, and every sample at its time."""

from __future__ import annotations

import pytest

from tests.device.simulator.served import served_with_load
from tests.long import record


@pytest.mark.alone
@pytest.mark.long
def test_served_with_load_for_ten_minutes() -> None:  # in the everyday run a figure of tests/benchmarks
    served = served_with_load(600)
    here = "tests/device/simulator/test_served.py"
    record("served, four axes and two busy threads", here, 0, 100 * served.share, "% of one core")
    record("served, virtual against real time", here, 0, 1000 * served.late, "ms")
    assert served.share <= 0.05
    assert served.late <= 0.02  # two slices and the two questions: no sample is missing
    assert served.moves >= served.seconds / 2
