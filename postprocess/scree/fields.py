"""Names of fields that everything reads."""

POSITION = "position"
