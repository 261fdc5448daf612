"""Studies on top of designs: the paper's Section 7 and the record behind a report."""
