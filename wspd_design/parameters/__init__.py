"""Numbers with unit, source, status and bounds."""
