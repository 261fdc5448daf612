"""Results as plain data for other programs: one vocabulary of keys, its forms and their JSON Schemas."""
