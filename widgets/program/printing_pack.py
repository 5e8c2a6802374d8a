"""The handover pack: program, code, setup, names, limits, gains and a checklist, as one set of pages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape

from PySide6.QtGui import QTextDocument

from codegen.document import Document
from codegen.fields import Context, fields_of, is_shown
from codegen.models import MODELS
from codegen.setup_differences import NOT_SET
from widgets.program.printing import code_html, make_pages, program_html
from widgets.program.words import Words

AXIS_PARTS = (
    ("Setup", ("unit", "counts_per_unit", "motor", "main_encoder", "aux_encoder")),
    ("Limits", ("forward_limit", "reverse_limit", "error_limit", "off_on_error", "torque_limit", "maximum_speed",
                "maximum_acceleration")),
    ("Gains", ("kp", "ki", "kd", "fv", "fa", "integrator_limit", "offset", "smoothing")),
)  # fmt: skip
SPACE = "<p style='font-size: 5pt'>&nbsp;</p>"
CHECKS = (
    "Emergency stop: takes the power from the drives, independent of controller and computer",
    "Supply and earthing of controller and drives as in the wiring plan",
    "Encoders count upwards in the direction that is called forward (X and every other axis)",
    "Each motor turns the right way and holds; tried with a low torque limit first",
    "Forward and reverse limit switches stop each axis in their direction",
    "Software limits lie inside the limit switches; following error limit and motor off on error are on",
    "Home is found from both sides and repeats",
    "Inputs and outputs carry the names of this pack and do what they say",
    "Program run slowly, without material, from start to end",
    "Program run at full speed; the times are those that were agreed",
    "Program burned; after a power failure the machine comes up as it should",
    "Setup written to the EEPROM",
    "File, controller and EEPROM compared: the same",
    "Back-up of the controller taken and handed over with the program file",
    "Operator and maintenance instructed",
)


def pack_pages(document: Document, words: Words, date: str, proof: Sequence[str] = ()) -> QTextDocument:
    """Everything somebody needs who takes the machine over; `proof` is what a comparison with it has shown."""
    parts = [
        _cover(document, date, proof),
        _chapter("Program", program_html(document, words)),
        _chapter("Code", code_html(words)),
        *(_chapter(title, _axes(document, names), new=number == 0) for number, (title, names) in enumerate(AXIS_PARTS)),
        _chapter("Inputs and outputs", _names(document), new=False),
        _chapter("Checklist", _checklist()),
    ]
    return make_pages("".join(parts), document)


def _chapter(title: str, html: str, new: bool = True) -> str:
    brk = " style='page-break-before: always'" if new else ""
    return f"<h1{brk}>{escape(title)}</h1>{html}"


def _cover(document: Document, date: str, proof: Sequence[str]) -> str:
    program, setup, handover = document.program, document.setup, document.handover
    controller = MODELS[setup.model].title if setup.model in MODELS else setup.model
    rows = [
        ("Program", program.name or "without a name"),
        ("What it does", program.description),
        ("Revision", handover.revision),
        ("Date of the revision", handover.date),
        ("Author", handover.author),
        ("Machine", setup.name),
        ("Controller", f"{controller}{f', serial number {setup.serial_number}' if setup.serial_number else ''}"),
        ("Printed", date),
    ]
    table = "".join(
        f"<tr><td class='quiet' width='28%'>{escape(name)}</td><td>{escape(text)}</td></tr>"
        for name, text in rows
        if text
    )
    changes = f"{SPACE}<h2>Changes</h2><p>{_lines(handover.changes)}</p>" if handover.changes.strip() else ""
    notes = f"{SPACE}<h2>Notes</h2><p>{_lines(document.notes)}</p>" if document.notes.strip() else ""
    proved = f"{SPACE}<h2>Compared with the controller</h2><p>{_lines(chr(10).join(proof))}</p>" if proof else ""
    title = escape(program.name or "Program")
    facts = f"<table width='100%' cellspacing='0' cellpadding='3'>{table}</table>"
    return f"<h1>Handover: {title}</h1>{facts}{changes}{notes}{proved}"


def _lines(text: str) -> str:
    return "<br/>".join(escape(line) for line in text.splitlines())


def _axes(document: Document, names: Sequence[str]) -> str:
    """A row for each value, a column for each axis."""
    setup = document.setup
    if setup.model not in MODELS:
        return ""
    head = "".join(f"<td><b>{letter}</b></td>" for letter in setup.letters)
    rows = "".join(_axis_row(document, name) for name in names)
    return f"<table width='100%' cellspacing='0' cellpadding='3'><tr><td></td>{head}</tr>{rows}</table>"


def _axis_row(document: Document, name: str) -> str:
    setup = document.setup
    cells = []
    label = ""
    for letter in setup.letters:
        axis = setup.axis(letter)
        field, value = fields_of(axis)[name], getattr(axis, name)
        label = field.label
        if not is_shown(axis, name):
            text = "–"
        elif isinstance(value, bool):
            text = "yes" if value else "no"
        elif field.empty(value):
            text = NOT_SET
        else:
            text = field.text(value, Context(setup, letter))
        cells.append(f"<td width='18%'>{escape(text)}</td>")
    return f"<tr><td class='quiet' width='28%'>{escape(label)}</td>{''.join(cells)}</tr>"


def _names(document: Document) -> str:
    setup = document.setup
    if setup.model not in MODELS:
        return ""
    both = (("Input", setup.input_names, setup.inputs), ("Output", setup.output_names, setup.outputs))
    return "".join(
        f"{SPACE}<h2>{what}s</h2><table width='100%' cellspacing='0' cellpadding='3'>"
        f"{''.join(_channels(what, names[:count]))}</table>"
        for what, names, count in both
    )


def _channels(what: str, names: Sequence[str]) -> Iterator[str]:
    for number, name in enumerate(names):
        yield f"<tr><td class='quiet' width='28%'>{what} {number + 1}</td><td>{escape(name) or '–'}</td></tr>"


def _checklist() -> str:
    rows = "".join(
        f"<tr><td width='4%'>☐</td><td width='72%'>{escape(each)}</td><td class='quiet'>____________________</td></tr>"
        for each in CHECKS
    )
    signed = "<p>&nbsp;</p><p>Date, name and signature of who hands over: ______________________________</p>"
    taken = "<p>Date, name and signature of who takes over: ______________________________</p>"
    return f"<table width='100%' cellspacing='4'>{rows}</table>{signed}{taken}"
