"""What only real time and real processes show: questions under full reading, connecting again at any moment."""

from __future__ import annotations

import sys
import time

import pytest

from device.api import Controller, Kind, LineSettings, State
from device.simulator.process import SimulatorProcess
from tests.device.test_latency import NO_PTY, connected, wait_until
from tests.long import count, is_long
from tests.slower import queued_s


@pytest.mark.paced
@pytest.mark.parametrize("baud", [9600, 38400])
def test_questions_get_exactly_their_answers_with_everything_read(baud: int) -> None:
    with connected(baud) as (process, controller):
        listing = '#A\nN=0;TOTAL=0\n#B\nIN "HOW MANY",V\nTOTAL=TOTAL+V;N=N+1\nJP #B,N<12\nEN'
        controller.download(listing).future.result(30)
        controller.execute("A", anyway=True).result(10)
        for answer in range(1, 13):
            wait_until(lambda: controller.pending_prompt is not None)
            controller.answer(str(answer)).result(5)
            wait_until(lambda: controller.pending_prompt is None)
        wait_until(lambda: not process.state()["threads"][0]["running"])
        assert process.state()["variables"]["TOTAL"] == sum(range(1, 13))
        assert process.state()["errors"] == []


@pytest.mark.alone
@pytest.mark.parametrize("pty", [False, pytest.param(True, marks=NO_PTY)] if is_long() else [sys.platform != "win32"])
@pytest.mark.parametrize("program", ["", "#A\nN=N+1;MG N\nWT 20\nJP #A\nEN", '#A\nIN "LENGTH",L\nJP #A\nEN'])
def test_connecting_again_and_again_to_the_same_controller(pty: bool, program: str) -> None:
    """Left at any moment, also while a program talks or asks: connected again within 2 s, every time."""
    line = LineSettings(baud=19200)
    with SimulatorProcess("dmc1412", pty=pty, baud=19200) as process:
        for turn in range(count(3, 12)):
            began, queued = time.monotonic(), queued_s(process.pid)
            controller = Controller.connect(process.address, line, kind=Kind.SIMULATOR)
            controller.watch("all", ["position.x", "inputs"])
            try:
                wait_until(lambda: controller.state is State.READY, 15.0)  # noqa: B023
                taken = time.monotonic() - began - (queued_s(process.pid) - queued)  # without what other programs took
                assert turn == 0 or taken < 2.0  # the first waits for the simulator to start
                assert controller.model is not None
                if turn == 0 and program:
                    controller.download(program).future.result(20)
                    assert controller.execute("A", anyway=True).result(5).accepted
                time.sleep(0.037 * (turn % 6))
            finally:
                controller.close()
