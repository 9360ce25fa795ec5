"""Winding numbers of the cells of a coast index, propagated from cell to cell."""

from thalweg.kernels.compilation.decorators import allocation_free, kernel_only
from thalweg.kernels.geometry.cube_sphere import ALL_LAND, FIRST_ROW, cell_middle, winding_from

SEA = 1.0e-9  # a cell value: outside the polygons, distance to them not known yet


@kernel_only
def _carry(index, face, cell, start, end, winding):
    """Propagate a winding number between two points (column, row) of one cell.

    Points are counted in cells; halves are borders.
    """
    value = index.cell[(face * index.side + cell[1]) * index.side + cell[0]]
    if value > FIRST_ROW:
        return winding
    a = cell_middle(face, end[0], end[1], index.side)
    b = cell_middle(face, start[0], start[1], index.side)
    return winding_from(index, int(FIRST_ROW - value), a, b, winding, False)


@allocation_free
def carry_windings(index, seeds):
    """Fill in the winding number of every row and whether empty cells are inside.

    Parameters
    ----------
    index : IndexArrays
        ``cell`` holds rows (-2 - row) and zeros; zeros become -1 (inside) or ``SEA``; ``winding``
        is filled.
    seeds : int64[6]
        Winding number at the middle of the first cell of each face.
    """
    side, cell = index.side, index.cell
    for face in range(6):
        first = seeds[face]
        for j in range(side):
            if j > 0:
                border = (0.0, j - 0.5)
                first = _carry(index, face, (0, j - 1), (0.0, j - 1.0), border, first)
                first = _carry(index, face, (0, j), border, (0.0, j + 0.0), first)
            winding = first
            for i in range(side):
                if i > 0:
                    border = (i - 0.5, j + 0.0)
                    winding = _carry(index, face, (i - 1, j), (i - 1.0, j + 0.0), border, winding)
                    winding = _carry(index, face, (i, j), border, (i + 0.0, j + 0.0), winding)
                k = (face * side + j) * side + i
                if cell[k] <= FIRST_ROW:
                    index.winding[int(FIRST_ROW - cell[k])] = winding
                else:
                    cell[k] = ALL_LAND if winding != 0 else SEA
