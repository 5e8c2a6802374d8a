"""In real time with four axes moving and two busy threads: little work, and every sample at its time."""

from __future__ import annotations

import pytest

from tests.device.simulator.served import served_with_load
from tests.long import count, record


@pytest.mark.alone
def test_served_with_load() -> None:
    served = served_with_load(count(8, 600))
    record(
        "served, four axes and two busy threads", "tests/device/simulator/test_served.py", 0, 100 * served.share, "%"
    )
    record("served, virtual against real time", "tests/device/simulator/test_served.py", 0, 1000 * served.late, "ms")
    assert served.share <= 0.05
    assert served.late <= 0.02  # two slices and the two questions: no sample is missing
    assert served.moves >= served.seconds / 2
