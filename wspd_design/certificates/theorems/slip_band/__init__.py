"""The band of slip that a sampled law with friction-torque observer keeps: numbers, proofs and their checker."""
