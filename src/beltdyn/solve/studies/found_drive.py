"""The drive file that a study has found, beside its result file."""

from pathlib import Path

from beltdyn.errors import ModelError
from beltdyn.results.atomic import atomic_path, require_replaceable, target_of
from beltdyn.results.dataset import is_result

_MARK = "# Found by `beltdyn "


def headed(text: str, analysis: str) -> str:
    """The text of a drive with a first line that tells where it comes from.

    Parameters
    ----------
    text
        TOML.
    analysis
        Name of the command.
    """
    return f"{_MARK}{analysis}`.\n{text.removeprefix(_first_line(text))}"


def found_file(output: Path) -> Path:
    """The drive file beside a result file."""
    return output.with_suffix(".toml")


def require_free(output: Path, overwrite: bool, study: object) -> None:
    """Make sure that a result file and the drive file beside it would replace nothing but such.

    Parameters
    ----------
    output
        The result file.
    overwrite
        Whether any regular files may be replaced.
    study
        The study, which stays.

    Raises
    ------
    ModelError
        If they would.
    """
    if isinstance(study, Path | str) and target_of(found_file(output)) == target_of(Path(study)):
        raise ModelError(
            f"the optimised drive would be written to {found_file(output)}, which is the study file. Choose "
            "another result file."
        )
    require_replaceable(output, is_result, overwrite)
    require_replaceable(found_file(output), _is_found, overwrite)


def write_found(output: Path, text: str, overwrite: bool) -> None:
    """Write the drive file beside a result file.

    Parameters
    ----------
    output
        The result file.
    text
        From `headed`.
    overwrite
        Replace any regular file.
    """
    with atomic_path(found_file(output), _is_found, overwrite) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _first_line(text: str) -> str:
    """The first line if it is ours."""
    line = text.partition("\n")[0]
    return f"{line}\n" if line.startswith(_MARK) else ""


def _is_found(path: Path) -> bool:
    """Tell whether a drive file was written by a study."""
    with path.open("rb") as file:
        return file.read(len(_MARK)) == _MARK.encode()
