"""Design, prove and validate controllers for railway wheel slide protection."""
