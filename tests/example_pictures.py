"""Pictures of the shipped programs at work, for the help: `python -m tests.example_pictures`.

The way of the cutting table's knife, and the press with its strip over time, as the simulator runs them.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator

import numpy as np
from PySide6.QtCore import QByteArray, QRectF, Qt
from PySide6.QtGui import QImage, QPainter
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QApplication

import resources
from app.cli.picture import Panel, draw
from codegen import files
from codegen.generate import generate
from codegen.models import model
from device.simulator.simulation import Simulation

SIZE = (1280, 800)
MS = 1000  # ticks of a sample


def table() -> None:
    """The way of the knife: thin while it is up, thick while it is down, with the direction in which it points."""
    rows = list(cut())
    scale, left, bottom = 8.6, 150.0, 690.0  # px a mm

    def place(x: float, y: float) -> str:
        return f"{left + x * scale:.1f},{bottom - y * scale:.1f}"

    parts = []
    dashes = 'stroke="#8a939c" stroke-width="3" stroke-dasharray="9 7"'
    for along in range(0, 121, 20):
        parts.append(
            f'<line class="grid" x1="{left + along * scale}" y1="80" x2="{left + along * scale}" y2="{bottom}"/>'
        )
        parts.append(f'<text x="{left + along * scale}" y="{bottom + 36}" text-anchor="middle">{along}</text>')
    for up in range(0, 71, 10):
        y = bottom - up * scale
        parts.append(f'<line class="grid" x1="{left}" y1="{y}" x2="{left + 120 * scale}" y2="{y}"/>')
        parts.append(f'<text x="{left - 12}" y="{y + 9}" text-anchor="end">{up}</text>')
    up_points = " ".join(place(x, y) for x, y, _, down in rows if not down)
    down_points = " ".join(place(x, y) for x, y, _, down in rows if down)
    parts.append(f'<polyline points="{up_points}" fill="none" {dashes}/>')
    parts.append(f'<polyline points="{down_points}" fill="none" stroke="#0b6e99" stroke-width="5"/>')
    gone, before = 0.0, None
    for x, y, turned, down in rows:
        gone += math.dist((x, y), before) if before and down else 0
        before = (x, y)
        if down and gone >= 8:
            gone = 0.0
            across, along = math.cos(math.radians(turned)) * 2, math.sin(math.radians(turned)) * 2
            ends = f"{place(x - across, y - along)} {place(x + across, y + along)}"
            parts.append(f'<polyline points="{ends}" stroke="#b5541c" stroke-width="9" stroke-linecap="round"/>')
    words = [
        '<text class="title" x="150" y="50">The cutting table, mm</text>',
        f'<line x1="590" y1="40" x2="640" y2="40" {dashes}/>',
        '<text x="652" y="50">knife up</text>',
        '<line x1="790" y1="40" x2="840" y2="40" stroke="#0b6e99" stroke-width="5"/>',
        '<text x="852" y="50">knife down</text>',
        '<line x1="1030" y1="40" x2="1060" y2="40" stroke="#b5541c" stroke-width="9" stroke-linecap="round"/>',
        '<text x="1080" y="50">blade (Z)</text>',
    ]
    style = "<style>text{font-family:sans-serif;font-size:26px;fill:#1f2933}.title{font-size:32px;font-weight:600}"
    style += ".grid{stroke:#dfe3e8;stroke-width:2}</style>"
    body = "".join([style, *parts, *words])
    save(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE[0]} {SIZE[1]}">{body}</svg>', "knife-table")


def cut() -> Iterator[tuple[float, float, float, bool]]:
    """X and Y in mm, the direction of the blade in degrees, whether it is down."""
    simulation = started("knife-table")
    was_down = False
    for number in range(6000):
        simulation.advance(MS)
        motion, down = simulation.unit.motion, bool(simulation.state()["outputs"] & 1)
        if was_down and not down:
            return
        was_down = was_down or down
        if number % 8 == 0:
            yield motion.reference(0) / 200, motion.reference(1) / 200, motion.reference(2) / 10, down


def press() -> None:
    """Three parts: the press turns, the strip rests and is fed, the output strikes."""
    simulation = started("press-feeder")
    simulation.advance(300 * MS)
    simulation.stimulus("type", "3\\r")
    rows = []
    for _ in range(1900):
        simulation.advance(MS)
        motion = simulation.unit.motion
        rows.append((motion.reference(0) / 10, motion.reference(1) / 40, simulation.state()["outputs"] & 1))
    turn, strip, strike = (np.array(column, dtype=float) for column in zip(*rows, strict=True))
    panels = [
        Panel("Press (X)", turn, "deg"),
        Panel("Strip (Y)", strip, "mm"),
        Panel("Output 1", strike, is_signal=True),
    ]
    svg = draw("The press feeder: three parts", np.arange(len(turn)) * 1000 / 1_024_000, panels)
    for small, large in ((13, 20), (19, 24), (12, 19)):  # the help shows the picture at less than half its size
        svg = svg.replace(f"font-size:{small}px", f"font-size:{large}px", 1)
    save(svg, "press-feeder")


def started(name: str) -> Simulation:
    """A shipped program running on the simulator."""
    document = files.load(resources.path(f"examples/{name}.tlp"))
    simulation = Simulation(model(document.setup.model))
    simulation.load_program(generate(document).text)
    simulation.execute(0)
    return simulation


def save(svg: str, name: str) -> None:
    """A drawing as a picture of the help."""
    image = QImage(*SIZE, QImage.Format.Format_RGB32)
    image.fill(Qt.GlobalColor.white)
    renderer = QSvgRenderer(QByteArray(svg.encode()))
    high = SIZE[0] * renderer.viewBoxF().height() / renderer.viewBoxF().width()
    painter = QPainter(image)
    renderer.render(painter, QRectF(0, (SIZE[1] - high) / 2, SIZE[0], high))
    painter.end()
    image.save(str(resources.path(f"help/pictures/{name}.png")))


def main() -> int:
    """Both pictures."""
    application = QApplication.instance() or QApplication([])
    table()
    press()
    del application
    return 0


if __name__ == "__main__":
    sys.exit(main())
