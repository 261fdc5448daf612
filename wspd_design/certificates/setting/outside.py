"""What to do where the model does not hold."""

from wspd_design.parameters.errors import UserError


class OutsideModel(UserError):
    """The claim cannot be examined, because the model does not hold there."""
