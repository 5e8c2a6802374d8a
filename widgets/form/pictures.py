"""What stands beside a form: a live picture or a list to pick from, by the name of the instruction; most have none."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtWidgets import QWidget

from widgets.form.command_list import CommandList
from widgets.form.curve_picture import CurvePicture
from widgets.form.offers import Offers
from widgets.form.path_picture import PathPicture

PICTURES: Mapping[str, Callable[[Offers], QWidget]] = {
    "TwoLetterCode": CommandList,
    "CircularPath": PathPicture,
    "TangentPath": PathPicture,
    "LinearPath": PathPicture,
    "ElectronicCam": CurvePicture,
    "ContourMode": CurvePicture,
}
