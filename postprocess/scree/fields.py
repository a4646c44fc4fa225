"""Names of fields that all modules use."""

POSITION = "position"
