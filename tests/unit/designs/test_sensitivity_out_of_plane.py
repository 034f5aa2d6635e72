"""Numbers that planar results do not depend on are no inputs."""

from beltdyn.designs.sensitivity import chosen_numbers
from beltdyn.model import loads
from beltdyn.parts.change import tolerances_of
from tests.unit.conftest import FATIGUE_DRIVE


def test_offsets_and_fatigue_data_are_no_inputs() -> None:
    offset = 'axial_offset = "1 ± 0.2 mm"\ntilt = ["0 ± 0.1 deg", 0.001]'
    drive = loads(FATIGUE_DRIVE.replace('diameter = "180 mm"', f'diameter = "180 ± 1 mm"\n{offset}'))
    tolerances = tolerances_of(drive)
    assert len(tolerances) == 3
    paths = [one.path for one in chosen_numbers(drive, None, tolerances)]
    assert "pulley[large].radius" in paths
    assert not [path for path in paths if "offset" in path or "tilt" in path or "fatigue" in path]
