"""The error of a domain on which the model does not hold."""

from wspd_design.parameters.errors import UserError


class OutsideModel(UserError):
    """The claim cannot be examined, because the model does not hold there."""
