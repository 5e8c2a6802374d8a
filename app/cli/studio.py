"""Opens the studio, or says why there is no window."""

from __future__ import annotations

import os
import shlex
import shutil
import socket
import sys
from pathlib import Path

from app.cli.failure import UNUSABLE, Failure
from app.cli.parser import studio_parser
from codegen.models import MODELS

NO_DISPLAY = "no display to open a window on; run the headless demo with:"
HEADLESS_PLATFORMS = ("offscreen", "minimal", "vnc")


def answers(display: str) -> bool:
    """Whether an X server of this computer answers; one of another computer is believed to."""
    host, _, number = display.rpartition(":")
    if host not in ("", "unix") or not hasattr(socket, "AF_UNIX"):
        return True
    path = f"/tmp/.X11-unix/X{number.split('.')[0]}"
    for address in (path, f"\0{path}"):
        with socket.socket(socket.AF_UNIX) as probe:
            if probe.connect_ex(address) == 0:
                return True
    return False


def display_is_there() -> bool:
    """Whether a window could open: always tried on Windows and macOS, a display server elsewhere."""
    if sys.platform in ("win32", "darwin"):
        return True
    if os.environ.get("QT_QPA_PLATFORM", "").split(":")[0] in HEADLESS_PLATFORMS:
        return True
    if os.environ.get("WAYLAND_DISPLAY"):
        return True
    display = os.environ.get("DISPLAY", "")
    return bool(display) and answers(display)


def way_to_connect(simulator: str | None, port: str | None, offline: bool) -> str:
    """How the studio connects, as `app.studio` takes it."""
    if simulator is not None:
        if simulator and simulator not in MODELS:
            raise Failure(f"no controller model {simulator} (there are {', '.join(MODELS)})")
        return f"simulator:{simulator}" if simulator else "simulator"
    if port:
        return f"port:{port}"
    return "offline" if offline else "ask"


def own_name() -> str:
    """How this command is called from where the person stands."""
    name = sys.argv[0]
    return (
        "twoletter" if shutil.which("twoletter") or Path(name).suffix == ".py" else shlex.quote(os.path.relpath(name))
    )


def open_studio(arguments: list[str]) -> int:
    """`twoletter [FILE] …`"""
    options = studio_parser().parse_args(arguments)
    connect = way_to_connect(options.simulator, options.port, options.offline)
    path = Path(options.file) if options.file else None
    if path and not path.exists():
        raise Failure(f"{path}: no such file, and no such call")
    if not display_is_there():
        raise Failure(f"{NO_DISPLAY} {own_name()} demo", UNUSABLE)
    try:
        from app.studio import run_studio
    except ImportError as missing:
        raise Failure(
            f"the windows cannot be loaded ({missing}); run ./studio, it installs what is missing"
        ) from missing

    return run_studio(path, connect)
