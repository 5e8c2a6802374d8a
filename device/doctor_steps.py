"""What to do next, for diagnoses of the connection doctor that are the same at every port."""

STRAIGHT = "a straight-through cable (a null-modem cable does not work with the main port)"
ECHOED = (
    "Look for a loop-back plug, or a cable that joins transmit and receive (pins 2 and 3).",
    "Look whether the other end of the cable is plugged into the controller's MAIN port.",
)
NO_CTS = (
    "Use a cable with RTS and CTS, or choose handshake “none” here.",
    "Set switch 5 (HSHK) of an SSC to OFF where the cable has no handshake lines.",
)
BEHIND_A_SOCKET = (
    "Is the controller behind it switched on, and plugged into the device server?",
    "Is the serial speed of the device server the one that the controller is set to?",
    "Is it the right address and port number?",
)
HELD = (
    "Is the controller switched on? Its power light must be lit.",
    f"Use {STRAIGHT}.",
    "The cable needs its handshake lines, or switch 5 (HSHK) of an SSC must be OFF.",
)
