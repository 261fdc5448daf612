"""Speed of the train as a wheel slide protection knows it: told, or worked out from the wheels."""
