"""Exit codes of ``wspd``."""

GOOD = 0
REFUTED = 1
WRONG_USE = 2
UNDECIDED = 3
BUG = 70  # as in sysexits.h, so that a fault of the program is not taken for a verdict
INTERRUPTED = 130
