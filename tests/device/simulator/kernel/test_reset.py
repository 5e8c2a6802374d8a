"""What a reset takes from the motion: nothing that was prepared before it is left."""

from __future__ import annotations

from tests.device.simulator.bench import Bench


def test_a_reset_disarms_latches_and_forgets_the_cam_table() -> None:
    bench = Bench("ssc2")
    assert int(float(bench.ask("MG _TSX"))) & 1 == 1  # bit 0: no latch armed
    bench.ask("ALX;EAX;EM 100,90;EP 50,0;ET[0]=0,7;ET[1]=0,90;ES 1,2;PR 500;BGX")
    bench.wait(30)
    bench.ask("STX")
    assert int(float(bench.ask("MG _TSX"))) & 1 == 0
    bench.type("RS\r", ms=3000)
    assert int(float(bench.ask("MG _TSX"))) & 1 == 1
    assert int(bench.ask("SC").split(",")[0]) == 1
    motion = bench.simulation.motion
    motion.cam.interval(50, 0)
    assert (motion.cam.value(1, 0.0), motion.cam.value(1, 50.0)) == (0.0, 0.0)
