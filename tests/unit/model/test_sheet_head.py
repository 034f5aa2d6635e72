"""Customer, position and order of a drive, for its sheets."""

import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive, dumps, loads


def test_the_head_is_kept_with_the_drive_and_in_files(drive: Drive) -> None:
    headed = drive.replace(sheet={"customer": "Mill & Söhne", "order": "4711"})
    assert headed.sheet.entries == (("Customer", "Mill & Söhne"), ("Order", "4711"))
    assert loads(dumps(headed)).sheet == headed.sheet
    assert headed.with_({"sheet.position": "K-101"}).sheet.position == "K-101"
    assert drive.sheet.entries == ()
    assert "sheet" not in drive.arguments or not drive.sheet.arguments


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"client": "Mill"}, "sheet.client is not a known key"),
        ({"customer": "two\nlines"}, "sheet.customer"),
        ({"customer": ""}, "sheet.customer"),
        ({"order": 4711}, "sheet.order"),
    ],
)
def test_other_keys_and_values_are_refused(drive: Drive, keys: dict[str, object], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        drive.replace(sheet=keys)


def test_the_head_does_not_change_results(drive: Drive) -> None:
    headed = drive.replace(sheet={"customer": "Mill"})
    assert bd.model.install(headed).tension == bd.model.install(drive).tension
