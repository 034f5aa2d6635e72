"""A setting of Numba is changed for a block and no longer."""

import numba
import pytest

from beltdyn.kernel.fingerprint import setting


def test_a_setting_holds_within_the_block() -> None:
    before = numba.config.CACHE_DIR
    with setting("CACHE_DIR", "elsewhere"):
        assert numba.config.CACHE_DIR == "elsewhere"
    assert before == numba.config.CACHE_DIR


def test_it_comes_back_after_an_error() -> None:
    before = numba.config.CACHE_DIR
    with pytest.raises(ZeroDivisionError), setting("CACHE_DIR", "elsewhere"):
        raise ZeroDivisionError
    assert before == numba.config.CACHE_DIR
