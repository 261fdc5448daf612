"""The paper's Section 7 again: Table 10, its figures, its conclusions."""
