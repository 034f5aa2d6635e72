"""Building blocks of the parts of a drive: validated fields in SI units, error messages, text and table files."""
