"""Checks on a region of slip and torque: common Lyapunov functions and invariant sets."""
