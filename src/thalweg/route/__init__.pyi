from thalweg.route.ensemble_evaluation import (
    EnsembleResult,
    MemberStatistics,
    cvar,
    evaluate_members,
)
from thalweg.route.formats import (
    RouteFileOptions,
    read_track,
    write_csv,
    write_geojson,
    write_gpx,
    write_kml,
    write_route_files,
    write_rtz,
    write_rtzp,
    write_s421,
)
from thalweg.route.referee.evaluation import evaluate
from thalweg.route.referee.wind_speed_only import with_wind_speed
from thalweg.route.refinement.better_route import (
    RefinementConditions,
    better_route,
    shorten_waits,
)
from thalweg.route.refinement.cost_refinement import refine_cost
from thalweg.route.refinement.smoothing import smooth
from thalweg.route.route import Route, Violation
from thalweg.route.route_concatenation import join
from thalweg.route.track import Track

__all__ = [
    "EnsembleResult",
    "MemberStatistics",
    "RefinementConditions",
    "Route",
    "RouteFileOptions",
    "Track",
    "Violation",
    "better_route",
    "cvar",
    "evaluate",
    "evaluate_members",
    "join",
    "read_track",
    "refine_cost",
    "shorten_waits",
    "smooth",
    "with_wind_speed",
    "write_csv",
    "write_geojson",
    "write_gpx",
    "write_kml",
    "write_route_files",
    "write_rtz",
    "write_rtzp",
    "write_s421",
]
