"""`twoletter terminal`: typed lines to a controller, its answers and messages back."""

from __future__ import annotations

import argparse
import queue
import sys
import threading
import time
from concurrent.futures import Future

from app.cli.failure import DONE
from app.cli.line import TICK_S, connected, is_machine
from device.api import Controller, NoticeKind, Reply
from device.tasks import LinkError

LAST_MESSAGES_S = 0.3
FROM_PROGRAMS = (NoticeKind.MESSAGE, NoticeKind.PROMPT)
WELCOME = "Ctrl-C sends STOP (it is not an emergency stop), Ctrl-D or an empty file ends"


def read_lines(lines: queue.Queue[str | None]) -> None:
    """Hands over typed lines; None at the end."""
    for line in sys.stdin:
        lines.put(line.rstrip("\r\n"))
    lines.put(None)


def show_notices(controller: Controller) -> None:
    """Prints what programs say; what happens to the connection goes to standard error."""
    for notice in controller.notices():
        if notice.kind in FROM_PROGRAMS:
            print(notice.text, flush=True)
        elif notice.kind is not NoticeKind.STOP:
            print(f"twoletter: {notice.text}", file=sys.stderr, flush=True)


def shown(future: Future[Reply]) -> None:
    """Prints one answer: data, or why it was refused."""
    try:
        reply = future.result()
    except LinkError as problem:
        print(f"! {problem}", flush=True)
        return
    if reply.text:
        print(reply.text, flush=True)
    if not reply.accepted:
        print(f"? {reply.reason}".rstrip(), flush=True)


def send(controller: Controller, line: str) -> Future[Reply] | None:
    """One typed line: the answer to a prompt, or a command."""
    if controller.pending_prompt is not None:
        controller.answer(line)
        return None
    return controller.ask(line)


def talk(controller: Controller, lines: queue.Queue[str | None]) -> None:
    """Sends lines one after the other until they end."""
    asked: Future[Reply] | None = None
    ended = False
    while not ended or asked:
        show_notices(controller)
        if asked and asked.done():
            shown(asked)
            asked = None
        if asked is None and not ended:
            try:
                line = lines.get(timeout=TICK_S)
            except queue.Empty:
                continue
            if line is None:
                ended = True
            elif line.strip():
                asked = send(controller, line)
        elif asked:
            time.sleep(TICK_S / 10)


def terminal(options: argparse.Namespace) -> int:
    """Talks until the input ends."""
    lines: queue.Queue[str | None] = queue.Queue()
    with connected(options) as controller:
        if sys.stdin.isatty():
            print(WELCOME, file=sys.stderr)
            if is_machine(controller) and not controller.control:
                print("Watch: only reading is possible; --control enables the rest", file=sys.stderr)
        threading.Thread(target=read_lines, args=(lines,), daemon=True).start()
        while True:
            try:
                talk(controller, lines)
                break
            except KeyboardInterrupt:
                controller.stop()
                print(controller.stop_state, file=sys.stderr)
        end = time.monotonic() + LAST_MESSAGES_S
        while time.monotonic() < end:
            show_notices(controller)
            time.sleep(TICK_S)
    return DONE
