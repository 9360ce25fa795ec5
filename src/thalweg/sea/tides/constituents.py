"""Harmonic constants of tidal constituents at one or more nodes, and prediction for any time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import ComplexArray, FloatArray
from thalweg.core.units import DAY
from thalweg.sea.tides import foreman, schureman

CONVENTIONS: Final = ("foreman", "schureman", "rws")
TIMES_PER_CHUNK: Final = 1 << 14  #: times for which arguments are computed at once
NODAL_STEP: Final = DAY  #: [s] step of nodal corrections, which are linear in between


@dataclass(frozen=True, eq=False)
class Constituents:
    r"""Harmonic constants of one or more variables at one or more nodes.

    The tide is

    .. math:: \eta(t) = \bar{\eta} + \sum_c f_c A_c \cos(V_c(t) + u_c - g_c)

    with the equilibrium argument V at Greenwich and the nodal corrections f and u, so it is valid
    at any time without a reference time.

    Attributes
    ----------
    names : tuple of str
        Constituents, C of them.
    amplitude : mapping of str to float64 array (C, N)
        By variable (canonical name), in the unit of the variable.
    phase : mapping of str to float64 array (C, N)
        Greenwich phase lag g [deg], for times in UTC.
    mean : mapping of str to float64 array (N,)
        Mean over the record, or the level of the mean above datum.
    lat, lon : float64 array (N,)
        Positions [deg]; NaN where unknown.
    convention : {"foreman", "schureman", "rws"}
        The arguments and nodal corrections that belong to the constants: those of UTide
        (analysis), of Schureman (published tables), or of Schureman as Rijkswaterstaat applies
        them.
    facts : mapping
        Plain facts about the source.
    """

    names: tuple[str, ...]
    amplitude: Mapping[str, FloatArray]
    phase: Mapping[str, FloatArray]
    mean: Mapping[str, FloatArray]
    lat: FloatArray
    lon: FloatArray
    convention: str = "schureman"
    facts: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.convention not in CONVENTIONS:
            raise unknown_name_error("tidal convention", self.convention, CONVENTIONS)
        nodes = self.lat.size
        for name in self.amplitude:
            shapes = (self.amplitude[name].shape, self.phase[name].shape, self.mean[name].shape)
            if shapes != ((len(self.names), nodes),) * 2 + ((nodes,),):
                raise InputError(
                    f"The constants of {name!r} have shapes {shapes}.",
                    f"There are {len(self.names)} constituents and {nodes} nodes.",
                    "Give one amplitude and phase per constituent and node, and one mean per node.",
                    field=name,
                )
        for constituent in self.names:
            self._frequency(constituent)

    @classmethod
    def single(
        cls,
        variable: str,
        table: Mapping[str, tuple[float, float]],
        *,
        mean: float = 0.0,
        lat: float = np.nan,
        lon: float = np.nan,
        convention: str = "schureman",
        facts: Mapping[str, Any] | None = None,
    ) -> Constituents:
        """Return constants of one variable at one position.

        Parameters
        ----------
        variable : str
            Canonical name, such as ``sea_surface_height_above_geopotential_datum``.
        table : mapping of str to (float, float)
            Amplitude and Greenwich phase lag [deg] by constituent.
        mean : float
            Level of the mean.
        lat, lon : float
            Position [deg].
        convention, facts
            As the attributes.

        Returns
        -------
        Constituents
            With one variable at one node.

        Raises
        ------
        InputError
            If an amplitude is negative, or a constant is not finite.
        """
        pairs = np.array(list(table.values()), float).reshape(-1, 2)
        if not (np.isfinite(pairs).all() and (pairs[:, 0] >= 0.0).all()):
            raise InputError(
                "An amplitude is negative, or a constant is not a number.",
                "Amplitudes are zero or more, phases are in degrees.",
                "Correct the table.",
            )
        return cls(
            tuple(table),
            {variable: pairs[:, :1]},
            {variable: pairs[:, 1:]},
            {variable: np.array([float(mean)])},
            np.array([float(lat)]),
            np.array([float(lon)]),
            convention,
            dict(facts or {}),
        )

    @property
    def variables(self) -> frozenset[str]:
        """Canonical names of the predicted variables."""
        return frozenset(self.amplitude)

    @property
    def latitude(self) -> float:
        """The latitude [deg] of the nodal corrections, in analysis and prediction: the mean."""
        known = self.lat[np.isfinite(self.lat)]
        return float(known.mean()) if known.size else 45.0

    def frequencies(self) -> FloatArray:
        """Return the frequencies of the constituents.

        Returns
        -------
        float64 array (C,)
            Cycles per hour.
        """
        return np.array([self._frequency(n) for n in self.names])

    def _frequency(self, name: str) -> float:
        module = foreman if self.convention == "foreman" else schureman
        return module.frequency(name)

    def coefficients(self, variable: str) -> ComplexArray:
        """Return the complex amplitudes ``A exp(-i g)`` of a variable.

        Parameters
        ----------
        variable : str
            Canonical name, one of `variables`.

        Returns
        -------
        complex128 array (C, N)
            In the unit of the variable.
        """
        phase = np.radians(self.phase[variable])
        return np.asarray(self.amplitude[variable] * np.exp(-1j * phase))

    def predict(
        self,
        variable: str,
        times: ArrayLike,
        *,
        only: Sequence[str] | None = None,
        nodal_time: float | None = None,
    ) -> FloatArray:
        """Return the tide at every node.

        Parameters
        ----------
        variable : str
            Canonical name.
        times : array_like (T,)
            Seconds since 1970-01-01T00:00Z.
        only : sequence of str, optional
            Constituents to use; all by default.
        nodal_time : float, optional
            Time [s since epoch] of the nodal corrections for all times, as in printed tables (the
            middle of the year); by default they vary with the times.

        Returns
        -------
        float64 array (N, T)
            Tide including the mean, in the unit of the variable.

        Raises
        ------
        InputError
            If the variable or a constituent is unknown.
        """
        if variable not in self.amplitude:
            raise unknown_name_error("tidal variable", variable, self.amplitude)
        moments = np.asarray(times, np.float64).ravel()
        chosen = self if only is None else self.picked(only)
        coefficient = chosen.coefficients(variable)
        result = np.empty((self.lat.size, moments.size))
        for first in range(0, moments.size, TIMES_PER_CHUNK):
            part = slice(first, first + TIMES_PER_CHUNK)
            wave = unit_phasors(
                chosen.names, moments[part], chosen.latitude, chosen.convention, nodal_time
            )
            result[:, part] = chosen.mean[variable][:, None] + tidal_signal(coefficient.T, wave.T)
        return result

    def picked(self, only: Sequence[str]) -> Constituents:
        """Return the constants of some of the constituents.

        Parameters
        ----------
        only : sequence of str
            Names of constituents.

        Returns
        -------
        Constituents
            In the order of the names.

        Raises
        ------
        InputError
            If a constituent is not there (with near matches).
        """
        missing = [n for n in only if n not in self.names]
        if missing:
            raise unknown_name_error("constituent here", missing[0], self.names)
        rows = [self.names.index(n) for n in only]
        amplitude = {v: a[rows] for v, a in self.amplitude.items()}
        phase = {v: g[rows] for v, g in self.phase.items()}
        return replace(self, names=tuple(only), amplitude=amplitude, phase=phase)

    def table(self, variable: str, node: int = 0) -> list[dict[str, float | str]]:
        """Return the constants of a variable at one node, largest amplitude first.

        Parameters
        ----------
        variable : str
            Canonical name, one of `variables`.
        node : int, optional
            Index of the node.

        Returns
        -------
        list of dict
            ``name``, ``period_h``, ``amplitude`` (in the unit of the variable) and
            ``phase_deg``.
        """
        size, phase = self.amplitude[variable][:, node], self.phase[variable][:, node]
        rows: list[dict[str, float | str]] = [
            {
                "name": name,
                "period_h": float(1.0 / f) if f > 0.0 else float("inf"),
                "amplitude": float(a),
                "phase_deg": float(g % 360.0),
            }
            for name, f, a, g in zip(self.names, self.frequencies(), size, phase)
        ]
        return sorted(rows, key=lambda r: -float(r["amplitude"]))


def tidal_signal(coefficient: ComplexArray, wave: ComplexArray) -> FloatArray:
    """Return the real part of a product of complex matrices (N, C) and (C, T), as one real one.

    Parameters
    ----------
    coefficient : ``A exp(-i g)`` at nodes, in the unit of the variable, (N, C).
    wave : Transposed unit phasors, (C, T).

    Returns
    -------
    float64 array (N, T)
    """
    left = np.concatenate([coefficient.real, -coefficient.imag], axis=1)
    right = np.concatenate([wave.real, wave.imag], axis=0)
    return np.asarray(left @ right, np.float64)


def unit_phasors(
    names: tuple[str, ...],
    times: FloatArray,
    latitude: float,
    convention: str,
    nodal_time: float | None = None,
) -> ComplexArray:
    """Return ``f exp(i (V + u))``: the tide of unit amplitude and zero phase lag.

    The argument V is exact. The nodal corrections f and u change by less than a degree per day;
    they are computed once a day and are linear in between.

    Parameters
    ----------
    names : C constituents.
    times : Seconds since 1970-01-01T00:00Z, (T,).
    latitude : Latitude of the nodal corrections [deg].
    convention : {"foreman", "schureman", "rws"}
        As `Constituents`.
    nodal_time : One time of the nodal corrections [s since epoch].

    Returns
    -------
    complex128 array (T, C)
    """
    if convention == "foreman":
        angle = foreman.equilibrium_arguments(names, times)
    else:
        angle = schureman.equilibrium_arguments(names, times)
    when = times if nodal_time is None else np.full(1, float(nodal_time))
    return np.asarray(
        np.exp(2j * np.pi * angle)
        * _interpolated_nodal_corrections(names, when, latitude, convention)
    )


def _interpolated_nodal_corrections(
    names: tuple[str, ...], times: FloatArray, latitude: float, convention: str
) -> ComplexArray:
    day = np.floor(times / NODAL_STEP)
    days, place = np.unique(np.concatenate([day, day + 1.0]), return_inverse=True)
    if convention == "foreman":
        factor = foreman.nodal_corrections(names, days * NODAL_STEP, latitude)
    else:
        factor = schureman.nodal_corrections(names, days * NODAL_STEP, rws=convention == "rws")
    before, after = factor[place[: times.size]], factor[place[times.size :]]
    fraction = (times / NODAL_STEP - day)[:, None]
    return np.asarray((1.0 - fraction) * before + fraction * after)
