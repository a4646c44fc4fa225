"""What goes wrong for a reason that a user can see and mend."""


class ScreeError(Exception):
    """Results or words that cannot be used; the text names what, and says why."""
