"""Invariant sets of the sampled loop: what one sample has to map into itself."""
