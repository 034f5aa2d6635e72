from pathlib import Path

import pytest
from matplotlib.animation import FFMpegWriter
from PIL import Image, ImageSequence

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.show import plot


def test_gif_moves(tmp_path: Path, run: Run) -> None:
    path = plot.animate(run, tmp_path / "run.gif", frames=3)
    with Image.open(path) as image:
        pictures = [frame.convert("RGB").tobytes() for frame in ImageSequence.Iterator(image)]
    assert len(set(pictures)) == 3
    assert list(tmp_path.iterdir()) == [path]


def shown(path: Path) -> int:
    with Image.open(path) as image:
        return sum(1 for _ in ImageSequence.Iterator(image))


def test_a_part_of_the_time(tmp_path: Path, run: Run) -> None:
    """Fields are recorded with every output here, at 101 instants of 1 s."""
    assert shown(plot.animate(run, tmp_path / "run.gif", start=0.5, end=0.54)) == 5
    with pytest.raises(ModelError, match=r"no output along the belt from 2 to 3 s; there are outputs from 0 to 1 s"):
        plot.animate(run, tmp_path / "run.gif", start=2.0, end=3.0)


def test_a_number_of_pictures_for_each_turn(tmp_path: Path, run: Run) -> None:
    turned = run.dataset["pulley_angle"][:, 0].values / 6.283185307179586
    until = float(run.dataset["time"][10])
    path = plot.animate(run, tmp_path / "slow.gif", end=until, per_turn=10)
    assert shown(path) == pytest.approx(10 * turned[10], abs=1.0)
    with pytest.raises(ModelError, match="1000 pictures per turn need more outputs along the belt"):
        plot.animate(run, tmp_path / "slow.gif", per_turn=1000)


@pytest.mark.skipif(not FFMpegWriter.isAvailable(), reason="ffmpeg is not installed")
def test_mp4(tmp_path: Path, run: Run) -> None:
    assert plot.animate(run, tmp_path / "run.mp4", frames=3).stat().st_size > 0


def test_mp4_without_ffmpeg_is_a_model_error(tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FFMpegWriter, "isAvailable", lambda: False)
    with pytest.raises(ModelError, match=r"MP4 needs the program ffmpeg.*beltdyn\[video\]"):
        plot.animate(run, tmp_path / "run.mp4")


@pytest.mark.parametrize("name", ["run.avi", "run"])
def test_other_formats_are_model_errors(tmp_path: Path, run: Run, name: str) -> None:
    with pytest.raises(ModelError, match=r"Use \.gif or \.mp4"):
        plot.animate(run, tmp_path / name)


@pytest.mark.parametrize("name", ["missing/run.gif", "folder.gif"])
def test_unwritable_path_is_a_model_error(tmp_path: Path, run: Run, name: str) -> None:
    (tmp_path / "folder.gif").mkdir()
    with pytest.raises(ModelError, match="cannot be written"):
        plot.animate(run, tmp_path / name, frames=2)
    assert [path.name for path in tmp_path.iterdir()] == ["folder.gif"]
