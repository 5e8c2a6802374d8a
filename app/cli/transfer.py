"""`twoletter download` and `upload`: programs to and from a controller."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import Any

from app.cli.failure import DONE, NO, Failure
from app.cli.line import TICK_S, connected, is_machine, result_of
from app.cli.sources import complete, errors_of, load_any, target, write_text
from device.api import Job


def waited(job: Job[Any], port: str) -> Any:
    """Waits for a job, shows how far it is, and gives it up when the user does."""
    shown = ""
    try:
        while not job.future.done():
            words = f"{job.phase} {round(job.fraction * 100)} %"
            if sys.stderr.isatty() and words != shown:
                print(f"\r{words:<40}", end="", file=sys.stderr, flush=True)
                shown = words
            time.sleep(TICK_S)
    except KeyboardInterrupt:
        job.cancel()
        raise
    finally:
        if shown:
            print(file=sys.stderr)
    return result_of(job.future, port, NO)


def download(options: argparse.Namespace) -> int:
    """Sends a program and reads it back; 1 when it could not be verified."""
    path = Path(options.file)
    loaded = load_any(path)
    complete(path, loaded.text, loaded.listing)
    if loaded.listing and (errors := errors_of(loaded.listing)):
        raise Failure(f"{path}: {errors[0]}")
    with connected(options) as controller:
        if is_machine(controller) and not options.control:
            raise Failure(f"{options.port}: downloading to a machine needs --control")
        done = waited(controller.download(loaded.text), options.port)
    print(done.sentence)
    return DONE if done.verified else NO


def upload(options: argparse.Namespace) -> int:
    """Reads the program of a controller."""
    output = target(options.output) if options.output else None
    if output and output.exists() and not options.force:
        raise Failure(f"{output} exists already (--force overwrites it)")
    with connected(options) as controller:
        text: str = waited(controller.upload(), options.port)
    text = text if not text or text.endswith("\n") else text + "\n"
    if output:
        write_text(output, text)
        print(f"{output}: {len(text.splitlines())} lines")
    else:
        sys.stdout.write(text)
    return DONE
