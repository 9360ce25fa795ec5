"""The fields of a raster at the nodes of a finer mesh on its lines."""

import numpy as np

from thalweg.kernels.compilation.decorators import kernel_only


@kernel_only
def time_step_of(times, t):
    """Return (step, fraction) of a time on an increasing axis, held inside it."""
    last = times.shape[0] - 2
    if t <= times[0]:
        return 0, 0.0
    if t >= times[last + 1]:
        return last, 1.0
    step = np.searchsorted(times, t, side="right") - 1
    step = min(max(step, 0), last)
    return step, (t - times[step]) / (times[step + 1] - times[step])


@kernel_only
def sample_node(world, j, i, step, fraction, sample):
    """Fill ``sample`` by channel at a node of the mesh; NaN where a value is unknown."""
    raster, m = world.raster, world.refinement
    row, column = world.first_row + j // m, world.first_column + i // m
    fy, fx = (j % m) / m, (i % m) / m
    values, channels = raster.values, raster.channels
    for k in range(channels.shape[0]):
        total = 0.0
        for later in range(2):
            in_time = fraction if later else 1.0 - fraction
            if in_time == 0.0:
                continue
            for up in range(2):
                for side in range(2):
                    weight = in_time * (fy if up else 1.0 - fy) * (fx if side else 1.0 - fx)
                    if weight != 0.0:
                        total += weight * values[step + later, row + up, column + side, k]
        sample[channels[k]] = total


@kernel_only
def margin_of_cell(world, j, i, channel):
    """Return by how much the sea may differ from the raster in a cell of the mesh."""
    margins, m = world.margins, world.refinement
    row = min(world.first_row + j // m, margins.shape[0] - 1)
    column = min(world.first_column + i // m, margins.shape[1] - 1)
    return margins[row, column, channel]
