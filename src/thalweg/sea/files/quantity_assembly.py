"""Assemble the placed variables of a file into quantities: vectors, waves, bed and water level."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from thalweg.core.errors import DatasetError
from thalweg.core.types import FloatArray
from thalweg.sea import standard_names as nm
from thalweg.sea.files import derived_variables, draught_averaging
from thalweg.sea.files import variable_aliases as sp
from thalweg.sea.files.derived_variables import Combine
from thalweg.sea.files.grid_detection import GridPlacement
from thalweg.sea.files.layer_candidate import LayerCandidate, OpenedFile, PlacedVariable
from thalweg.sea.files.variable_recognition import IgnoredVariable
from thalweg.sea.grids.source_variables import Quantity
from thalweg.sea.recognition_record import RecognisedVariable

NO_TIMES = np.empty(0)
#: Energy period (m-1 / m0) over peak period of a JONSWAP spectrum with peak enhancement 3.3.
_ENERGY_PERIOD_SHARE = 0.903


class QuantityAssembler:
    """Makes quantities from placed variables by role, and records the variables not used."""

    def __init__(
        self,
        file: OpenedFile,
        placed: dict[str, PlacedVariable],
        ignored: list[IgnoredVariable],
    ) -> None:
        self.file, self.remaining, self.ignored = file, dict(placed), list(ignored)
        self.candidates: list[LayerCandidate] = []

    def assemble(self) -> None:
        """Make all quantities that the variables allow."""
        self._vector(nm.WIND, (sp.X_WIND, sp.Y_WIND))
        self._vector(nm.CURRENT, (sp.X_CURRENT, sp.Y_CURRENT))
        self._waves()
        self._wave_period()
        self._bed_and_level()
        for role in list(self.remaining):
            one = self.remaining.pop(role)
            how = one.chosen.how
            if one.times.size == 0 and role not in (nm.BED_DEPTH,):
                how += "; without dates: holds at all times"
            self._add((role,), [one], derived_variables.identity, how)

    def _vector(self, vector: nm.VectorNames, along_grid: tuple[str, str]) -> None:
        """Make a vector from components (true or along the grid), or from speed and direction."""
        if self._both_present(vector.pair):
            pair = [self.remaining.pop(n) for n in vector.pair]
            rotate = pair[0].rotated and pair[0].place.angle is not None
            self._add_vector(vector, pair, rotate)
        elif self._both_present(along_grid):
            pair = [self.remaining.pop(n) for n in along_grid]
            self._add_vector(vector, pair, pair[0].place.angle is not None)
        elif self._both_present((vector.speed, vector.origin)):
            self._polar(vector, vector.origin)
        elif self._both_present((vector.speed, vector.towards)):
            self._polar(vector, vector.towards)
        alone = (*vector.pair, *along_grid, vector.origin, vector.towards)
        made = any(set(vector.pair) <= set(q.names) for d in self.candidates for q in d.quantities)
        if not made:
            self._refuse_half(vector, (*vector.pair, *along_grid))
        for role in alone if not made else (*alone, vector.speed):
            if role in self.remaining:
                reason = "other variables make this vector" if made else "its partner is missing"
                self._leave(role, f"{reason} ({role})")

    def _refuse_half(self, vector: nm.VectorNames, components: Sequence[str]) -> None:
        """Raise `DatasetError` for one component without the other: a ship would meet none."""
        parts = list(components)
        if vector is nm.CURRENT:
            parts += [vector.speed, vector.origin, vector.towards]
        halves = {
            role: self.remaining[role].chosen.variable for role in parts if role in self.remaining
        }
        if not halves:
            return
        names = " and ".join(repr(name) for name in halves.values())
        if len(halves) == 1:
            fault = "the other part of this vector is not in the file"
            remedy = "Add it to the file (cdo merge, or xarray.merge), or remove this part"
        else:
            fault = "they do not make a vector on one grid and one time axis"
            remedy = "Interpolate them to the same positions (for example to the centres of cells)"
        raise DatasetError(
            f"{self.file.source}: {names} ({', '.join(halves)}): {fault}.",
            "A vector is read from both components, or from speed and direction, at the same "
            "positions and times (of ROMS and NEMO on the sides of cells, with the positions of "
            "the centres).",
            f"{remedy}; variables with other names are named with a mapping (--map NAME=VARIABLE).",
            file=self.file.source,
            variables=list(halves.values()),
        )

    def _both_present(self, roles: Sequence[str]) -> bool:
        """Return whether both roles are present, on one grid and one time axis."""
        if not all(role in self.remaining for role in roles):
            return False
        a, b = (self.remaining[role] for role in roles)
        return a.place.key == b.place.key and np.array_equal(a.times, b.times)

    def _add_vector(self, vector: nm.VectorNames, pair: list[PlacedVariable], rotate: bool) -> None:
        how = pair[0].chosen.how
        if any(pair[0].variable.shift) or any(pair[1].variable.shift):
            how += "; averaged from cell sides to centres"
        if rotate:
            how += "; rotated from grid to true east and north"
        if pair[0].layers is None:
            self._add(vector.pair, pair, derived_variables.identity, how, rotate=rotate)
            return
        draught = self.file.draught or 0.0
        column, depth = self._column(pair)
        how += f"; mean over the upper {draught:g} m of {pair[0].layers.describe()}"
        combine = draught_averaging.draught_averaging(pair[0].layers, draught, depth)
        self._add(vector.pair, [*pair, *column], combine, how, rotate=rotate)

    def _column(
        self, pair: list[PlacedVariable]
    ) -> tuple[list[PlacedVariable], Callable[[Sequence[FloatArray]], FloatArray]]:
        """Return the variables that give the water column of a vector, and how to compute it."""
        level, total, bed, height = (
            self._beside(pair[0], role)
            for role in (nm.WATER_LEVEL, nm.TOTAL_DEPTH, nm.BED_DEPTH, sp.BED_LEVEL)
        )
        if pair[0].layers is not None and not pair[0].layers.is_sigma:
            if level is None:
                return [], lambda arrays: np.zeros_like(arrays[0][:, 0])
            return [level], lambda arrays: arrays[2]
        if total is not None:
            return [total], lambda arrays: arrays[2]
        if bed is not None:
            sign = -1.0 if _states_upwards(bed) else 1.0
        else:
            sign = -1.0 if _is_positive_up(height) else 1.0
        bed = bed or height
        if bed is None:
            raise draught_averaging.missing_depth_error(
                [p.chosen.variable for p in pair], self.file.source
            )
        if level is None:
            return [bed], lambda arrays: sign * arrays[2]
        return [bed, level], lambda arrays: sign * arrays[2] + arrays[3]

    def _beside(self, one: PlacedVariable, role: str) -> PlacedVariable | None:
        """Return the variable of a role, if it has the grid of another and its times or no time."""
        other = self.remaining.get(role)
        if other is None or other.place.key != one.place.key:
            return None
        return other if not other.times.size or np.array_equal(other.times, one.times) else None

    def _polar(self, vector: nm.VectorNames, direction: str) -> None:
        pair = [self.remaining.pop(vector.speed), self.remaining.pop(direction)]
        sign = -1.0 if direction == vector.origin else 1.0
        word = "from" if direction == vector.origin else "to"
        how = f"{pair[0].chosen.how}; speed and direction {word} to components"
        combine = derived_variables.with_checked_direction(
            derived_variables.polar_to_components(sign),
            1,
            pair[1].chosen.variable,
            self.file.source,
        )
        self._add(vector.pair, pair, combine, how)

    def _waves(self) -> None:
        for role, sign in ((nm.WAVES.origin, -1.0), (nm.WAVES.towards, 1.0)):
            if role not in self.remaining:
                continue
            if any(nm.WAVE_TO_EAST in q.names for d in self.candidates for q in d.quantities):
                self._leave(role, "another wave direction is used")
                continue
            one = self.remaining.pop(role)
            word = "from" if sign < 0 else "to"
            how = f"{one.chosen.how}; direction {word} to unit vector towards"
            combine = derived_variables.with_checked_direction(
                derived_variables.direction_to_unit_vector(sign),
                0,
                one.chosen.variable,
                self.file.source,
            )
            self._add(nm.WAVES.pair, [one], combine, how)

    def _wave_period(self) -> None:
        """Make the peak period of waves from their energy period where the peak is not given."""
        if sp.ENERGY_PERIOD not in self.remaining:
            return
        if nm.WAVE_PERIOD in self.remaining:
            self._leave(sp.ENERGY_PERIOD, "the peak period is used")
            return
        one = self.remaining.pop(sp.ENERGY_PERIOD)
        how = f"{one.chosen.how}; energy period / {_ENERGY_PERIOD_SHARE} (JONSWAP spectrum)"
        peak = derived_variables.scale_by(1.0 / _ENERGY_PERIOD_SHARE)
        self._add((nm.WAVE_PERIOD,), [one], peak, how)

    def _bed_and_level(self) -> None:
        """Make bed depth and water level from depth, bed level and total depth, as present."""
        bed, sign = self._bed()
        total = self.remaining.get(nm.TOTAL_DEPTH)
        if total is None:
            return
        level = self.remaining.get(nm.WATER_LEVEL)
        other = bed if bed is not None else level
        if other is None:
            del self.remaining[nm.TOTAL_DEPTH]
            how = "total depth, no level"
            self._add((nm.BED_DEPTH,), [total], derived_variables.identity, how)
        elif bed is None and self._both_present((nm.TOTAL_DEPTH, nm.WATER_LEVEL)):
            del self.remaining[nm.TOTAL_DEPTH]
            how = "total depth minus water level"
            self._add((nm.BED_DEPTH,), [total, other], derived_variables.subtract(1.0), how)
        elif level is None and total.place.key == other.place.key:
            del self.remaining[nm.TOTAL_DEPTH]
            how = "total depth minus bed depth"
            self._add((nm.WATER_LEVEL,), [total, other], derived_variables.subtract(sign), how)
        elif bed is None:
            reason = "the water level needed to convert it is not on its grid and at its times"
            self._leave(nm.TOTAL_DEPTH, reason)
        else:
            self._leave(nm.TOTAL_DEPTH, "bed depth and water level are used")

    def _bed(self) -> tuple[PlacedVariable | None, float]:
        """Make the bed depth from a depth or a bed level; return that variable and its sign."""
        bed, sign = self.remaining.pop(nm.BED_DEPTH, None), 1.0
        if bed is not None and _states_upwards(bed):
            sign = -1.0
        if bed is None and sp.BED_LEVEL in self.remaining:
            bed = self.remaining.pop(sp.BED_LEVEL)
            sign = -1.0 if _is_positive_up(bed) else 1.0
        elif sp.BED_LEVEL in self.remaining:
            self._leave(sp.BED_LEVEL, "the bed depth is used")
        if bed is not None:
            how = bed.chosen.how + _sign_note(sign)
            self._add((nm.BED_DEPTH,), [bed], derived_variables.scale_by(sign), how)
        return bed, sign

    def _leave(self, role: str, reason: str) -> None:
        self.ignored.append(IgnoredVariable(self.remaining.pop(role).chosen.variable, reason))

    def _add(
        self,
        made: tuple[str, ...],
        parts: list[PlacedVariable],
        combine: Combine,
        how: str,
        *,
        rotate: bool = False,
    ) -> None:
        """Add a quantity to the layer candidate of its grid and time axis."""
        place = parts[0].place
        times = next((p.times for p in parts if p.times.size), NO_TIMES)
        make = derived_variables.make_conversion(combine, place, rotate)
        layers = max(1 if p.layers is None else p.layers.top.size for p in parts)
        quantity = Quantity(made, tuple(p.variable for p in parts), make, self.file.source, layers)
        candidate = self._candidate_for(place, times)
        candidate.quantities.append(quantity)
        units = ", ".join(dict.fromkeys(p.chosen.units or "not stated" for p in parts))
        files = tuple(p.chosen.variable for p in parts)
        factors = {p.chosen.factor for p in parts} - {1.0}
        if factors:
            how += f"; times {', '.join(f'{f:g}' for f in sorted(factors))}"
        candidate.recognised += [
            RecognisedVariable(n, files, units, how, self.file.source) for n in made
        ]

    def _candidate_for(self, place: GridPlacement, times: FloatArray) -> LayerCandidate:
        for candidate in self.candidates:
            if candidate.place.key == place.key and np.array_equal(candidate.times, times):
                return candidate
        self.candidates.append(LayerCandidate(place, times, self.file))
        return self.candidates[-1]


def _is_positive_up(height: PlacedVariable | None) -> bool:
    """Return whether a bed level is positive upwards, which is the default."""
    if height is None:
        return True
    positive = height.variable.pieces[0].array.attrs.get("positive", "up")
    return str(positive).lower() != "down"


def _states_upwards(depth: PlacedVariable) -> bool:
    """Return whether a depth states that it is positive upwards."""
    return str(depth.variable.pieces[0].array.attrs.get("positive", "")).lower() == "up"


def _sign_note(sign: float) -> str:
    return "; height converted to depth" if sign < 0 else ""
