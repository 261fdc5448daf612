"""The checks by theme: each searches for what its theorem asks, and tells the verdict."""
