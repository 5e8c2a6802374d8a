"""The line to a controller's port 2, as an operator terminal has it: bytes out, bytes in, nothing understood."""

from __future__ import annotations

import threading
from collections.abc import Callable

from device.transport import LineSettings, OpenFailed, Transport, TransportLost

LINE = LineSettings(baud=9600)  # recommended for the terminal (dmc-1412-1414.txt l.5318)
MOST_WAITING = 256  # characters kept while the line takes none


class SecondPort:
    """Opened beside the caller's thread; `pump` moves what is there, never waits, and is called with every tick."""

    def __init__(self, opener: Callable[[], Transport]) -> None:
        self.text = "Opening…"
        self.open = False
        self.failed = False
        self._opener = opener
        self._transport: Transport | None = None
        self._reason = ""
        self._unwanted = False
        self._waiting = bytearray()
        self._thread: threading.Thread | None = threading.Thread(target=self._open, name="port 2", daemon=True)
        self._thread.start()

    def _open(self) -> None:
        try:
            found = self._opener()
        except OpenFailed as reason:
            self._reason = str(reason)
            return
        if self._unwanted:
            found.close()
        else:
            self._transport = found

    def send(self, data: bytes) -> bool:
        """Keys that were pressed; False when the line takes no more."""
        if not self.open or len(self._waiting) + len(data) > MOST_WAITING:
            return False
        self._waiting += data
        return True

    def pump(self) -> bytes:
        """What has come; sends what waits."""
        if self._thread is not None:
            if self._thread.is_alive():
                return b""
            self._thread.join()
            self._thread = None
            self.open, self.failed = self._transport is not None, self._transport is None
            self.text = self._reason if self._transport is None else self._transport.description
        if self._transport is None:
            return b""
        try:
            if self._waiting:
                del self._waiting[: self._transport.write(bytes(self._waiting))]
            return self._transport.read(0.0)
        except TransportLost as reason:
            self.close()
            self.failed, self.text = True, str(reason)
            return b""

    def close(self) -> None:
        """Ends it; an opening on its way ends by itself."""
        self._unwanted = True
        self.open, self.text = False, "Not connected"
        transport, self._transport = self._transport, None
        if transport is not None:
            transport.close()
