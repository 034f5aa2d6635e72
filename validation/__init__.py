"""Comparisons with what others published and with other codes; no part of the installed package."""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")  # threads of linear algebra wait for each other on a busy machine
