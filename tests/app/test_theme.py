"""Both themes: every token in both, contrast as the rules of accessibility have it (AA: 4.5 : 1), icons complete."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QColor, QIcon
from PySide6.QtWidgets import QApplication

import resources
from app.actions import ROWS
from app.theme import Choice, Theme, make_look, read_table, style_sheet
from widgets.parts.icons import icon

TABLE = read_table()
GROUNDS = ("window", "surface", "raised")
INKS = [name for name in TABLE["light"] if name.startswith(("code_", "group_", "axis_"))] + [
    "text", "quiet", "accent", "fault", "warning", "ok", "stale",
]  # fmt: skip


def luminance(colour: str) -> float:
    """Relative luminance as WCAG 2.1 defines it."""
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    red, green, blue = (part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one: str, other: str) -> float:
    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def test_contrast_of_black_on_white_is_21() -> None:
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("ink", INKS)
def test_every_ink_is_readable_on_every_ground(theme: str, ink: str) -> None:
    colours = TABLE[theme]
    for ground in GROUNDS:
        assert contrast(colours[ink], colours[ground]) >= 4.5, (ink, ground)


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize(
    ("ink", "ground"),
    [
        ("accent_text", "accent"), ("stop_text", "stop"), ("selection_text", "selection"),
        ("warning", "warning_ground"),
        ("text", "executing"), ("text", "selection"), ("quiet", "selection"), ("code_command", "executing"),
    ],
)  # fmt: skip
def test_text_on_coloured_grounds_is_readable(theme: str, ink: str, ground: str) -> None:
    assert contrast(TABLE[theme][ink], TABLE[theme][ground]) >= 4.5


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_borders_and_focus_stand_out_from_the_ground(theme: str) -> None:
    colours = TABLE[theme]
    for ground in ("window", "surface"):
        assert contrast(colours["border"], colours[ground]) >= 3.0
        assert contrast(colours["focus"], colours[ground]) >= 3.0


def test_both_themes_have_the_same_tokens() -> None:
    assert TABLE["light"].keys() == TABLE["dark"].keys()


@pytest.mark.parametrize("dark", [False, True])
def test_the_style_sheet_has_no_token_left_open(dark: bool) -> None:
    sheet = style_sheet(TABLE, make_look(TABLE, dark))
    assert "{" in sheet
    for token in (*TABLE["light"], *TABLE["space"], "icons", "name"):
        assert "{" + token + "}" not in sheet


def test_only_stop_and_fault_are_red() -> None:
    for theme in ("light", "dark"):
        for name, text in TABLE[theme].items():
            colour = QColor(text)
            red = colour.hslSaturation() > 120 and (colour.hslHue() < 8 or colour.hslHue() > 345)
            assert not red or name in ("stop", "fault", "code_error"), f"{theme} {name}"


def test_switching_themes_recolours_text_and_icons(qapp: QApplication) -> None:
    theme = Theme(qapp, Choice.LIGHT)
    save = icon("save")
    light = ink_of(save)
    theme.choose(Choice.DARK)
    assert qapp.palette().windowText().color().name() == TABLE["dark"]["text"]
    dark = ink_of(save)
    theme.choose(Choice.LIGHT)
    assert light == TABLE["light"]["text"]
    assert dark == TABLE["dark"]["text"]
    assert ink_of(save) == light


def ink_of(picture: QIcon) -> str:
    """The colour of the most opaque pixel."""
    image = picture.pixmap(QSize(48, 48)).toImage()
    pixels = (image.pixelColor(x, y) for x in range(0, 48, 1) for y in range(0, 48, 1))
    return max(pixels, key=lambda pixel: pixel.alpha()).name()


@pytest.mark.parametrize("name", sorted(path.stem for path in resources.path("icons").glob("*.svg")))
def test_every_icon_draws_something(qapp: QApplication, name: str) -> None:
    Theme(qapp, Choice.LIGHT)
    image = icon(name).pixmap(QSize(32, 32)).toImage()
    assert any(image.pixelColor(x, y).alpha() > 100 for x in range(32) for y in range(32))


def test_an_unknown_icon_is_loud() -> None:
    with pytest.raises(KeyError):
        icon("no such icon")


def test_every_action_row_has_an_icon_that_exists() -> None:
    for row in ROWS:
        assert not row.icon or resources.path(f"icons/{row.icon}.svg").is_file(), row.name
