"""A studio without windows that holds an axis: `python -m tests.device.holding ADDRESS BAUD`, told what to do by lines.

`hold` presses and renews, `release` lets go, `freeze` ends the thread that renews, `unplug` and `plug` are the cable.
"""

from __future__ import annotations

import sys
import threading
import time

from device.api import Controller, Kind, LineSettings, State
from device.transport import Transport, open_transport

SPEED, ACCELERATION = 20_000, 256_000


class Cable:
    """A line that can be pulled: nothing comes, nothing arrives."""

    out = False

    def __init__(self, inner: Transport) -> None:
        self.inner = inner

    @property
    def description(self) -> str:
        return self.inner.description

    def read(self, timeout_s: float) -> bytes:
        data = self.inner.read(timeout_s)
        return b"" if Cable.out else data

    def write(self, data: bytes) -> int:
        return len(data) if Cable.out else self.inner.write(data)

    def unsent(self) -> int:
        return self.inner.unsent()

    def discard_output(self) -> None:
        self.inner.discard_output()

    def close(self) -> None:
        self.inner.close()


class Hand:
    """The thread that renews, as the window does."""

    def __init__(self, controller: Controller) -> None:
        self.controller, self.down = controller, False

    def press(self) -> None:
        self.down = True
        held = self.controller.motion.hold("X", SPEED, ACCELERATION, ACCELERATION)
        held.add_done_callback(lambda done: print(done.exception() or done.result(), file=sys.stderr, flush=True))
        threading.Thread(target=self._renew, daemon=True).start()

    def _renew(self) -> None:
        while self.down:
            time.sleep(0.05)
            self.controller.motion.renew()


def main(address: str, baud: int) -> None:
    line = LineSettings(baud=baud)
    controller = Controller(lambda: Cable(open_transport(address, line)), kind=Kind.SIMULATOR, line=line)
    controller.watch("panels", ("position.x", "commanded.x", "moving.x", "inputs", "switches.x", "torque.x"))
    while controller.state is not State.READY:
        time.sleep(0.01)
    controller.ask("SH").result(5)
    hand = Hand(controller)
    print("ready", flush=True)
    for each in sys.stdin:
        word = each.strip()
        if word == "hold":
            while controller.state is not State.READY or controller.motion.busy:
                time.sleep(0.01)
            hand.press()
        elif word == "release":
            hand.down = False
            controller.motion.release()
        elif word == "freeze":
            hand.down = False
        elif word in ("unplug", "plug"):
            Cable.out = word == "unplug"
            hand.down = hand.down and word == "unplug"
        print(word, flush=True)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
