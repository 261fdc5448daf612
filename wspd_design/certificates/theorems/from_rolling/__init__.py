"""Whether wheels that come from rolling settle in a proved band of slip, whole cells of numbers at once."""
