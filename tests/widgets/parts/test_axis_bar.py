"""The bar of an axis: places on it follow from the limits, or from what was seen where there are none."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Iterator

import pytest
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QApplication

from app.theme import Choice, Theme
from widgets.parts.axis_bar import LINE, AxisBar, Marks
from widgets.parts.look import look

TABLE = Marks(low=-50.0, high=200.0, actual=75.0, commanded=75.0, unit="mm", decimals=3)


@pytest.fixture
def bar(qapp: QApplication) -> Iterator[AxisBar]:
    worn = Theme(qapp, Choice.LIGHT)
    made = AxisBar("X")
    made.resize(300, 40)
    yield made
    made.deleteLater()
    worn.release()


def colours(bar: AxisBar, x: float) -> set[QColor]:
    """Around a place on the line."""
    image = bar.grab().toImage()
    ratio = image.devicePixelRatio()
    return {
        image.pixelColor(round((x + across) * ratio), round((LINE + down) * ratio)).name()
        for across in range(-6, 7)
        for down in range(-6, 7)
    }


def test_places_lie_between_the_posts_in_proportion(bar: AxisBar) -> None:
    bar.show_marks(TABLE)
    left, right = bar.place_of(-50.0), bar.place_of(200.0)
    assert bar.place_of(75.0) == pytest.approx((left + right) / 2)
    assert bar.place_of(0.0) == pytest.approx(left + (right - left) / 5)  # 50 of 250 mm
    assert bar.place_of(-50.1) < left and bar.place_of(200.1) > right  # behind the posts, never between them
    assert look().axis("X").name() in colours(bar, bar.place_of(75.0))


def test_a_mark_behind_a_limit_wears_the_colour_of_a_warning(bar: AxisBar) -> None:
    bar.show_marks(dc.replace(TABLE, actual=201.0, commanded=201.0))
    assert look().colour("warning").name() in colours(bar, bar.place_of(201.0))
    bar.show_marks(dc.replace(TABLE, actual=199.0, commanded=199.0))
    assert look().colour("warning").name() not in colours(bar, bar.place_of(199.0))


def test_without_limits_round_numbers_grow_with_what_was_seen_and_stay(bar: AxisBar) -> None:
    free = dc.replace(TABLE, low=math.nan, high=math.nan)
    bar.show_marks(dc.replace(free, actual=3.0, commanded=3.0))
    assert bar.span() == (-1.0, 5.0)
    bar.show_marks(dc.replace(free, actual=-12.0, commanded=-12.0))
    assert bar.span() == (-20.0, 5.0)
    bar.show_marks(dc.replace(free, actual=0.0, commanded=0.0))
    assert bar.span() == (-20.0, 5.0)  # the picture stands still
    bar.show_marks(dc.replace(TABLE, low=math.nan))
    assert bar.span() == (-20.0, 200.0)  # one limit


def test_the_picture_as_a_sentence(bar: AxisBar) -> None:
    bar.show_marks(dc.replace(TABLE, ghost=80.5, latch=12.0))
    assert bar.words() == (
        "X: at 75.000 mm, commanded 75.000 mm, stops at 80.500 mm, latched at 12.000 mm, "
        "reverse limit -50.000 mm, forward limit 200.000 mm"
    )
    bar.show_marks(Marks())
    assert bar.words() == "X: no soft limits"
