"""Search for the ellipsoids of a band of slip."""
