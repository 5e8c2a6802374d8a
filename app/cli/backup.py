"""`twoletter backup` and `restore`: everything a controller holds, into one readable file and back."""

from __future__ import annotations

import argparse
from datetime import datetime
from pathlib import Path

from app.cli.failure import DONE, NO, Failure
from app.cli.line import connected, is_machine
from app.cli.sources import target
from app.cli.transfer import waited
from codegen.disk import FileUnreadable
from codegen.files import load_setup, setup_dumps
from device.api import Controller, Job
from device.backing_up import Restored, backup_steps, restore_steps
from device.backup import Backup, load, save
from device.backup_kept import controller_name, keep
from device.backup_words import names
from device.tasks import Priority


def backed_up(controller: Controller, port: str, note: str = "", setup: str = "", reason: str = "") -> Backup:
    """Everything this controller holds."""
    job: Job[Backup] = Job()
    steps = backup_steps(controller, job, note, port, setup=setup, reason=reason)
    job.future = controller.run(steps, Priority.DOWNLOAD, "download")
    found: Backup = waited(job, port)
    return found


def setup_text(path: str | None) -> str:
    """The setup that is kept in the file as well."""
    if path is None:
        return ""
    try:
        return setup_dumps(load_setup(path))
    except FileUnreadable as reason:
        raise Failure(str(reason)) from None
    except OSError as reason:
        raise Failure(f"{path}: {(reason.strerror or str(reason)).lower()}") from None


def backup(options: argparse.Namespace) -> int:
    """Reads a controller and writes the file; changes nothing in the controller."""
    output = target(options.output)
    if output.exists() and not options.force:
        raise Failure(f"{output} exists already (--force overwrites it)")
    setup = setup_text(options.setup)
    with connected(options) as controller:
        found = backed_up(controller, options.port, options.note, setup)
    save(output, found)
    lines = len(found.program.splitlines())
    print(
        f"{output}: {found.model}, {len(found.parameters)} parameters, program of {lines} lines, "
        f"{len(found.variables)} variables, {len(found.arrays)} arrays"
    )
    if found.not_read:
        print(f"not in it, because the controller does not tell it: {names(found.not_read)}")
    return DONE


def restore(options: argparse.Namespace) -> int:
    """Puts a backup into a controller; 1 when anything there is not as in the backup afterwards."""
    from app.settings import data_folder

    try:
        wanted = load(options.file)
    except FileUnreadable as reason:
        raise Failure(str(reason)) from None
    with connected(options) as controller:
        if is_machine(controller) and not options.control:
            raise Failure(f"{options.port}: restoring a machine needs --control")
        kept = before(controller, options.port, data_folder() / "backups") if is_machine(controller) else None
        job: Job[Restored] = Job()
        job.future = controller.run(restore_steps(controller, wanted, job), Priority.DOWNLOAD, "download")
        done: Restored = waited(job, options.port)
    if kept is not None:
        print(f"what was in the controller before is kept in {kept}")
    for text in (*done.refused, *done.left):
        print(text)
    print(done.sentence)
    return DONE if done.complete else NO


def before(controller: Controller, port: str, folder: Path) -> Path:
    """Keeps what is about to be overwritten."""
    found = backed_up(controller, port, reason="before a restore")
    return keep(folder / controller_name(found.model, controller.identity), found, datetime.now())
