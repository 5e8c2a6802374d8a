"""The commissioning report of tuned axes: gains, response, estimate and note of every run, as pages of paper."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from html import escape

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt, QUrl
from PySide6.QtGui import QColor, QImage, QPainter, QPen, QPolygonF, QTextDocument

from codegen.document import Document
from codegen.setup import Setup
from device.tuning.entry import TITLES, Entry, gains_words
from device.tuning.metrics import Response
from widgets.display.readings import unit_of
from widgets.parts.units import scale_of
from widgets.program.printing import make_pages
from widgets.tuner.results import metrics_words

WIDTH, HEIGHT, SCALE = 600, 200, 3  # of a picture on the page in px, and how much finer it is drawn
LEFT, RIGHT, TOP, BOTTOM = 64, 8, 10, 28


def report_pages(setup: Setup, entries: Sequence[Entry], controller: str, date: str) -> QTextDocument:
    """The runs, oldest first, each with its picture."""
    heading = escape(f"{setup.name or setup.limits.title}: commissioning of the servo axes")
    parts = [
        f"<h1>{heading}</h1>",
        f"<p class='quiet'>{escape(controller)} · {escape(date)}</p>",
        _table(entries),
    ]
    for entry in entries:
        parts.append(_section(setup, entry))
    pages = make_pages("", Document(setup=setup))
    size = pages.pageSize()
    for entry in entries:
        image = picture(entry.response, scale_of(setup.axis(entry.axis)), unit_of(setup.axis(entry.axis)))
        pages.addResource(QTextDocument.ResourceType.ImageResource.value, QUrl(f"run-{entry.number}"), image)
    pages.setHtml("".join(parts))
    pages.setMetaInformation(QTextDocument.MetaInformation.DocumentTitle, "Commissioning report")
    pages.setPageSize(size)
    return pages


def _table(entries: Sequence[Entry]) -> str:
    rows = "".join(
        f"<tr><td>{entry.number}</td><td>{escape(entry.axis)}</td><td>{escape(TITLES.get(entry.method, ''))}</td>"
        f"<td>{escape(entry.when.replace('T', ' '))}</td><td class='code'>{escape(gains_words(entry.gains))}</td>"
        f"<td>{escape(_settled(entry))}</td></tr>"
        for entry in entries
    )
    head = "".join(f"<td><b>{each}</b></td>" for each in ("Run", "Axis", "Method", "When", "Gains", "Settled"))
    return f"<br/><table width='100%' cellspacing='0' cellpadding='2'><tr>{head}</tr>{rows}</table><br/>"


def _settled(entry: Entry) -> str:
    metrics = entry.metrics
    return "–" if metrics is None or metrics.settling_time is None else f"{metrics.settling_time * 1000:.0f} ms"


def _section(setup: Setup, entry: Entry) -> str:
    axis, what = setup.axis(entry.axis), "Move" if entry.method == "move" else "Step"
    step = f"{entry.step / scale_of(axis):.4g} {unit_of(axis)}"
    told = [
        f"{what} of {step} ({entry.step} counts) with {gains_words(entry.gains)}; "
        f"torque limit {entry.gains.torque_limit:.4g} V.",
        metrics_words(entry.metrics),
        entry.words if entry.method in ("automatic", "move") else "",
        str(entry.estimate.get("words", "")),
        str(entry.estimate.get("loop", "")),
    ]
    note = f"<p><i>{escape(entry.note)}</i></p>" if entry.note else ""
    words = "<br/>".join(escape(each) for each in told if each)
    return (
        f"<h2>Run {entry.number}, axis {escape(entry.axis)}: {escape(TITLES.get(entry.method, ''))}</h2><p>{words}</p>"
        f"{note}<p><img src='run-{entry.number}' width='{WIDTH}' height='{HEIGHT}'/></p>"
    )


def picture(response: Response, scale: float, unit: str) -> QImage:
    """Commanded (grey) and actual position over time, black on white, for paper."""
    image = QImage(WIDTH * SCALE, HEIGHT * SCALE, QImage.Format.Format_RGB32)
    image.fill(Qt.GlobalColor.white)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.scale(SCALE, SCALE)
    font = painter.font()
    font.setPixelSize(10)
    painter.setFont(font)
    begin = int(np.argmax(response.commanded != response.commanded[0]))  # time counts from the step
    times = (np.arange(len(response.actual)) - max(begin - 1, 0)) * response.period * 1000.0
    actual, commanded = response.actual / scale, response.commanded / scale
    low, high = float(min(actual.min(), commanded.min())), float(max(actual.max(), commanded.max()))
    room = (high - low) * 0.06 or 1.0
    low, high = low - room, high + room
    frame = QRectF(LEFT, TOP, WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM)
    first, last = float(times[0]), float(times[-1])

    def at(time: float, value: float) -> QPointF:
        x = frame.left() + frame.width() * (time - first) / ((last - first) or 1.0)
        return QPointF(x, frame.bottom() - frame.height() * (value - low) / (high - low))

    _grid(painter, frame, at, (first, last), (low, high), unit)
    for values, colour, width in ((commanded, "#777777", 1.0), (actual, "#0067a8", 1.6)):
        painter.setPen(QPen(QColor(colour), width))
        painter.drawPolyline(QPolygonF([at(float(t), float(v)) for t, v in zip(times, values, strict=True)]))
    painter.end()
    return image


def _grid(
    painter: QPainter,
    frame: QRectF,
    at: Callable[[float, float], QPointF],
    times: tuple[float, float],
    places: tuple[float, float],
    unit: str,
) -> None:
    right, centre = Qt.AlignmentFlag.AlignRight, Qt.AlignmentFlag.AlignHCenter
    for number, time in enumerate(ticks := round_numbers(*times)):
        x = at(time, places[0]).x()
        painter.setPen(QPen(QColor("#dddddd"), 0.6))
        painter.drawLine(QPointF(x, frame.top()), QPointF(x, frame.bottom()))
        painter.setPen(QColor("#333333"))
        label = f"{time:.4g}" + (" ms" if number == len(ticks) - 1 else "")
        painter.drawText(QRectF(x - 40, frame.bottom() + 3, 80, 14), centre, label)
    for number, place in enumerate(ticks := round_numbers(*places)):
        y = at(times[0], place).y()
        painter.setPen(QPen(QColor("#dddddd"), 0.6))
        painter.drawLine(QPointF(frame.left(), y), QPointF(frame.right(), y))
        painter.setPen(QColor("#333333"))
        told = f"{place:.4g}" + (f" {unit}" if number == len(ticks) - 1 else "")
        painter.drawText(QRectF(0, y - 7, LEFT - 4, 14), right, told)


def round_numbers(low: float, high: float, most: int = 6) -> list[float]:
    """At most so many round numbers within a range: 1, 2 or 5 of a decade apart."""
    decade = 10.0 ** math.floor(math.log10((high - low) / most))
    apart = next(decade * each for each in (1.0, 2.0, 5.0, 10.0) if (high - low) / (decade * each) <= most)
    return [number * apart for number in range(math.ceil(low / apart), math.floor(high / apart) + 1)]
