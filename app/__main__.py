"""Where the program starts: `twoletter`."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Sequence


def done(arguments: list[str], is_call: bool) -> int:
    """Does one call, or opens the studio."""
    if is_call:
        from app.cli.calls import call

        return call(arguments)
    gc.disable()  # what loads now stays; looking for garbage among it costs a tenth of the start
    from app.quick import spare_reading

    spare_reading()
    from app.cli.studio import open_studio

    return open_studio(arguments)


def let_go_of_output() -> None:
    """Standard output cannot be written any more; what is left in its buffer is dropped, also at exit."""
    try:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (OSError, ValueError):
        return


def main(argv: Sequence[str] | None = None) -> int:
    """Does one call and returns its exit code; errors are one line on standard error."""
    from app.cli.failure import DONE, UNUSABLE, Failure
    from app.cli.parser import CALLS

    arguments = list(sys.argv[1:] if argv is None else argv)
    try:
        code = done(arguments, bool(arguments) and arguments[0] in CALLS)
        sys.stdout.flush()
        return code
    except Failure as failure:
        print(f"twoletter: {failure}", file=sys.stderr)
        return failure.code
    except BrokenPipeError:
        let_go_of_output()
        return DONE
    except OSError as problem:
        let_go_of_output()
        print(f"twoletter: {(problem.strerror or str(problem)).lower()}", file=sys.stderr)
        return UNUSABLE
    except KeyboardInterrupt:
        return UNUSABLE
    except SystemExit as ended:
        return ended.code if isinstance(ended.code, int) else UNUSABLE


if __name__ == "__main__":
    sys.exit(main())
