"""Deprecated names still work, with a warning that gives the new name."""

from __future__ import annotations

import warnings
from importlib import import_module

import pytest

from thalweg.deprecated_names import MOVED, RENAMED, renamed_arguments

OLD = [
    (module, name, new)
    for table in (MOVED, RENAMED)
    for module, names in table.items()
    for name, new in names.items()
]


@pytest.mark.parametrize(("module", "name", "new"), OLD)
def test_an_old_name_gives_the_new_object_and_a_warning(module, name, new):
    with pytest.warns(DeprecationWarning, match=new[1]):
        found = getattr(import_module(module), name)
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        assert found is getattr(import_module(new[0]), new[1])


def test_names_that_never_were_are_refused():
    with pytest.raises(AttributeError, match="no attribute 'never'"):
        getattr(import_module("thalweg.search"), "never")  # noqa: B009
    with pytest.raises(ModuleNotFoundError):
        import_module("thalweg.search.never")


def test_an_argument_may_be_given_by_its_old_name_once():
    @renamed_arguments(most_wait="max_wait")
    def wait(*, max_wait):
        return max_wait

    with pytest.warns(DeprecationWarning, match="max_wait"):
        assert wait(most_wait=3.0) == 3.0
    with pytest.raises(TypeError, match="both"):
        wait(most_wait=3.0, max_wait=4.0)
