"""Files that hold an ensemble along one dimension."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from thalweg.core.errors import DatasetError
from thalweg.sea.ensemble_layer import combine_member_layers
from thalweg.sea.files.file_contents import layer_candidates
from thalweg.sea.files.layer_candidate import (
    FileContents,
    LayerCandidate,
    OpenedFile,
    PlacementCache,
)
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.layer import Layer

#: names of the dimension; one with the standard name "realization" is recognised too
MEMBER_DIMENSIONS: Final = (
    "number", "member", "members", "ensemble", "ensemble_member", "realization", "realisation",
    "ens", "nens",
)  # fmt: skip


def ensemble_file(file: OpenedFile) -> EnsembleFile | None:
    """Return the file as an ensemble of two or more members, or None if it holds none.

    Raises
    ------
    DatasetError : If there are two such dimensions.
    """
    dataset = file.dataset
    members = [
        str(dim)
        for dim, size in dataset.sizes.items()
        if size > 1 and _is_member_dimension(dataset, str(dim)) and _has_fields(dataset, dim)
    ]
    if len(members) > 1:
        raise DatasetError(
            f"{file.source} holds an ensemble along {' and along '.join(members)}.",
            "The members must be along one dimension.",
            "Stack them into one dimension, or select one index along one of them.",
            file=file.source,
        )
    return EnsembleFile(file, members[0], PlacementCache(), []) if members else None


def _is_member_dimension(dataset: Any, dim: str) -> bool:
    standard = dataset[dim].attrs.get("standard_name") if dim in dataset.variables else None
    return standard == "realization" or dim.lower() in MEMBER_DIMENSIONS


def _has_fields(dataset: Any, dim: Any) -> bool:
    """Return whether a variable has other dimensions than this one."""
    return any(dim in dataset[n].dims and dataset[n].ndim > 1 for n in dataset.data_vars)


@dataclass(frozen=True, eq=False)
class EnsembleFile:
    """A file and the dimension along which it holds an ensemble.

    Attributes
    ----------
    placement_cache : Positions and meshes, which are the same for every member.
    shared : The candidates of the first member; those that do not vary are used for all.
    """

    file: OpenedFile
    dim: str
    placement_cache: PlacementCache
    shared: list[LayerCandidate]

    @property
    def size(self) -> int:
        """Number of members."""
        return int(self.file.dataset.sizes[self.dim])

    def candidates(self, index: int, mapping: Mapping[str, str]) -> FileContents:
        """Return the contents for one member; fields without members are shared by all."""
        whole = self.file
        one = replace(
            whole,
            dataset=whole.dataset.isel({self.dim: index}),
            source=f"{whole.source}, member {index}",
            facts={**whole.facts, "member": index},
        )
        candidates, ignored = layer_candidates(one, mapping, self.placement_cache)
        if not self.shared:
            self.shared.extend(replace(d, file=whole) for d in candidates)
        kept = [d if self._varies(d) else s for d, s in zip(candidates, self.shared)]
        return kept, ignored

    def _varies(self, candidate: LayerCandidate) -> bool:
        names = {v.name for quantity in candidate.quantities for v in quantity.variables}
        return any(self.dim in self.file.dataset[name].dims for name in names)


def check_member_counts(files: Sequence[EnsembleFile]) -> int:
    """Return the number of members of each of the files.

    Raises
    ------
    DatasetError : If the numbers differ.
    """
    sizes = {one.size for one in files}
    if len(sizes) > 1:
        listed = ", ".join(f"{one.file.source} {one.size}" for one in files)
        raise DatasetError(
            f"The files hold ensembles of different sizes: {listed}.",
            "Member i of each file belongs to member i of the others.",
            "Open them separately, or select the same number of members of each.",
        )
    return sizes.pop()


def combine_members(members: Sequence[Sequence[GridLayer]]) -> list[Layer]:
    """Return the layers of an ensemble; a layer that is the same for all members stays single.

    Parameters
    ----------
    members : The layers of each member, in the same order.
    """
    layers: list[Layer] = []
    for group in zip(*members):
        first = group[0].provenance()
        same = all(layer.provenance() == first for layer in group)
        layers.append(group[0] if same else combine_member_layers(group))
    return layers
