"""The questions that lead to a design file, and the ways to ask them."""
