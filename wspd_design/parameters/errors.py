"""The root of all errors of this package, and the one error that a user can cause and mend."""


class WspdError(Exception):
    """Any error that this package raises on purpose."""


class UserError(WspdError, ValueError):
    """Wrong input, told in one sentence: what, where, value, allowed, remedy."""
