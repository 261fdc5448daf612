"""The mended adaptive fuzzy law: what its weights keep, and whether the sector of its valve is narrow enough."""
