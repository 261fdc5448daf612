"""The trusted kernel: claims, interval arithmetic and the checkers that decide about a proof."""
