"""Studies that are ready to run, as files to copy and change."""

from __future__ import annotations

from importlib import resources

from thalweg.core.errors import unknown_name_error

_FOLDER = "ready"


def ready_studies() -> dict[str, str]:
    """Return the names of the ready studies, with what each shows.

    Returns
    -------
    dict of str to str
    """
    files = resources.files("thalweg.studies").joinpath(_FOLDER).iterdir()
    texts = {file.name.removesuffix(".yaml"): file.read_text("utf-8") for file in files}
    return {name: texts[name].partition("\n")[0].lstrip("# ") for name in sorted(texts)}


def ready_study(name: str) -> str:
    """Return a ready study as the text of a study file.

    Parameters
    ----------
    name : str
        One of `ready_studies`.

    Returns
    -------
    str

    Raises
    ------
    InputError
        For an unknown name, with near matches.
    """
    names = list(ready_studies())
    if name not in names:
        raise unknown_name_error("ready study", name, names)
    return resources.files("thalweg.studies").joinpath(f"{_FOLDER}/{name}.yaml").read_text("utf-8")
