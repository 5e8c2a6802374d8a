"""The tuner's mathematics, as `app.tuner_model` runs it in a thread of its own, and its results in words."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TypeVar

from device.tuning.bench import Excited
from device.tuning.design import Design, Refusal, Target, design, propose
from device.tuning.excite import NotIdentified
from device.tuning.identify import Estimate, identify
from device.tuning.loop import Bode, Gains, Margins, bode, margins
from device.tuning.metrics import AT_LIMIT, Response, percent
from device.tuning.predict import predict, step

T = TypeVar("T")
HERTZ = 6.283185307179586  # rad/s
BEFORE = 12  # samples at rest before a predicted step


@dataclass(frozen=True, eq=False)
class Proposal:
    """What a target comes to: gains with their margins and predicted step, or why not."""

    target: Target | None
    gains: Gains | None
    margins: Margins | None
    bode: Bode | None
    predicted: Response | None
    words: str

    def foresees(self, counts: int, torque: float) -> bool:
        """Whether it is the step of this size with this torque limit that was predicted."""
        if self.predicted is None or self.gains is None:
            return False
        return self.predicted.commanded[-1] == counts and abs(self.gains.torque_limit - torque) < AT_LIMIT


def estimated(excited: Excited) -> Estimate | NotIdentified:
    """What an excitation tells of the axis."""
    if isinstance(excited.recording, NotIdentified):
        return excited.recording
    return identify((excited.recording,))


def proposed(
    estimate: Estimate, target: Target | None, period: float, keep: Gains, counts: int, seconds: float
) -> Proposal:
    """Gains for a target (none: a sound one), and the step they will give."""
    plant = estimate.plant
    wanted = target or propose(plant, period, keep)
    if wanted is None:
        return Proposal(None, None, None, None, None, "No crossover can be reached with this axis; tune it by hand.")
    found = design(plant, wanted, period, keep)
    if isinstance(found, Refusal):
        near = found.nearest_target
        words = f" The nearest that can be reached: {near.crossover / HERTZ:.3g} Hz, {near.phase:.0f}°." if near else ""
        shown = found.nearest.gains if found.nearest is not None else keep
        return Proposal(
            wanted, None, margins(plant, shown, period), bode(plant, shown, period), None, found.reason + words
        )
    return _good(estimate, wanted, found, period, counts, seconds)


def first_proposed(
    estimate: Estimate, before: Target | None, period: float, keep: Gains, counts: int, seconds: float
) -> Proposal:
    """After an identification: the target of last time, where it can still be reached, else a sound one."""
    if before is not None:
        found = proposed(estimate, before, period, keep, counts, seconds)
        if found.gains is not None:
            return found
    sound = proposed(estimate, None, period, keep, counts, seconds)
    if before is None:
        return sound
    told = f"The target of last time, {before.crossover / HERTZ:.3g} Hz with {before.phase:.0f}°, cannot be reached."
    return replace(sound, words=f"{told} {sound.words}".strip())


def _good(estimate: Estimate, wanted: Target, found: Design, period: float, counts: int, seconds: float) -> Proposal:
    commanded = step(counts, max(round(seconds / period), 2), at=BEFORE)
    return Proposal(
        wanted, found.gains, found.margins, bode(estimate.plant, found.gains, period),
        predict(estimate.plant, found.gains, commanded, period), " ".join(found.notes),
    )  # fmt: skip


def again(
    estimate: Estimate, proposal: Proposal, period: float, counts: int, torque: float, seconds: float
) -> Proposal:
    """The same gains for another step, or with another torque limit."""
    assert proposal.gains is not None
    gains = replace(proposal.gains, torque_limit=torque)
    commanded = step(counts, max(round(seconds / period), 2), at=BEFORE)
    return replace(proposal, gains=gains, predicted=predict(estimate.plant, gains, commanded, period))


def estimate_words(estimate: Estimate) -> str:
    """The axis in a few lines: what its gain, friction, weight, delay and resonance are, and how sure that is."""
    plant, sigma = estimate.plant, estimate.sigma

    def told(name: str, value: float, unit: str, scale: float = 1.0) -> str:
        return f"{with_spread(value * scale, (sigma.get(name) or 0.0) * scale)} {unit}"

    parts = [f"One volt gives {told('gain', plant.gain, 'counts/s²')}"]
    if plant.pole:
        parts.append(f"friction pole {told('pole', plant.pole, 'rad/s')}")
    if plant.coulomb:
        parts.append(f"dry friction {told('coulomb', plant.coulomb, 'V')}")
    if abs(plant.gravity) > 0.01:
        parts.append(f"weight {told('gravity', plant.gravity, 'V')}")
    if plant.delay:
        parts.append(f"delay {told('delay', plant.delay, 'ms', 1000.0)}")
    if plant.resonance is not None:
        parts.append(f"first resonance {told('frequency', plant.resonance.frequency, 'Hz')}")
    mode = " It answers like a drive in velocity mode." if plant.velocity_mode else ""
    notes = f" {' '.join(estimate.notes)}" if estimate.notes else ""
    return f"{', '.join(parts)}. {percent(estimate.fit)} of the motion is explained.{mode}{notes}"


def with_spread(value: float, spread: float) -> str:
    """`312 000 ± 900`: as many digits as the spread leaves of it (two of the spread), at most four."""
    if not value:
        return "0"
    places = 3 - math.floor(math.log10(abs(value)))
    if spread > 0.0:
        places = min(places, 1 - math.floor(math.log10(spread)))

    def text(number: float) -> str:
        return f"{round(number, places):,.{max(places, 0)}f}".replace(",", " ")

    return text(value) + (f" ± {text(spread)}" if round(spread, places) else "")


def estimate_data(estimate: Estimate) -> dict[str, float | str]:
    """As the logbook keeps it."""
    plant = estimate.plant
    data: dict[str, float | str] = {
        "gain": plant.gain, "pole": plant.pole, "coulomb": plant.coulomb, "gravity": plant.gravity,
        "delay": plant.delay, "fit": estimate.fit, "words": estimate_words(estimate),
    }  # fmt: skip
    if plant.resonance is not None:
        data["resonance"] = plant.resonance.frequency
    return data
