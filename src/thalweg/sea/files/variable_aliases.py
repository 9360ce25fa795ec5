"""Tables of variable names: CF standard names, and the names that models and services use.

A *role* is a canonical name, or one of the other forms of a quantity: speed, direction, components
along the grid, bed level, total depth.
"""

from __future__ import annotations

from typing import Final

from thalweg.sea import standard_names as nm

X_WIND: Final = "x_wind"
Y_WIND: Final = "y_wind"
X_CURRENT: Final = "sea_water_x_velocity"
Y_CURRENT: Final = "sea_water_y_velocity"
BED_LEVEL: Final = "bed_level"
ENERGY_PERIOD: Final = "wave_energy_period"

#: role of CF standard names (and their old aliases) other than the role's own name
STANDARD_NAMES: Final[dict[str, str]] = {
    "grid_eastward_wind": X_WIND,
    "grid_northward_wind": Y_WIND,
    "surface_eastward_sea_water_velocity": nm.EASTWARD_CURRENT,
    "surface_northward_sea_water_velocity": nm.NORTHWARD_CURRENT,
    "x_sea_water_velocity": X_CURRENT,
    "y_sea_water_velocity": Y_CURRENT,
    "eastward_water_velocity": nm.EASTWARD_CURRENT,
    "northward_water_velocity": nm.NORTHWARD_CURRENT,
    "direction_of_sea_water_velocity": nm.CURRENT.towards,
    "significant_height_of_wind_and_swell_waves": nm.WAVE_HEIGHT,
    "sea_surface_wave_period_at_variance_spectral_density_maximum": nm.WAVE_PERIOD,
    "sea_surface_wave_peak_period": nm.WAVE_PERIOD,
    "sea_surface_wave_mean_period_from_variance_spectral_density_inverse_frequency_moment": (
        ENERGY_PERIOD
    ),
    "sea_surface_wave_energy_period": ENERGY_PERIOD,
    "sea_water_x_velocity_at_u_location": X_CURRENT,
    "sea_water_y_velocity_at_v_location": Y_CURRENT,
    "altitude": BED_LEVEL,
    "height": BED_LEVEL,
    "surface_altitude": BED_LEVEL,
    "bedrock_altitude": BED_LEVEL,
    "ground_level_altitude": BED_LEVEL,
    "depth": nm.BED_DEPTH,
    "depth_below_geoid": nm.BED_DEPTH,
}

