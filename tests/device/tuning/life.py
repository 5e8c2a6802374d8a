"""A studio without windows that tunes until it is killed: `python -m tests.device.tuning.life ADDRESS FOLDER N`."""

from __future__ import annotations

import random
import sys
import time
from datetime import datetime
from pathlib import Path

from device.api import Controller, Kind, LineSettings, State
from device.tuning.bench import Wish
from device.tuning.loop import Gains
from device.tuning.run import run_automatic, run_step

BAUD = 19200
STEP = 400


def connected(address: str) -> Controller:
    """In Control, and asked who it is."""
    controller = Controller.connect(address, LineSettings(baud=BAUD), kind=Kind.MACHINE)
    end = time.monotonic() + 60
    while controller.state is not State.READY and time.monotonic() < end:
        time.sleep(0.01)
    controller.take_control()
    return controller


def main(address: str, folder: Path, seed: int) -> None:
    controller, chance = connected(address), random.Random(seed)
    print("ready", flush=True)
    while True:
        if chance.random() < 0.5:
            gains = Gains(kp=chance.uniform(3, 30), kd=chance.uniform(60, 300), ki=chance.uniform(0, 2))
            wish = Wish("X", chance.choice((-STEP, STEP)), gains, torque=6.0, seconds=0.25)
            job = run_step(controller, wish, folder, datetime.now())
        else:
            wish = Wish("X", STEP, Gains(), torque=6.0, seconds=0.25)
            job = run_automatic(controller, wish, folder, datetime.now(), lambda m, why: None, velocity=False)  # type: ignore[assignment]
        job.future.exception(120)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), int(sys.argv[3]))
