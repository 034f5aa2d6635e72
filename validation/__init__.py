"""Comparisons with what others published and with other codes; no part of the installed package."""
