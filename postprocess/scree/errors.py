"""Errors and warnings with a cause that a user can see and remove."""


class ScreeError(Exception):
    """Results, decks or arguments that cannot be used; the text names them and the reason."""


class MissingError(ScreeError, KeyError):
    """A missing column, field or key; also a KeyError, as of any dictionary."""

    __str__ = Exception.__str__  # KeyError adds quotes


class ScreeWarning(UserWarning):
    """Something was done differently than may be expected."""
