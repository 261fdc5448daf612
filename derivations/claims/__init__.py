"""What is claimed of each numbered equation: forms and residuals from the derivations, put side by side."""
