"""Search for invariant sets of slip and torque."""
