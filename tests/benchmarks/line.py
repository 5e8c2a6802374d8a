"""How much of the line's speed a download uses."""

from __future__ import annotations

import time

from device.api import Controller, Kind, State
from device.simulator.process import SimulatorProcess
from device.transport import LineSettings, open_transport
from tests.benchmarks.figure import Figure

BAUD = 19200
BITS = 10
LINES = (60, 120, 500)


def listing(lines: int) -> str:
    """A program as technicians write it: short lines, as many as a small or a large machine needs."""
    body = [f"PR {1000 + number * 7};SP 20000;BGX;AMX" for number in range(lines - 2)]
    return "\n".join(["#A", *body, "EN"])


def download_shares() -> list[Figure]:
    """Downloads of every length, the simulator warm."""
    return [download_share(lines) for lines in LINES]


def download_share(lines: int) -> Figure:
    """Bytes of the download over what the line could carry, from DL to the final prompt."""
    text = listing(lines)
    line = LineSettings(baud=BAUD, handshake="rts")
    with SimulatorProcess("ssc1", pty=True, baud=BAUD) as simulator:
        controller = Controller(lambda: open_transport(simulator.address, line), kind=Kind.SIMULATOR, line=line)
        try:
            end = time.monotonic() + 60
            while controller.state is not State.READY or not simulator.state()["compiled"]:
                assert time.monotonic() < end, controller.state_text
                time.sleep(0.02)
            job = controller.download(text)
            done = job.future.result(60)
            assert done.verified, done.sentence
            rows = [row for row in controller.traffic() if row.source == "download"]
        finally:
            controller.close()
    sent = [row for row in rows if row.direction == ">"]
    first = next(row for row in sent if row.text.strip() == "DL")
    last = next(row for row in sent if row.text.strip() == "\\")
    after = next(row for row in sent if row.number > last.number)  # leaves when the final prompt has come
    size = len("DL\r") + sum(len(row) + 1 for row in text.split("\n")) + len("\\:")
    share = size * BITS / BAUD / (after.at - first.at)
    return Figure(f"download of {lines} lines, share of the line's limit", 100 * share, f"% at {BAUD} baud", least=90)
