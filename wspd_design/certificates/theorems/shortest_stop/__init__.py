"""The shortest stop of any controller, from the peaks of adhesion."""
