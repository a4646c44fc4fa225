"""What goes wrong for a reason that a user can see and mend."""


class ScreeError(Exception):
    """Results, decks or words that cannot be used; the text names what, and says why."""


class MissingError(ScreeError, KeyError):
    """A column, a field or a key that is not there; a KeyError, too, as of any dictionary."""

    __str__ = Exception.__str__  # a KeyError's is quoted


class ScreeWarning(UserWarning):
    """What was done otherwise than one may think."""
