"""What every theorem speaks about: the domain, the plant on it, and the law in the loop."""