#: role of the names that a source uses; all in lower case, in order of preference within a role
ALIASES: Final[dict[str, dict[str, str]]] = {
    "ECMWF": {
        "u10": nm.EASTWARD_WIND, "v10": nm.NORTHWARD_WIND, "10u": nm.EASTWARD_WIND,
        "10v": nm.NORTHWARD_WIND, "u10n": nm.EASTWARD_WIND, "v10n": nm.NORTHWARD_WIND,
        "si10": "wind_speed", "wdir10": nm.WIND.origin, "swh": nm.WAVE_HEIGHT,
        "mwd": nm.WAVES.origin, "pp1d": nm.WAVE_PERIOD, "msl": nm.PRESSURE, "siconc": nm.ICE,
        "ci": nm.ICE, "mwp": ENERGY_PERIOD,
    },
    "GFS": {
        "ugrd10m": nm.EASTWARD_WIND, "vgrd10m": nm.NORTHWARD_WIND,
        "ugrd_10maboveground": nm.EASTWARD_WIND, "vgrd_10maboveground": nm.NORTHWARD_WIND,
        "u-component_of_wind_height_above_ground": nm.EASTWARD_WIND,
        "v-component_of_wind_height_above_ground": nm.NORTHWARD_WIND,
        "msletmsl": nm.PRESSURE, "prmslmsl": nm.PRESSURE, "prmsl": nm.PRESSURE,
        "mslet": nm.PRESSURE, "pressure_reduced_to_msl_msl": nm.PRESSURE,
        "htsgwsfc": nm.WAVE_HEIGHT, "dirpwsfc": nm.WAVES.origin, "perpwsfc": nm.WAVE_PERIOD,
        "htsgw": nm.WAVE_HEIGHT, "dirpw": nm.WAVES.origin, "perpw": nm.WAVE_PERIOD,
        "icecsfc": nm.ICE,
    },
    "CMEMS": {
        "vhm0": nm.WAVE_HEIGHT, "vmdr": nm.WAVES.origin, "vtpk": nm.WAVE_PERIOD,
        "vtm10": ENERGY_PERIOD,
        "utotal": nm.EASTWARD_CURRENT, "vtotal": nm.NORTHWARD_CURRENT, "uo": X_CURRENT,
        "vo": Y_CURRENT, "zos": nm.WATER_LEVEL, "deptho": nm.BED_DEPTH,
    },
    "MET Norway": {
        "x_wind_10m": X_WIND, "y_wind_10m": Y_WIND, "wind_speed_10m": "wind_speed",
        "wind_direction_10m": nm.WIND.origin, "hs": nm.WAVE_HEIGHT, "tp": nm.WAVE_PERIOD,
        "thq": nm.WAVES.origin, "p100": nm.WAVE_HEIGHT, "ff": "wind_speed", "dd": nm.WIND.origin,
    },
    "DHI": {
        "significant wave height": nm.WAVE_HEIGHT, "sign. wave height": nm.WAVE_HEIGHT,
        "hm0": nm.WAVE_HEIGHT, "peak wave period": nm.WAVE_PERIOD,
        "mean wave direction": nm.WAVES.origin, "surface elevation": nm.WATER_LEVEL,
        "surface_elevation": nm.WATER_LEVEL, "zeta": nm.WATER_LEVEL, "u velocity": X_CURRENT,
        "v velocity": Y_CURRENT, "ucur": X_CURRENT, "vcur": Y_CURRENT, "wind speed": "wind_speed",
        "wind direction": nm.WIND.origin, "wspd": "wind_speed", "wdir": nm.WIND.origin,
        "total water depth": nm.TOTAL_DEPTH, "still water depth": nm.BED_DEPTH,
    },
    "52North": {"water_level": nm.WATER_LEVEL, "z": BED_LEVEL},
    "NEMO": {
        "uos": X_CURRENT, "vos": Y_CURRENT, "vozocrtx": X_CURRENT, "vomecrty": Y_CURRENT,
        "sozocrtx": X_CURRENT, "somecrty": Y_CURRENT, "sossheig": nm.WATER_LEVEL,
    },
    "COADS": {
        "slp": nm.PRESSURE, "uwnd": nm.EASTWARD_WIND, "vwnd": nm.NORTHWARD_WIND,
        "mslp": nm.PRESSURE,
    },
    "Delft3D-FM": {
        "mesh2d_ucx": X_CURRENT, "mesh2d_ucy": Y_CURRENT, "mesh2d_ucxa": X_CURRENT,
        "mesh2d_ucya": Y_CURRENT, "mesh2d_s1": nm.WATER_LEVEL,
        "mesh2d_waterdepth": nm.TOTAL_DEPTH, "mesh2d_node_z": BED_LEVEL,
        "mesh2d_flowelem_bl": BED_LEVEL, "mesh2d_face_z": BED_LEVEL,
    },
    "ADCIRC": {"u-vel": nm.EASTWARD_CURRENT, "v-vel": nm.NORTHWARD_CURRENT},
    "SCHISM": {
        "depthaveragevelx": X_CURRENT, "depthaveragevely": Y_CURRENT, "windspeedx": X_WIND,
        "windspeedy": Y_WIND, "sigwaveheight": nm.WAVE_HEIGHT, "peakperiod": nm.WAVE_PERIOD,
        "elev": nm.WATER_LEVEL, "depth": nm.BED_DEPTH,
    },
    "FVCOM and ROMS": {
        "ua": X_CURRENT, "va": Y_CURRENT, "ubar": X_CURRENT, "vbar": Y_CURRENT, "h": nm.BED_DEPTH,
        "uwind_speed": X_WIND, "vwind_speed": Y_WIND, "uwind": X_WIND, "vwind": Y_WIND,
        "hwave": nm.WAVE_HEIGHT,
    },
    "Matroos": {
        "velu": nm.EASTWARD_CURRENT, "velv": nm.NORTHWARD_CURRENT, "sep": nm.WATER_LEVEL,
    },
    "GEBCO and ETOPO": {"elevation": BED_LEVEL, "topo": BED_LEVEL, "band1": BED_LEVEL},
}  # fmt: skip

