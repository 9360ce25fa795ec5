"""Populations: many tracks in one array, and single tracks (genomes) of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.geodesy import wrap_longitude
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.kernels.leg import population_sailing as columns
from thalweg.route.track import Track


@dataclass(frozen=True, eq=False)
class Genome:
    """One track: points, the speed setting of every leg, waits.

    Attributes
    ----------
    lat, lon : float64 array (n,)
        Points [deg], n >= 2.
    setting : int64 array (n - 1,)
        Setting of each leg, counted from 0.
    wait : float64 array (n,), optional
        Waiting time at each point [s]; zeros by default.
    via : bool array (n,), optional
        Points that every track must pass, in this order; both ends always are.
    """

    lat: FloatArray
    lon: FloatArray
    setting: IntArray
    wait: FloatArray = None  # type: ignore[assignment]
    via: BoolArray = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        lat, lon = np.array(self.lat, float).reshape(-1), np.array(self.lon, float).reshape(-1)
        count = len(lat)
        wait = np.zeros(count) if self.wait is None else np.array(self.wait, float)
        via = np.zeros(count, bool) if self.via is None else np.array(self.via, bool)
        setting = np.array(self.setting, np.int64).reshape(-1)
        if count < 2 or any(len(x) != n for x, n in _lengths(count, lon, setting, wait, via)):
            raise InputError(
                f"A genome has {count} latitudes, {len(lon)} longitudes, {len(setting)} settings, "
                f"{len(wait)} waits and {len(via)} marks of via points.",
                "It has at least two points, and one setting less than points.",
                "Give arrays of matching lengths.",
            )
        via[[0, -1]] = True
        made = {"lat": lat, "lon": wrap_longitude(lon), "setting": setting, "wait": wait}
        for name, values in {**made, "via": via}.items():
            values.setflags(write=False)
            object.__setattr__(self, name, values)

    def __len__(self) -> int:
        return len(self.lat)

    @classmethod
    def from_track(
        cls, track: Track, *, settings: int, via: Sequence[ArrayLike] | None = None
    ) -> Genome:
        """Return the genome of a track.

        Parameters
        ----------
        track : Track
        settings : int
            Number of settings of the ship, for settings counted from the end.
        via : sequence of (lat, lon), optional
            Waypoints of the track [deg] that must stay (within 1e-9 degrees).

        Returns
        -------
        Genome
            With settings counted from 0, and waits.

        Raises
        ------
        InputError
            If a via point is not a waypoint of the track.
        """
        setting = np.where(track.setting < 0, track.setting + settings, track.setting)
        held = np.zeros(len(track), dtype=bool)
        for position in via or ():
            lat, lon = (float(x) for x in np.asarray(position, float))
            offset = np.abs(track.lat - lat) + np.abs(wrap_longitude(track.lon - lon))
            nearest = int(np.argmin(offset))
            if offset[nearest] > 2e-9:
                raise InputError(
                    f"The via point ({lat:g}, {lon:g}) is not on the track.",
                    "Via points of a genome are waypoints of its track.",
                    "Give a track through it.",
                )
            held[nearest] = True
        return cls(track.lat, track.lon, setting, track.wait, held)

    def to_track(self, depart: float) -> Track:
        """Return the track of the genome.

        Parameters
        ----------
        depart : float
            Departure [s since 1970-01-01T00:00Z].

        Returns
        -------
        Track
            With the positions, settings and waits of the genome; without a wait at the
            last waypoint.
        """
        wait = np.array(self.wait)
        wait[-1] = 0.0
        return Track(self.lat, self.lon, depart, wait, self.setting)


@dataclass(frozen=True, eq=False)
class Population:
    """Many genomes in arrays, each leg with what is known of it.

    Attributes
    ----------
    count : int64 array (N,)
        Points of each track.
    genes : float64 array (N, M, GENE_COLUMNS)
        Points and the legs that start there, see `thalweg.kernels.leg.population_sailing`.
    """

    count: IntArray
    genes: FloatArray

    @classmethod
    def of(cls, genomes: Sequence[Genome], *, capacity: int = 0) -> Population:
        """Return genomes as arrays.

        Parameters
        ----------
        genomes : sequence of Genome
            One or more.
        capacity : int, optional
            Least number of points for which each track has space.

        Returns
        -------
        Population
            In the order of the genomes.

        Raises
        ------
        InputError
            If no genome is given.
        """
        if not len(genomes):
            raise InputError(
                "No genome is given.", "A population has at least one.", "Give at least one track."
            )
        count = np.array([len(genome) for genome in genomes], dtype=np.int64)
        genes = np.zeros((len(genomes), max(int(count.max()), capacity), columns.GENE_COLUMNS))
        genes[:, :, columns.FIXED_TIME] = np.nan
        for row, genome in zip(genes, genomes):
            n = len(genome)
            row[:n, columns.LAT], row[:n, columns.LON] = genome.lat, genome.lon
            row[:n, columns.WAITING_TIME], row[:n, columns.IS_REQUIRED] = genome.wait, genome.via
            row[: n - 1, columns.SETTING] = genome.setting
        return cls(count, genes)

    def __len__(self) -> int:
        return len(self.count)

    @property
    def capacity(self) -> int:
        """Largest number of points of a track."""
        return int(self.genes.shape[1])

    def genome(self, index: int) -> Genome:
        """Return one track.

        Parameters
        ----------
        index : int
            Row of the track.

        Returns
        -------
        Genome
            Its positions, settings and waits.
        """
        n = int(self.count[index])
        row = self.genes[index, :n]
        return Genome(
            row[:, columns.LAT],
            row[:, columns.LON],
            row[:-1, columns.SETTING].astype(np.int64),
            row[:, columns.WAITING_TIME],
            row[:, columns.IS_REQUIRED] != 0.0,
        )

    def genomes(self) -> list[Genome]:
        """Return every track.

        Returns
        -------
        list of Genome
            In the order of the rows.
        """
        return [self.genome(i) for i in range(len(self))]

    def take(self, index: ArrayLike) -> Population:
        """Return a copy of some of the tracks.

        Parameters
        ----------
        index : array_like
            Rows, as indices or as a mask (N,).

        Returns
        -------
        Population
            In the order of the indices.
        """
        chosen = np.asarray(index)
        return Population(self.count[chosen], self.genes[chosen])

    def with_capacity(self, capacity: int) -> Population:
        """Return the population with another space for points.

        Parameters
        ----------
        capacity : int
            Points; not fewer than the longest track has.

        Returns
        -------
        Population
            The same tracks.
        """
        capacity = max(capacity, int(self.count.max(initial=0)))
        genes = np.zeros((len(self), capacity, columns.GENE_COLUMNS))
        genes[:, :, columns.FIXED_TIME] = np.nan
        both = min(capacity, self.capacity)
        genes[:, :both] = self.genes[:, :both]
        return Population(self.count, genes)


def concatenated_populations(*populations: Population) -> Population:
    """Return one population with all the tracks of several."""
    capacity = max(population.capacity for population in populations)
    same = [p if p.capacity == capacity else p.with_capacity(capacity) for p in populations]
    return Population(
        np.concatenate([p.count for p in same]), np.concatenate([p.genes for p in same])
    )


def _lengths(count: int, lon, setting, wait, via):  # type: ignore[no-untyped-def]
    return (lon, count), (setting, count - 1), (wait, count), (via, count)
