"""Captures as files: CSV for every spreadsheet, NumPy for calculating; both come back exactly, with setup and units."""

from __future__ import annotations

import io
import json
import math
import re
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from codegen.disk import FileUnreadable, save_text
from codegen.files import setup_dumps, setup_loads
from codegen.models import MODELS
from device.bits import Signal
from device.capture import BY_NAME, SLOWEST, Capture, Channel
from device.capture import channels as recorded_by
from device.waves import levels, of_capture

FORMAT, VERSION = "twoletter capture", 2
EVEN = 1  # the version whose values follow each other evenly; live ones bring their times, older programs say so
CSV, NUMPY = ".csv", ".npz"
MARK = "# "
NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")  # not all that float() takes is one here
DAMAGE = (zipfile.BadZipFile, zlib.error, KeyError, ValueError, OSError, EOFError, NotImplementedError, MemoryError)
PLAIN = ("on", "1")
DIVIDES = re.compile(r"[,;\"\s]+")  # cells of a line, or lines
CHANGED = "changed, as a spreadsheet does when it saves; open the file as it was saved here"
MOST = 1_000_000  # values of a channel; no controller holds as many


def save(path: str | Path, capture: Capture) -> None:
    """Writes a file of the kind its name ends with; a crash leaves an old one whole."""
    path = Path(path)
    if path.suffix.lower() == NUMPY:
        written = path.with_name(path.name + ".new")
        written.write_bytes(packed(capture))
        written.replace(path)
    else:
        save_text(path, dumps(capture))


