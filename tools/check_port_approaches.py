"""List the approaches of ports that a person should look at.

    python tools/check_port_approaches.py [PORTS]

For the PORTS (300) with most liner connections, the most important first: how much of the line is
charted land (scale i), how deep the depth layer is at the sea end and at its shallowest farther
than 2 miles from land, and flags. LAND: a computed line with more than a mile of charted land.
SHOAL: less than 8 m, or less than the largest draught of the port, at the sea end or on the part
off land. BASIN: the nearest node of the graph of all seas is in another water than the ocean.
DIVERGES: the sea end is more than 10 miles from that of a port of the same size within 5 miles.
Lines by hand cross charted land where the chart has no river; the layer shows no dredged channels.
"""

import sys

import numpy as np
from scipy.spatial import cKDTree

from thalweg.chart import Chart
from thalweg.chart.approaches import PORT_APPROACHES, PortApproach
from thalweg.chart.depth.global_depth import coarse_depth
from thalweg.chart.ports import PORTS
from thalweg.core.geodesy import densify, distance, geocentric_unit_vectors
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.global_grid.sea_graph_cache import sea_graph

SHALLOW = 8.0  # [m]
OFF_LAND = 2.0  # [nm]


def facts(chart: Chart, approach: PortApproach) -> tuple[float, float, float]:
    """Return miles on charted land, depth at the sea end, and least depth off land [m]."""
    lat, lon = np.array(approach.line, float).T
    if len(lat) > 1:
        lat, lon, _ = densify(lat, lon, 0.1 * NAUTICAL_MILE)
    off = np.asarray(chart.coastline.shore_distance(lat, lon)) / NAUTICAL_MILE
    depth = np.asarray(coarse_depth(lat, lon))
    open_part = np.append(depth[off > OFF_LAND], depth[-1])
    share = float(np.mean(off == 0.0))
    least = float(np.nanmin(open_part)) if np.isfinite(open_part).any() else np.nan
    return share * approach.length / NAUTICAL_MILE, float(depth[-1]), least


def diverges(approach: PortApproach, others: list[PortApproach]) -> bool:
    """Return whether a neighbouring port has a sea end far away."""
    return any(
        distance(*approach.berth, *other.berth) < 5.0 * NAUTICAL_MILE
        and distance(*approach.sea_end, *other.sea_end) > 10.0 * NAUTICAL_MILE
        for other in others
        if other is not approach and abs(other.berth[0] - approach.berth[0]) < 0.1
    )


def main() -> None:
    """Print the list."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    chart = Chart.gshhg("i")
    every = sorted(PORTS.all, key=lambda port: -port.importance)
    found = [a for a in map(PORT_APPROACHES.of, every) if a is not None][:count]
    waters = sea_graph(chart).waters
    ocean = int(np.bincount(waters.water[waters.water >= 0]).argmax())
    tree = cKDTree(waters.vectors)
    flagged = 0
    for approach in found:
        land, end, least = facts(chart, approach)
        flags = []
        if approach.quality == "computed" and land > 1.0:
            flags.append("LAND")
        needed = max(SHALLOW, np.nan_to_num(approach.max_draught, nan=0.0))
        if not min(end, least) >= needed:
            flags.append("SHOAL")
        place = geocentric_unit_vectors(*np.array([approach.sea_end]).T)[0]
        if waters.water[tree.query(place)[1]] != ocean:
            flags.append("BASIN")
        if diverges(approach, found):
            flags.append("DIVERGES")
        flagged += bool(flags)
        if flags:
            print(
                f"{approach.port.label:32s} {approach.quality:9s} land {land:5.1f} nm  depth "
                f"at the end {end:4.0f} m, least {least:4.0f} m  {' '.join(flags)}"
            )
    print(f"{flagged} of {len(found)} approaches have flags")


if __name__ == "__main__":
    main()
