"""The one error that a user can cause and mend."""


class UserError(ValueError):
    """Wrong input, told in one sentence: what, where, value, allowed, remedy."""
