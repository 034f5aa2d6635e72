from pathlib import Path

import pytest
from matplotlib.animation import FFMpegWriter
from PIL import Image, ImageSequence

from beltdyn import plot
from beltdyn.errors import ModelError
from beltdyn.results import Run


def test_gif_moves(tmp_path: Path, run: Run) -> None:
    path = plot.animate(run, tmp_path / "run.gif", frames=3)
    with Image.open(path) as image:
        pictures = [frame.convert("RGB").tobytes() for frame in ImageSequence.Iterator(image)]
    assert len(set(pictures)) == 3
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(not FFMpegWriter.isAvailable(), reason="ffmpeg is not installed")
def test_mp4(tmp_path: Path, run: Run) -> None:
    assert plot.animate(run, tmp_path / "run.mp4", frames=3).stat().st_size > 0


def test_mp4_without_ffmpeg_is_a_model_error(tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FFMpegWriter, "isAvailable", lambda: False)
    with pytest.raises(ModelError, match="MP4 needs the program ffmpeg"):
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