def load(path: str | Path) -> Capture:
    """Opens either kind; FileUnreadable says in one sentence what is wrong with it."""
    path = Path(path)
    try:
        data = path.read_bytes()
    except OSError as reason:
        raise FileUnreadable(f"{path.name} cannot be opened: {(reason.strerror or str(reason)).lower()}") from None
    try:
        return unpacked(data) if data[:2] == b"PK" else loads(data.decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise FileUnreadable(f"{path.name} is not a capture (it is not text)") from None
    except FileUnreadable as reason:
        raise FileUnreadable(f"{path.name} is not a capture: {reason}") from None


def dumps(capture: Capture) -> str:
    """The text of a CSV file: what it is, a line of names, then one line for each moment.

    Every channel stands there as the controller counts it and, where that is another number, in the user's unit; of
    inputs, outputs and switches each bit has a column behind.
    """
    names, columns = ["time s"], [capture.times]
    for channel in capture.channels:
        own = "counts" if channel.row.dimension == "position" else "V" if channel.row.dimension == "voltage" else ""
        names.append(f"{channel.label} {own}".strip())
        columns.append(capture.of(channel))
    for channel in capture.channels:
        scale, unit = capture.scale(channel)
        if scale != 1.0:
            names.append(f"{channel.label} {unit}")
            columns.append(capture.of(channel) / scale)
    for channel in capture.channels:
        for signal in of_capture(capture, channel):
            names.append(_heading(signal))
            columns.append(levels(capture.of(channel), signal.bit))
    about = json.dumps(_about(capture) | {"columns": names}, ensure_ascii=False)
    lines = [MARK + about, ",".join(names)]
    lines += [",".join(map(_text, row)) for row in zip(*(column.tolist() for column in columns), strict=True)]
    return "\n".join(lines) + "\n"


def loads(text: str) -> Capture:
    """A capture from the text of its file; FileUnreadable says what is wrong in it."""
    lines = text.splitlines()
    if not lines or not lines[0].startswith(MARK + "{"):
        if lines and FORMAT in lines[0]:
            raise FileUnreadable(f"its first line was {CHANGED}")
        raise FileUnreadable("it does not begin with the line that says so")
    about = _about_of(lines[0][len(MARK) :])
    channels = _channels(about)
    heads = lines[1].split(",") if len(lines) > 1 else []
    if len(heads) < 1 + len(channels) or heads != about.get("columns", heads):  # moved ones would be mistaken
        raise FileUnreadable(f"line 2, the names of its columns, is missing or was {CHANGED}")
    rows, columns_there = [], len(heads)
    for number, line in enumerate(lines[2:], 3):
        cells = line.split(",")
        if len(cells) != columns_there:  # a decimal comma would make two numbers of one
            raise FileUnreadable(f"line {number} has {len(cells)} numbers, {columns_there} belong there")
        rows.append([_number(cell, number) for cell in cells[: 1 + len(channels)]])
    columns = np.ascontiguousarray(np.array(rows, dtype=np.float64).reshape(len(rows), 1 + len(channels)).T)
    return _capture(about, channels, columns[1:], columns[0])


def packed(capture: Capture) -> bytes:
    """What a NumPy file of it holds."""
    whole = io.BytesIO()
    about = np.array(json.dumps(_about(capture), ensure_ascii=False))
    np.savez_compressed(whole, about=about, times=capture.times, values=capture.values)
    return whole.getvalue()


def unpacked(data: bytes) -> Capture:
    """A capture from what its NumPy file holds; FileUnreadable says what is wrong in it."""
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as file:
            about, values = _about_of(str(file["about"])), np.asarray(file["values"])
            times = np.asarray(file["times"])
    except DAMAGE:
        raise FileUnreadable("it is damaged") from None
    channels = _channels(about)
    if values.dtype != np.float64 or values.ndim != 2 or len(values) != len(channels):
        raise FileUnreadable("its values do not fit its channels")
    return _capture(about, channels, values, times)


# ------------------------------------------------------------------------ details


def _heading(signal: Signal) -> str:
    """What a bit is called, and what its 1 means where that is not plain; without what divides a table."""
    on = signal.bit.words[1]
    means = "" if on in PLAIN else f" (1: {on})"
    return " ".join(DIVIDES.sub(" ", signal.label).split()) + means


def _text(number: float) -> str:
    """The shortest that reads back as the same number; whole ones without a point, unread ones empty."""
    if math.isnan(number):
        return ""
    return str(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)


def _number(cell: str, line: int) -> float:
    if not cell.strip():
        return math.nan
    text = cell.strip()
    found = float(text) if NUMBER.fullmatch(text) else math.inf
    if math.isinf(found):
        raise FileUnreadable(f"line {line}: “{cell.strip()[:20]}” is not a number")
    return found


def _about(capture: Capture) -> dict[str, Any]:
    return {
        "format": FORMAT,
        "version": EVEN if capture.moments is None else VERSION,
        "channels": [[channel.what, channel.axis] for channel in capture.channels],
        "exponent": capture.exponent,
        "tm": capture.tm,
        "count": capture.count,
        "trigger": capture.trigger,
        "early": capture.early,
        "trigger_text": capture.trigger_text,
        "model": capture.model,
        "controller": capture.controller,
        "when": capture.when,
        "complete": capture.complete,
        "note": capture.note,
        "setup": json.loads(setup_dumps(capture.setup)) if capture.setup is not None else None,
    }


def _about_of(text: str) -> dict[str, Any]:
    try:
        about = json.loads(text)
    except (ValueError, RecursionError):
        raise FileUnreadable(f"its first line cannot be read: it was cut off, or {CHANGED}") from None
    if not isinstance(about, dict) or about.get("format") != FORMAT:
        raise FileUnreadable("it does not say that it is one")
    if about.get("version") not in (EVEN, VERSION):
        raise FileUnreadable(f"a newer program wrote it (version {about.get('version')}, this one knows {VERSION})")
    return about


def _channels(about: dict[str, Any]) -> tuple[Channel, ...]:
    found = []
    listed = about.get("channels")
    for each in listed if isinstance(listed, list) else []:
        texts = [text for text in each if isinstance(text, str)] if isinstance(each, list) else []
        if len(texts) != 2 or len(each) != 2 or texts[0] not in BY_NAME or texts[1] not in ("", *"XYZW"):
            raise FileUnreadable(f"it names a channel that there is not ({each})")
        found.append(Channel(*texts))
    if not found or len(set(found)) < len(found):
        raise FileUnreadable("it names no channels, or one twice")
    model = about.get("model")
    there = recorded_by(MODELS[model]) if isinstance(model, str) and model in MODELS else found
    strange = next((each.label for each in found if each not in there), "")
    if strange:
        raise FileUnreadable(f"it names {strange}, which a controller of its type ({model}) does not record")
    return tuple(found)


def _capture(
    about: dict[str, Any], channels: tuple[Channel, ...], values: np.ndarray[Any, Any], times: np.ndarray[Any, Any]
) -> Capture:
    count = _whole(about, "count", 0, MOST)
    if values.shape[1] != count:
        raise FileUnreadable(f"{values.shape[1]} values of each channel are there, {count} were saved")
    tm = about.get("tm")
    if not isinstance(tm, int | float) or isinstance(tm, bool) or not 0 < abs(tm) <= MOST:
        raise FileUnreadable("its sample time is not a number")
    model = about.get("model")
    texts = {name: about.get(name) for name in ("trigger_text", "controller", "when", "note")}
    if not all(isinstance(text, str) for text in (model, *texts.values())) or (model and model not in MODELS):
        raise FileUnreadable("what it says about itself cannot be read")
    setup = about.get("setup")
    if not isinstance(setup, dict | None):
        raise FileUnreadable("its setup cannot be read")
    capture = Capture(
        channels=channels,
        values=values,
        exponent=_whole(about, "exponent", 1, SLOWEST),
        tm=float(tm),
        trigger=_whole(about, "trigger", -MOST, MOST),
        early=_whole(about, "early", 0, MOST),
        model=str(model),
        complete=bool(about.get("complete")),
        setup=setup_loads(json.dumps(setup)) if setup is not None else None,
        moments=_moments(times, count) if about["version"] > EVEN else None,
        **{name: str(text) for name, text in texts.items()},
    )
    if times.shape != (count,) or not np.allclose(times, capture.times, rtol=1e-9, atol=1e-9):
        raise FileUnreadable(
            "its times do not follow each other as they were captured: its lines were moved or changed"
        )
    return capture


def _moments(times: np.ndarray[Any, Any], count: int) -> np.ndarray[Any, Any]:
    if times.dtype != np.float64 or times.shape != (count,) or not np.isfinite(times).all():
        raise FileUnreadable("its times are no numbers")
    if (np.diff(times) <= 0).any():
        raise FileUnreadable("its times do not follow each other")
    return times


def _whole(about: dict[str, Any], name: str, low: int, high: int) -> int:
    found = about.get(name)
    if not isinstance(found, int) or isinstance(found, bool) or not low <= found <= high:
        raise FileUnreadable(f"its {name} is not a number from {low} to {high}")
    return found
