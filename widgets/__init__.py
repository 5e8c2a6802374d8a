"""Qt views; they show frozen values and emit what the user did."""
