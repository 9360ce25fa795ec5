"""Times of HALEM 1.0.3 in a rotating flow on 625 nodes, as JSON; run by a Python with HALEM."""

import json
import sys
import time
from datetime import datetime

import numpy as np
from halem import BaseRoadmap, HALEM_time, functions

T0 = "01/01/2019 00:00:00"
DEPTH = 1000.0
SPEED = 4.0  # speed of the ship after HALEM's correction for shallow water [m/s]


def speed_left(speed):
    left = functions.squat(np.array([DEPTH]), 1.5, speed, 80, 20, 1.5, 3000.0)
    return float(np.ravel(left)[0])


class Rotating(BaseRoadmap):
    """u = 2 cos(pi lat), v = -2 cos(pi lon), 1000 m deep, on 25 x 25 nodes 0.05 deg apart."""

    def load(self):
        start = datetime.strptime(T0, "%d/%m/%Y %H:%M:%S").timestamp()
        times = start + np.arange(0, 15 * 3600.0, 1800.0)
        axis = np.linspace(-0.1, 1.1, 25)
        lat, lon = (g.reshape(-1) for g in np.meshgrid(axis, axis, indexing="ij"))
        u = np.repeat(2.0 * np.cos(np.pi * lat)[None, :], len(times), axis=0)
        v = np.repeat(-2.0 * np.cos(np.pi * lon)[None, :], len(times), axis=0)
        depth = np.full(u.shape, DEPTH)
        nodes = np.column_stack([lat, lon])
        return {"time": times, "nodes": nodes, "u": u, "v": v, "water_depth": depth}


def main():
    kinds = sys.argv[1].split(",")
    ordered = SPEED * SPEED / speed_left(SPEED)
    first = time.perf_counter()
    roadmap = Rotating(
        number_of_neighbor_layers=3,
        vship=np.array([[ordered]]),
        WD_min=np.array([1.5]),
        WVPI=np.array([3000.0]),
        WWL=20,
        LWL=80,
        ukc=1.5,
        optimization_type=kinds,
        nodes_index=np.arange(625),
        dx_min=0.01,
        blend=0.0,
        nl=(1, 1),
    )
    roadmap.parse()
    second = time.perf_counter()
    _, moments, _ = HALEM_time((0.1, 0.1), (0.9, 0.9), T0, ordered, roadmap)
    third = time.perf_counter()
    json.dump(
        {
            "prepare_s": second - first,
            "query_s": third - second,
            "passage_s": float(np.asarray(moments)[-1] - np.asarray(moments)[0]),
            "speed": speed_left(ordered),
            "nodes": len(roadmap.nodes),
        },
        sys.stdout,
    )


main()
