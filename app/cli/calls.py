"""Which function does which call."""

from __future__ import annotations

import importlib

from app.cli.parser import calls_parser

# Imported only when called: `twoletter check` must not wait for the simulator.
DOES = {
    "demo": "app.cli.demo",
    "compile": "app.cli.compile",
    "check": "app.cli.check",
    "import": "app.cli.importing",
    "run": "app.cli.run",
    "simulate": "app.cli.simulate",
    "terminal": "app.cli.terminal",
    "download": "app.cli.transfer",
    "upload": "app.cli.transfer",
    "backup": "app.cli.backup",
    "restore": "app.cli.backup",
    "conform": "app.cli.conforming",
    "ports": "app.cli.ports",
    "doctor": "app.cli.doctor",
}


def call(arguments: list[str]) -> int:
    """Reads the arguments and does the call; its exit code."""
    options = calls_parser().parse_args(arguments)
    function = getattr(importlib.import_module(DOES[options.call]), options.call.replace("import", "import_source"))
    code: int = function(options)
    return code