#: standard names used only if there is no better candidate for the role
SECOND_CHOICE_NAMES: Final[dict[str, str]] = {
    "barotropic_sea_water_x_velocity": X_CURRENT,
    "barotropic_sea_water_y_velocity": Y_CURRENT,
    "barotropic_eastward_sea_water_velocity": nm.EASTWARD_CURRENT,
    "barotropic_northward_sea_water_velocity": nm.NORTHWARD_CURRENT,
    "sea_surface_wave_from_direction_at_variance_spectral_density_maximum": nm.WAVES.origin,
}

#: names that several quantities have: ignored if their units do not fit the role
AMBIGUOUS_ALIASES: Final = frozenset(
    {
        *("z", "band1", "topo", "elevation", "ff", "dd", "hs", "tp", "ci", "zeta", "depth", "h"),
        *("ua", "va", "elev"),
    }
)

#: names of a depth that, if it varies in time, is the depth of the water and not of the bed
TIME_VARYING_DEPTHS: Final = frozenset({"depth", "water_depth", "waterdepth", "h_water"})

#: names of a bed in one file and of another quantity in the next: no bed if they vary in time
STATIC_BEDS: Final = frozenset({"z", "band1", "topo", "h"})

#: roles by long name, for variables whose names other quantities have too
LONG_NAMES: Final[dict[str, str]] = {
    "u-momentum component": X_CURRENT,
    "v-momentum component": Y_CURRENT,
    "eastward water velocity": nm.EASTWARD_CURRENT,
    "northward water velocity": nm.NORTHWARD_CURRENT,
}
LONG_NAME_SOURCE: Final = "FVCOM and ROMS"


def naming_of(quantity: str, variable: str) -> str:
    """Return how users name the variable that holds a quantity, for messages."""
    return (
        f"mapping={{{quantity!r}: {variable!r}}} in Python, --map {quantity}={variable} on the "
        f"command line, variables in a request to the service"
    )


#: reason why a known variable is not used
UNUSED_VARIABLES: Final[dict[str, str]] = {
    **dict.fromkeys(
        ("dwave", "meanwavedirection", "dominantdirection"),
        "it is a wave direction of ROMS or SCHISM, but from or to is not stated; if you know it, "
        f"name it: {naming_of('sea_surface_wave_from_direction', 'ITS_NAME')}",
    ),
    "p107": "MET Norway's local parameter 107 is a wave direction, but from or to is not "
    f"stated; if you know it, name it: {naming_of('sea_surface_wave_from_direction', 'p107')}",
}

ROLE_DIMENSIONS: Final[dict[str, str]] = {
    **dict.fromkeys((*nm.WIND.pair, *nm.CURRENT.pair, X_WIND, Y_WIND), "speed"),
    **dict.fromkeys((X_CURRENT, Y_CURRENT, "wind_speed", "sea_water_speed"), "speed"),
    **dict.fromkeys((v.towards for v in nm.VECTORS), "direction"),
    **dict.fromkeys((v.origin for v in nm.VECTORS), "direction"),
    **dict.fromkeys(
        (nm.WAVE_HEIGHT, nm.WATER_LEVEL, nm.BED_DEPTH, nm.TOTAL_DEPTH, BED_LEVEL), "length"
    ),
    **dict.fromkeys((nm.WAVE_PERIOD, ENERGY_PERIOD), "time"),
    nm.PRESSURE: "pressure",
    nm.ICE: "fraction",
}
ROLES: Final = frozenset(ROLE_DIMENSIONS)


def role_of_standard_name(name: str) -> tuple[str, int] | None:
    """Return the role of a CF standard name and its rank (0 best), or None."""
    if name in STANDARD_NAMES:
        return STANDARD_NAMES[name], 0
    if name in SECOND_CHOICE_NAMES:
        return SECOND_CHOICE_NAMES[name], 1
    if nm.is_bed_level(name):
        return BED_LEVEL, 0
    canonical = nm.canonical_name(name)
    return (canonical, 0) if canonical in ROLES else None


def role_of_alias(name: str) -> tuple[str, int, str] | None:
    """Return the role of a file's variable name, its rank of preference and its source, or None."""
    place = 0
    for source, table in ALIASES.items():
        for spelling, role in table.items():
            if spelling == name.lower():
                return role, place, source
            place += 1
    return None
