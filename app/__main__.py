"""Where the program starts: `twoletter`."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence


def main(argv: Sequence[str] | None = None) -> int:
    """Does one call and returns its exit code; errors are one line on standard error."""
    from app.cli.failure import DONE, UNUSABLE, Failure
    from app.cli.parser import CALLS

    arguments = list(sys.argv[1:] if argv is None else argv)
    try:
        if any(word in CALLS for word in arguments[:1]):
            from app.cli.calls import call

            return call(arguments)
        from app.cli.studio import open_studio

        return open_studio(arguments)
    except Failure as failure:
        print(f"twoletter: {failure}", file=sys.stderr)
        return failure.code
    except BrokenPipeError:
        # Whoever read our output has closed it; nothing is left to say, also not at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except KeyboardInterrupt:
        return UNUSABLE
    except SystemExit as ended:
        return ended.code if isinstance(ended.code, int) else UNUSABLE


if __name__ == "__main__":
    sys.exit(main())
