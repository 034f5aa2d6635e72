"""What every part of a drive is made of: validated fields in SI units, error messages, text and table files."""
