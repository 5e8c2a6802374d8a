"""Reads the files a call works on: programs (.tlp), source (.dmc, .txt) and machine setups (.tls)."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path

from app.cli.failure import Failure
from codegen.document import Document
from codegen.files import FileUnreadable, load, load_setup
from codegen.generate import Listing, generate
from codegen.models import MODELS, Model, model
from codegen.read import cannot
from codegen.setup import Setup

DEFAULT_MODEL = "ssc4"


@dataclass(frozen=True)
class Loaded:
    """A file ready to be checked, run or downloaded: its two-letter text, and what it came from."""

    path: Path
    text: str
    model: Model
    setup: Setup
    document: Document | None = None
    listing: Listing | None = None

    @property
    def stimulus(self) -> str:
        """What the program's file says happens outside, as CSV; empty when nothing."""
        return self.document.stimulus if self.document else ""


def sentence(problem: OSError) -> str:
    """The reason of the operating system, without its number."""
    return (problem.strerror or str(problem)).lower()


def read_text(path: Path) -> str:
    """A text file, whatever its encoding."""
    try:
        data = path.read_bytes()
    except OSError as problem:
        raise Failure(f"{path}: {sentence(problem)}") from problem
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def write_text(path: Path, text: str, force: bool = True) -> None:
    """Writes a text file; an existing one only where that is wanted."""
    if path.exists() and not force:
        raise Failure(f"{path} exists already (--force overwrites it)")
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as problem:
        raise Failure(f"{path}: {sentence(problem)}") from problem


def is_program(path: Path) -> bool:
    """Whether a file is a visual program."""
    return path.suffix.lower() == ".tlp"


def read_document(path: Path) -> Document:
    """A visual program."""
    try:
        return load(path)
    except FileUnreadable as problem:
        raise Failure(str(problem) if path.name in str(problem) else f"{path}: {problem}") from problem
    except OSError as problem:
        raise Failure(f"{path}: {sentence(problem)}") from problem


def read_setup(path: str | None) -> Setup | None:
    """A machine setup, where one is given."""
    if path is None:
        return None
    try:
        return load_setup(Path(path))
    except FileUnreadable as problem:
        raise Failure(str(problem)) from problem
    except OSError as problem:
        raise Failure(f"{path}: {sentence(problem)}") from problem


def errors_of(listing: Listing) -> list[str]:
    """What stops steps from becoming code, one sentence each."""
    return [finding.message for finding in listing.problems if finding.severity == "error"]


def fitted(document: Document, setup: Setup | None, controller: str | None, path: Path) -> Document:
    """The document with another setup or controller; refused when the program does not fit that controller."""
    wanted = setup or document.setup
    if controller:
        wanted = dataclasses.replace(wanted, model=controller)
    of_two_letters(wanted.model, path)
    fitting = dataclasses.replace(document, setup=wanted)
    reasons = [cannot(type(step.instruction), wanted) for step in fitting.program.steps() if step.enabled]
    known = errors_of(generate(document))
    reasons += [message for message in errors_of(generate(fitting)) if message not in known]
    if found := [reason for reason in reasons if reason]:
        raise Failure(f"{path}: the program does not fit {wanted.model}: {found[0]}")
    return fitting


def complete(loaded: Loaded) -> None:
    """Refuses a program in which a step could not become code; what the checker finds is no reason."""
    for line in loaded.listing.lines if loaded.listing else ():
        if line.problem:
            raise Failure(f"{loaded.path}: a step is not finished: {line.problem}")


def of_two_letters(name: str, path: Path) -> Model:
    """The controller's model; SmartMotor source is another language."""
    if name == "smartmotor" or path.suffix.lower() == ".sms":
        raise Failure(f"{path}: SmartMotor code can not be written, checked or run yet")
    return model(name)


def load_any(path: Path, controller: str | None = None, setup_path: str | None = None) -> Loaded:
    """A program or source with its controller and setup."""
    setup = read_setup(setup_path)
    if is_program(path):
        document = read_document(path)
        if setup or controller:
            document = fitted(document, setup, controller, path)
        listing = generate(document)
        chosen = of_two_letters(document.setup.model, path)
        return Loaded(path, listing.text, chosen, document.setup, document, listing)
    text = read_text(path)
    name = controller or (setup.model if setup else DEFAULT_MODEL)
    chosen = of_two_letters(name, path)
    return Loaded(path, text, chosen, dataclasses.replace(setup or Setup(), model=name))


def known_models() -> str:
    """The names of all controllers, for messages."""
    return ", ".join(MODELS)
