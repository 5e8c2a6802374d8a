"""A controller that does not say what it is: the person is asked once, and the answer is kept by its serial number."""

from __future__ import annotations

from functools import partial

from app.connection import Connection
from app.run import Ask
from app.settings import Settings
from codegen.models import MODELS
from device.api import Controller, Kind, State

WORDS = (
    "The controller answers, but its version text is not one that is known here. Which type is it? "
    "Until that is said, no live values are read."
)


class WhichModel:
    """`look` is called with each tick; it asks once for every connection."""

    def __init__(self, connection: Connection, settings: Settings, ask: Ask) -> None:
        self._connection, self._settings, self._ask = connection, settings, ask
        self._asked: Controller | None = None

    def look(self) -> None:
        """Asks when a machine is there whose type is not known."""
        controller = self._connection.controller
        unknown = controller.kind is Kind.MACHINE and controller.state is State.READY and controller.model is None
        if not unknown or controller is self._asked:
            return
        self._asked = controller
        names = [name for name, model in MODELS.items() if model.family != "smartmotor"]
        answers = [(name.upper(), partial(self._chosen, controller, name)) for name in names]
        self._ask("Which controller is this?", WORDS, answers)

    def _chosen(self, controller: Controller, name: str) -> None:
        serial = controller.choose_model(name)
        if serial is not None:
            self._settings.set("known_models", {**self._settings.get("known_models"), str(serial): name})


def known_models(settings: Settings) -> dict[int, str]:
    """Types of controllers that were told before, by serial number; what does not fit is left out."""
    kept = settings.get("known_models")
    return {int(serial): name for serial, name in kept.items() if serial.isdigit() and name in MODELS}
