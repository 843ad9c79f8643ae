#!/usr/bin/env python3
"""Reads a map file of roadbook (GeoPackage) with Python's standard library alone.

    from roadbook_map import MapFile

    with MapFile("place.gpkg") as place:
        for pose in place.poses:
            print(pose.t_ns, pose.T_map_vehicle)

Needs Python 3.10 with SQLite 3.37 or newer. The reader opens the file for reading only and creates
no file beside it, so it works on a read-only disk. It reads schema versions 1 and 2, and raises
`BadMap` for a newer, foreign, cut or damaged file. It does not compare the digests of the tables:
`roadbook check MAP` does. docs/reference/map_file.md defines all tables.

Units are SI and radians. `T_a_b` maps coordinates in frame b to coordinates in frame a; it is a
4x4 matrix as nested lists, row by row. Frames: `map`; `frame`, one of the fixed map frames;
`vehicle` (rear axle, x forward, y left, z up); `camera` (z forward, x right, y down). Pixels are
of the full image, centre of the first pixel (0, 0). Stamps are nanoseconds since 1970 as integers.
What is not known is None, never 0 or NaN. Numbers are those of the file to the last bit.
"""

from __future__ import annotations

import argparse
import functools
import json
import math
import os
import pathlib
import signal
import sqlite3
import stat
import struct
import sys
import zlib
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

NEWEST_SCHEMA = 2
Matrix = list[list[float]]
Row = dict[str, Any]

WHEEL_VALUES = ("radius_left_m", "radius_right_m", "track_width_m", "wheelbase_m",
                "steering_ratio", "ticks_per_turn", "time_offset_s", "sigma_distance_per_sqrt_m",
                "sigma_heading_per_sqrt_m", "sigma_lateral_per_sqrt_m", "sigma_angle_rad")
VEHICLE_VALUES = ("length_m", "width_m", "height_m", "rear_overhang_m", "wheelbase_m",
                  "track_width_m")
MAP_TABLES = ("map_meta", "sessions", "session_places", "cameras", "wheel_models", "vehicles",
              "map_frames", "keyframes", "keyframe_motions", "keyframe_corners", "landmarks",
              "descriptors", "observations", "landmark_sessions", "loops", "audit")
# Maps of earlier programs lack them.
LATER_TABLES = ("vehicles", "keyframe_motions", "keyframe_corners", "landmark_sessions")


class BadMap(Exception):
    """A file that is no map this reader knows; says "FILE: FIELD: got X, want Y"."""

    def __init__(self, file: str, field: str, got: str, want: str):
        super().__init__(f"{file}: {field}: got {got}, want {want}")
        self.file, self.field, self.got, self.want = file, field, got, want


class Camera(NamedTuple):
    name: str
    model: str                #: pinhole-radtan, pinhole-equidistant, omni-radtan or ds-none
    width: int                #: [px]
    height: int               #: [px]
    max_angle_rad: float      #: largest angle from the optical axis
    time_offset_s: float      #: to add to the camera's stamps
    parameters: list[float]   #: 9 numbers, those that the model does not use are zero
    T_vehicle_camera: Matrix  #: 4x4


class Session(NamedTuple):
    """One drive in the map."""
    name: str
    drive_digest: str                  #: SHA-256 of the drive's files
    drive_path: str | None             #: relative to the map's folder
    t_begin_ns: int
    t_end_ns: int
    wheel_scale: float                 #: estimated factor on the wheels' distance
    wheel_scale_sigma: float | None
    scale_source: str                  #: wheels, camera_height or free
    scale_sigma: float | None          #: relative
    localised_share: float | None      #: of its keyframes; None: mapped without a map before it
    cameras: list[Camera]
    wheels: dict[str, float] | None    #: keys WHEEL_VALUES
    vehicle: dict[str, float | None]   #: keys VEHICLE_VALUES
    vehicle_source: str                #: none, measured, file or option


class WheelMotion(NamedTuple):
    """Motion from the session's pose before, by the wheels."""
    motion: list[float]        #: x [m], y [m], heading [rad] in the vehicle frame of that pose
    covariance: Matrix | None  #: 3x3
    distance_m: float
    reversing: bool


class Pose(NamedTuple):
    """A vehicle pose with images (keyframe). Its id is its place in the list."""
    session: int
    t_ns: int
    drive_frame: int           #: index of the images in the drive
    map_frame: int
    T_map_vehicle: Matrix      #: 4x4: map_frames[map_frame] times T_frame_vehicle
    T_frame_vehicle: Matrix    #: 4x4, as stored
    #: 6x6 of the right perturbation (x, y, z, rotation; vehicle frame), relative to the first pose
    #: of its piece, which has zeros
    covariance: Matrix | None
    travelled_m: float         #: since the session began
    reversing: bool
    after_gap: bool            #: odometry does not know the motion from the pose before
    piece: int                 #: poses of different pieces have no common place
    wheels: WheelMotion | None


class Landmark(NamedTuple):
    """A point that cameras recognise. Its id is its place in the list."""
    map_frame: int
    p_map: list[float]         #: x, y, z [m] in the map
    p_frame: list[float]       #: x, y, z [m] in its map frame, as stored
    covariance: Matrix | None  #: 3x3 [m^2], map axes, given the poses
    ground: bool               #: lies on the driven surface
    descriptor: bytes          #: 64 bytes


class Observation(NamedTuple):
    landmark: int
    pose: int
    camera: int
    u: float         #: [px]
    v: float         #: [px]
    sigma_px: float


class LoneCorner(NamedTuple):
    """A corner that no landmark explains."""
    pose: int
    camera: int
    u: float           #: [px]
    v: float           #: [px]
    descriptor: bytes  #: 64 bytes


class LandmarkSession(NamedTuple):
    """What a later session saw of a landmark."""
    landmark: int
    session: int
    expected: int        #: localised poses in whose images it lay
    seen: int            #: of them, poses that saw it
    last_ns: int | None  #: when it was seen for the last time


class Loop(NamedTuple):
    """A revisit, accepted or refused."""
    from_pose: int
    to_pose: int
    T_from_to: Matrix    #: 4x4
    information: Matrix  #: 6x6 of the right perturbation
    inliers: int
    accepted: bool
    weight: float        #: of the robust solver, 0 to 1
    reason: str


class Geometry(NamedTuple):
    """A geometry in the map frame [m]."""
    type: str          #: Point, LineString, Polygon, MultiPoint, MultiLineString, MultiPolygon
    axes: str          #: xy, xyz, xym or xyzm; the meaning of m depends on the layer
    coordinates: Any   #: as in GeoJSON: point (x, y, ...); line: points; polygon: rings of points


class Level(NamedTuple):
    """A zoom level of a raster; the largest zoom has all pixels."""
    zoom: int
    columns: int      #: of tiles
    rows: int         #: of tiles
    tile_width: int   #: [px]
    tile_height: int  #: [px]
    pixel_x_m: float
    pixel_y_m: float


class Raster(NamedTuple):
    """Georeference of a raster: x grows with columns, y falls with rows."""
    name: str
    description: str
    corner: tuple[float, float]        #: outer corner of the first pixel of tile (0, 0): x, y [m]
    extent: tuple[float, ...] | None   #: of what is shown: least x, least y, most x, most y [m]
    levels: list[Level]                #: ascending in zoom
    #: row of gpkg_2d_gridded_coverage_ancillary (datatype, scale, offset, data_null), or None
    coverage: Row | None


class Tile(NamedTuple):
    zoom: int
    column: int
    row: int
    corner: tuple[float, float]  #: outer corner of the first pixel: x, y [m]
    data: bytes                  #: a PNG, or a TIFF of UInt16 or Float32


class _Fault(Exception):
    """got, want"""


def _kind(kind: type, name: str) -> Callable[[Any], Any]:
    def convert(value: Any) -> Any:
        if type(value) is not kind:
            raise _Fault("nothing" if value is None else repr(value)[:60], name)
        return value
    return convert


_integer, _real = _kind(int, "an integer"), _kind(float, "a number")
_text, _bytes = _kind(str, "a text"), _kind(bytes, "bytes")


def _flag(value: Any) -> bool:
    return _integer(value) != 0


def _optional(convert: Callable[[Any], Any]) -> Callable[[Any], Any]:
    return lambda value: None if value is None else convert(value)


def _index(size: int) -> Callable[[Any], int]:
    def convert(value: Any) -> int:
        if not 0 <= _integer(value) < size:
            raise _Fault(str(value), f"an index below {size}")
        return value
    return convert


def _numbers(value: Any, count: int) -> list[float]:
    if len(_bytes(value)) != 8 * count:
        raise _Fault(f"{len(value)} bytes", f"{8 * count} bytes")
    return list(struct.unpack(f"<{count}d", value))


def _matrix(rows: int, columns: int) -> Callable[[Any], Matrix]:
    def convert(value: Any) -> Matrix:
        numbers = _numbers(value, rows * columns)
        if not all(map(math.isfinite, numbers)):
            raise _Fault("a number that is not finite", "finite numbers")
        return [numbers[columns * r:columns * (r + 1)] for r in range(rows)]
    return convert


def _pose(value: Any) -> Matrix:
    return _matrix(3, 4)(value) + [[0.0, 0.0, 0.0, 1.0]]


def _covariance(size: int) -> Callable[[Any], Matrix | None]:
    def convert(value: Any) -> Matrix | None:
        if value is None or not all(map(math.isfinite, _numbers(value, size * size))):
            return None
        return _matrix(size, size)(value)
    return convert


def _transform(T: Matrix, p: list[float]) -> list[float]:
    return [row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] for row in T[:3]]


def _product(A: Matrix, B: Matrix) -> Matrix:
    rotation = [[a[0] * B[0][c] + a[1] * B[1][c] + a[2] * B[2][c] for c in range(3)]
                for a in A[:3]]
    place = _transform(A, [B[0][3], B[1][3], B[2][3]])
    return [[*rotation[r], place[r]] for r in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'


class _Wkb:
    """Well-known binary (ISO): byte order, type + 1000 (Z), 2000 (M) or 3000 (ZM), numbers."""

    def __init__(self, data: bytes, at: int):
        self.data, self.at = data, at

    def take(self, order: str, kind: str, count: int = 1) -> tuple[Any, ...]:
        size = count * struct.calcsize("<" + kind)
        if size > len(self.data) - self.at:
            raise _Fault("a geometry that is cut", "a whole one")
        self.at += size
        return struct.unpack_from(f"{order}{count}{kind}", self.data, self.at - size)

    def points(self, order: str, axes: int) -> list[tuple[float, ...]]:
        numbers = self.take(order, "d", axes * self.take(order, "I")[0])
        return [numbers[i:i + axes] for i in range(0, len(numbers), axes)]

    def geometry(self, part_of: int = 0) -> Geometry:
        order = "<" if self.take("<", "B")[0] == 1 else ">"
        dimensions, kind = divmod(self.take(order, "I")[0], 1000)
        if dimensions > 3 or not 1 <= kind <= (6 if part_of == 0 else 3):
            raise _Fault(f"geometry type {1000 * dimensions + kind}", "a point, line or polygon")
        axes = ("xy", "xyz", "xym", "xyzm")[dimensions]
        coordinates: Any
        if kind == 1:
            point = self.take(order, "d", len(axes))
            coordinates = None if math.isnan(point[0]) else point  # POINT EMPTY
        elif kind == 2:
            coordinates = self.points(order, len(axes))
        elif kind == 3:
            rings = self.take(order, "I")[0]
            coordinates = [self.points(order, len(axes)) for _ in range(rings)]
        else:
            parts = self.take(order, "I")[0]
            coordinates = [self.geometry(kind).coordinates for _ in range(parts)]
        names = ("Point", "LineString", "Polygon", "MultiPoint", "MultiLineString", "MultiPolygon")
        return Geometry(names[kind - 1], axes, coordinates)


def _geometry(value: Any) -> Geometry:
    """From GeoPackage's binary: "GP", version, flags, srs_id, envelope, well-known binary."""
    if len(_bytes(value)) < 8 or value[:2] != b"GP" or value[3] >> 1 & 7 > 4:
        raise _Fault("other bytes", "a GeoPackage geometry")
    return _Wkb(value, 8 + (0, 32, 48, 48, 64)[value[3] >> 1 & 7]).geometry()


class MapFile:
    """A map file, open for reading. Close it, or use it in a `with` statement.

    `path`: of the file. Raises BadMap for a file that is missing, not complete, damaged or newer.
    Properties read their tables at first use and keep them; they, too, raise BadMap, with table,
    row and column. Lists are in the order of ids, which count from 0.
    """

    def __init__(self, path: str | os.PathLike[str]):
        self.path = os.fspath(path)
        self._db: sqlite3.Connection | None = None
        mode = self._mode_to_open()
        uri = pathlib.Path(os.path.realpath(self.path)).as_uri()
        try:
            self._db = sqlite3.connect(f"{uri}?{mode}", uri=True, isolation_level=None)
            self._check()
        except sqlite3.Error as error:
            self.close()
            raise self._bad("database", str(error), "an undamaged map file") from None
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        if self._db is not None:
            self._db.close()
        self._db = None

    def __enter__(self) -> MapFile:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @functools.cached_property
    def sessions(self) -> list[Session]:
        fields = {"id": _integer, "name": _text, "drive_digest": _text, "t_begin_ns": _integer,
                  "t_end_ns": _integer, "wheel_scale": _real, "wheel_scale_sigma": _optional(_real),
                  "scale_source": _text, "scale_sigma": _optional(_real),
                  "localised_share": _optional(_real)}
        rows = self._numbered("sessions", fields)
        which = _index(len(rows))
        paths = {r["session"]: r["drive_path"] for r in
                 self._read("session_places", {"session": which, "drive_path": _text})}
        cameras: list[list[Camera]] = [[] for _ in rows]
        for r in self._read("cameras", {
                "session": which, "camera": _integer, "name": _text, "model": _text,
                "width": _integer, "height": _integer, "max_angle_rad": _real,
                "time_offset_s": _real, "parameters": _matrix(1, 9), "T_vehicle_camera": _pose}):
            own = cameras[r.pop("session")]
            if r.pop("camera") != len(own):
                raise self._bad("cameras", "a number twice or a gap", "numbers from 0")
            own.append(Camera(**r | {"parameters": r["parameters"][0]}))
        wheels = {r.pop("session"): r for r in
                  self._read("wheel_models", {"session": which} | dict.fromkeys(WHEEL_VALUES, _real))}
        vehicles = {r.pop("session"): r for r in self._read(
            "vehicles", {"session": which, "source": _text}
            | dict.fromkeys(VEHICLE_VALUES, _optional(_real)))}
        sessions = []
        for i, r in enumerate(rows):
            vehicle = vehicles.get(i, {"source": "none"} | dict.fromkeys(VEHICLE_VALUES))
            source = vehicle.pop("source")
            for key in ("wheel_scale_sigma", "scale_sigma"):
                if self._zero_is_unknown and r[key] == 0.0:
                    r[key] = None
            sessions.append(Session(**r, drive_path=paths.get(i), cameras=cameras[i],
                                    wheels=wheels.get(i), vehicle=vehicle, vehicle_source=source))
        return sessions

    @functools.cached_property
    def map_frames(self) -> list[Matrix]:
        """T_map_frame (4x4) of each frame that is fixed in the map."""
        return [r["T_map_frame"] for r in
                self._numbered("map_frames", {"id": _integer, "T_map_frame": _pose})]

    @functools.cached_property
    def poses(self) -> list[Pose]:
        """All keyframes: session by session, ascending in time."""
        fields = {"id": _integer, "session": _index(len(self.sessions)), "t_ns": _integer,
                  "drive_frame": _integer, "map_frame": _index(len(self.map_frames)),
                  "T_frame_vehicle": _pose, "covariance": _covariance(6), "travelled_m": _real,
                  "reversing": _flag, "after_gap": _flag, "piece": _optional(_integer)}
        rows = self._numbered("keyframes", fields)
        motions = {r.pop("keyframe"): r for r in self._read("keyframe_motions", {
            "keyframe": _index(len(rows)), "motion": _matrix(1, 3), "covariance": _covariance(3),
            "distance_m": _real, "reversing": _flag})}
        zero = [[0.0] * 6] * 6
        any_known = any(r["covariance"] != zero for r in rows)
        poses = []
        for i, r in enumerate(rows):
            if self._zero_is_unknown and r["covariance"] == zero and (i > 0 or not any_known):
                r["covariance"] = None
            r["piece"] = r["piece"] or 0  # maps of earlier programs have one piece
            m = motions.get(i)
            wheels = WheelMotion(**m | {"motion": m["motion"][0]}) if m else None
            T = _product(self.map_frames[r["map_frame"]], r["T_frame_vehicle"])
            poses.append(Pose(**r, T_map_vehicle=T, wheels=wheels))
        return poses

    @functools.cached_property
    def landmarks(self) -> list[Landmark]:
        fields = {"id": _integer, "map_frame": _index(len(self.map_frames)), "x": _real, "y": _real,
                  "z": _real, "covariance": _covariance(3), "ground": _flag}
        rows = self._numbered("landmarks", fields)
        descriptors = {r["landmark"]: r["data"] for r in
                       self._read("descriptors", {"landmark": _index(len(rows)), "data": _bytes})}
        if len(descriptors) != len(rows) or any(len(d) != 64 for d in descriptors.values()):
            raise self._bad("descriptors", "some missing or of another size",
                            f"{len(rows)} of 64 bytes")
        zero = [[0.0] * 3] * 3
        landmarks = []
        for i, r in enumerate(rows):
            p = [r["x"], r["y"], r["z"]]
            unknown = self._zero_is_unknown and r["covariance"] == zero
            landmarks.append(Landmark(r["map_frame"], _transform(self.map_frames[r["map_frame"]], p),
                                      p, None if unknown else r["covariance"], r["ground"],
                                      descriptors[i]))
        return landmarks

    def observations(self) -> Iterator[Observation]:
        """Yields all observations of landmarks, pose by pose, camera by camera."""
        landmarks = self._count("landmarks")
        for pose, camera, data in self._packed("observations", 16):
            for landmark, u, v, sigma_px in struct.iter_unpack("<ifff", data):
                if not 0 <= landmark < landmarks:
                    raise self._bad("observations", f"landmark {landmark}",
                                    "a landmark of the map")
                yield Observation(landmark, pose, camera, u, v, sigma_px)

    def corners(self) -> Iterator[LoneCorner]:
        """Yields the corners that no landmark explains, pose by pose, camera by camera."""
        for pose, camera, data in self._packed("keyframe_corners", 72):
            for u, v, descriptor in struct.iter_unpack("<ff64s", data):
                yield LoneCorner(pose, camera, u, v, descriptor)

    @functools.cached_property
    def landmark_sessions(self) -> list[LandmarkSession]:
        return [LandmarkSession(**r) for r in self._read("landmark_sessions", {
            "landmark": _index(self._count("landmarks")), "session": _index(len(self.sessions)),
            "expected": _integer, "seen": _integer, "last_ns": _optional(_integer)})]

    @functools.cached_property
    def loops(self) -> list[Loop]:
        pose = _index(self._count("keyframes"))
        fields = {"from_keyframe": pose, "to_keyframe": pose, "T_from_to": _pose,
                  "information": _matrix(6, 6), "inliers": _integer, "accepted": _flag,
                  "weight": _real, "reason": _text}
        return [Loop(*r.values()) for r in self._read("loops", fields)]

    @functools.cached_property
    def history(self) -> list[tuple[str, str]]:
        """What was done to the map: action and detail, oldest first."""
        return [(r["action"], r["detail"]) for r in
                self._read("audit", {"action": _text, "detail": _text})]

    def layer_names(self) -> list[str]:
        """Names of the vector layers, such as poses, lanes, parking_spaces."""
        return self._contents("features")

    def layer(self, name: str) -> list[Row]:
        """Rows of a vector layer; `geom` is a Geometry or None. KeyError: no such layer."""
        if name not in self.layer_names():
            raise KeyError(f"{self.path} has no layer {name}")
        sql = "SELECT column_name FROM gpkg_geometry_columns WHERE table_name = ?"
        column = next(self._rows(sql, name), {"column_name": "geom"})["column_name"]
        return list(self._read(name, {column: _optional(_geometry)}, all_columns=True))

    def table_names(self) -> list[str]:
        """Names of plain tables, neither layers nor those of the map itself or of the format."""
        other = {*MAP_TABLES, *self._contents("features"), *self.raster_names()}
        return sorted(n for n in self._tables if n not in other
                      and not n.startswith(("gpkg_", "rtree_", "sqlite_")))

    def table(self, name: str) -> list[Row]:
        """Rows of any table, values as stored, BLOBs as bytes. KeyError: no such table."""
        if name not in self._tables:
            raise KeyError(f"{self.path} has no table {name}")
        return list(self._rows(f"SELECT * FROM {_quoted(name)} ORDER BY rowid"))

    def raster_names(self) -> list[str]:
        return self._contents("tiles") + self._contents("2d-gridded-coverage")

    def raster(self, name: str) -> Raster:
        """Georeference of a raster. KeyError: no such raster."""
        if name not in self.raster_names():
            raise KeyError(f"{self.path} has no raster {name}")
        (about,) = self._rows("SELECT * FROM gpkg_contents WHERE table_name = ?", name)
        edges = tuple(about[k] for k in ("min_x", "min_y", "max_x", "max_y"))
        where = "WHERE table_name = ? ORDER BY rowid"
        sets = list(self._read("gpkg_tile_matrix_set", {"min_x": _real, "max_y": _real},
                               "WHERE table_name = ?", (name,)))
        if len(sets) != 1:
            raise self._bad(f"gpkg_tile_matrix_set {name}", f"{len(sets)} rows", "one")
        levels = [Level(*r.values()) for r in self._read("gpkg_tile_matrix", {
            "zoom_level": _integer, "matrix_width": _integer, "matrix_height": _integer,
            "tile_width": _integer, "tile_height": _integer, "pixel_x_size": _real,
            "pixel_y_size": _real}, "WHERE table_name = ? ORDER BY zoom_level", (name,))]
        ancillary = "gpkg_2d_gridded_coverage_ancillary"
        coverage = None
        if ancillary in self._tables:
            sql = f"SELECT * FROM {ancillary} {where.replace('table_name', 'tile_matrix_set_name')}"
            coverage = next(self._rows(sql, name), None)
        return Raster(name, about["description"] or "", (sets[0]["min_x"], sets[0]["max_y"]),
                      None if None in edges else edges, levels, coverage)

    def tiles(self, name: str, zoom: int | None = None) -> Iterator[Tile]:
        """Yields the tiles of a raster at `zoom`, or of its largest; empty tiles are left out."""
        raster = self.raster(name)
        levels = {level.zoom: level for level in raster.levels}
        level = levels.get(max(levels, default=0) if zoom is None else zoom)
        if level is None:
            raise KeyError(f"{self.path} has no zoom {zoom} of {name}")
        fields = {"tile_column": _index(level.columns), "tile_row": _index(level.rows),
                  "tile_data": _bytes}
        for r in self._read(name, fields, "WHERE zoom_level = ? ORDER BY tile_row, tile_column",
                            (level.zoom,)):
            column, row, data = r.values()
            corner = (raster.corner[0] + column * level.tile_width * level.pixel_x_m,
                      raster.corner[1] - row * level.tile_height * level.pixel_y_m)
            yield Tile(level.zoom, column, row, corner, data)

    # ---- opening ----

    def _bad(self, field: str, got: str, want: str) -> BadMap:
        return BadMap(self.path, field, got, want)

    def _mode_to_open(self) -> str:
        try:
            status = os.stat(self.path)
            if not stat.S_ISREG(status.st_mode):
                raise self._bad("map", "no regular file", "a map file")
            with open(self.path, "rb") as file:
                header = file.read(100)
        except FileNotFoundError:
            raise self._bad("map", "no such file", "a map file") from None
        except (OSError, ValueError) as error:
            raise self._bad("map", str(error), "a readable file") from None
        if len(header) < 100 or not header.startswith(b"SQLite format 3\0"):
            raise self._bad("map", "no SQLite database", "a map written by roadbook")
        beside = os.path.realpath(self.path)
        page, pages = struct.unpack_from(">H", header, 16)[0], struct.unpack_from(">I", header, 28)[0]
        whole = pages * (65536 if page == 1 else page)
        journal = os.path.exists(beside + "-journal")
        if header[24:28] == header[92:96] and status.st_size < whole and not journal:
            raise self._bad("size", f"{status.st_size} bytes", f"{whole} bytes: the file is cut")
        self._budget_of_query = 200 + status.st_size // 2000
        if 2 not in header[18:20]:
            return "mode=ro"
        # Another program left the file in WAL mode. SQLite would then make a -shm file beside it,
        # and fail on a read-only disk. Without changes in a -wal file, the file itself is whole, and
        # `immutable` reads it without locks.
        if os.path.exists(beside + "-wal") and os.path.getsize(beside + "-wal") > 0:
            raise self._bad("map", "changes of another program that are not in the file (-wal)",
                            "a map that no other program has open")
        return "mode=ro&immutable=1"

    def _check(self) -> None:
        assert self._db is not None
        # A damaged file must not make a query run for ever: each has steps in proportion to the file.
        self._steps_left = 0

        def spend() -> bool:
            self._steps_left -= 1
            return self._steps_left < 0

        self._db.set_progress_handler(spend, 100_000)
        self._query("PRAGMA trusted_schema = OFF")
        self._query("PRAGMA cell_size_check = ON")
        objects = self._query("SELECT type, name, sql FROM sqlite_master")
        for kind, name, sql in objects:
            virtual = str(sql).upper().startswith("CREATE VIRTUAL")
            if kind == "view" or virtual and " USING rtree(" not in sql.replace('"', ""):
                raise self._bad("schema", f"{kind} {name}", "only tables that roadbook writes")
        self._tables = {name for kind, name, _ in objects if kind == "table"}
        fault = self._query("PRAGMA quick_check(1)")[0][0]
        if fault != "ok":
            raise self._bad("quick_check", str(fault), "ok")
        if "map_meta" not in self._tables:
            raise self._bad("map_meta", "no such table", "a map written by roadbook")
        #: key to value of `map_meta`: schema_version, state, digest, seed, options, ...
        self.meta: dict[str, str] = {
            r["key"]: r["value"] for r in self._read("map_meta", {"key": _text, "value": _text})}
        version = self.meta.get("schema_version", "nothing")
        if not (version.isascii() and version.isdigit()) or int(version[:9]) < 1:
            raise self._bad("schema_version", version, "a number from 1")
        if int(version[:9]) > NEWEST_SCHEMA:
            raise self._bad("schema_version", version + ", of a newer roadbook",
                            f"at most {NEWEST_SCHEMA}")
        if self.meta.get("state") != "complete":
            raise self._bad("state", self.meta.get("state", "nothing"), "complete")

    # ---- rows ----

    def _rows(self, sql: str, *values: Any) -> Iterator[Row]:
        if self._db is None:
            raise ValueError(f"{self.path} is closed")
        try:
            self._steps_left = self._budget_of_query
            cursor = self._db.execute(sql, values)
            names = [column[0] for column in cursor.description or ()]
            for row in cursor:
                yield dict(zip(names, row))
        except (sqlite3.Error, sqlite3.Warning, ValueError, MemoryError) as error:
            # ValueError: names that are no UTF-8
            raise self._bad("database", str(error) or "no memory", "an undamaged map file") from None

    def _query(self, sql: str) -> list[tuple[Any, ...]]:
        return [tuple(row.values()) for row in self._rows(sql)]

    def _read(self, table: str, fields: dict[str, Callable[[Any], Any]], where: str = "",
              values: tuple[Any, ...] = (), all_columns: bool = False) -> Iterator[Row]:
        """Yields the rows with `fields` converted and checked; a column that is missing is None."""
        if table not in self._tables:
            if table in LATER_TABLES:
                return
            raise self._bad(table, "no such table", "a map written by roadbook")
        sql = f"SELECT * FROM {_quoted(table)} {where or 'ORDER BY rowid'}"
        for number, row in enumerate(self._rows(sql, *values)):
            read = dict(row) if all_columns else {}
            for name, convert in fields.items():
                try:
                    read[name] = convert(row.get(name))
                except _Fault as fault:
                    raise self._bad(f"{table} row {number} {name}", *fault.args) from None
            yield read

    def _numbered(self, table: str, fields: dict[str, Callable[[Any], Any]]) -> list[Row]:
        """The rows, whose ids must count from 0; without the ids."""
        rows = list(self._read(table, fields))
        for number, row in enumerate(rows):
            if row.pop("id") != number:
                raise self._bad(f"{table} row {number} id", "another number", str(number))
        return rows

    def _packed(self, table: str, size: int) -> Iterator[tuple[int, int, bytes]]:
        """Pose, camera and data of rows that have `count` records of `size` bytes."""
        fields = {"keyframe": _index(len(self.poses)), "camera": _integer, "count": _integer,
                  "data": _bytes}
        for number, r in enumerate(self._read(table, fields)):
            if not 0 <= r["camera"] < len(self.sessions[self.poses[r["keyframe"]].session].cameras):
                raise self._bad(f"{table} row {number} camera", str(r["camera"]),
                                "a camera of the session")
            if len(r["data"]) != size * r["count"]:
                raise self._bad(f"{table} row {number} data", f"{len(r['data'])} bytes",
                                f"{r['count']} times {size}")
            yield r["keyframe"], r["camera"], r["data"]

    def _count(self, table: str, what: str = "count(*)") -> int:
        return self._query(f"SELECT {what} FROM {_quoted(table)}")[0][0] or 0

    def _contents(self, data_type: str) -> list[str]:
        if "gpkg_contents" not in self._tables:
            return []
        sql = "SELECT table_name FROM gpkg_contents WHERE data_type = ? ORDER BY table_name"
        return [r["table_name"] for r in self._rows(sql, data_type)
                if r["table_name"] in self._tables]

    @functools.cached_property
    def _zero_is_unknown(self) -> bool:
        """Earlier programs wrote zero for unknown; their tables do not allow NULL."""
        columns = self._rows("PRAGMA table_info(keyframes)")
        return any(c["name"] == "covariance" and c["notnull"] for c in columns)


def tum_line(pose: Pose) -> str:
    """`t_s x y z qx qy qz qw` in the map, nine decimals, as `roadbook export --format tum`."""
    R = [row[:3] for row in pose.T_map_vehicle[:3]]
    trace = R[0][0] + R[1][1] + R[2][2]
    q = [0.0] * 4  # x, y, z, w
    if trace > 0.0:
        root = math.sqrt(trace + 1.0)
        q = [(R[(i + 2) % 3][(i + 1) % 3] - R[(i + 1) % 3][(i + 2) % 3]) * 0.5 / root
             for i in range(3)] + [0.5 * root]
    else:
        i = max(range(3), key=lambda axis: R[axis][axis])
        j, k = (i + 1) % 3, (i + 2) % 3
        root = math.sqrt(R[i][i] - R[j][j] - R[k][k] + 1.0)
        q[i], q[3] = 0.5 * root, (R[k][j] - R[j][k]) * 0.5 / root
        q[j], q[k] = (R[j][i] + R[i][j]) * 0.5 / root, (R[k][i] + R[i][k]) * 0.5 / root
    norm = math.sqrt(sum(x * x for x in q))
    place = [row[3] for row in pose.T_map_vehicle[:3]]
    sign, t_ns = "-" if pose.t_ns < 0 else "", abs(pose.t_ns)
    numbers = [f"{x:.9f}" for x in [*place, *(x / norm for x in q)]]
    return f"{sign}{t_ns // 10**9}.{t_ns % 10**9:09d} " + " ".join(numbers)


def summary(place: MapFile) -> dict[str, Any]:
    """What the map holds, in few numbers, ready for JSON."""
    poses, landmarks = place.poses, place.landmarks
    xy = [(p.T_map_vehicle[0][3], p.T_map_vehicle[1][3]) for p in poses]
    end_m: dict[int, float] = {p.session: p.travelled_m for p in poses}
    return {
        "file": place.path, "schema_version": int(place.meta["schema_version"]),
        "digest": place.meta.get("digest"),
        "sessions": [{"name": s.name, "drive": s.drive_path, "t_begin_ns": s.t_begin_ns,
                      "t_end_ns": s.t_end_ns, "poses": sum(p.session == i for p in poses),
                      "travelled_m": end_m.get(i), "cameras": len(s.cameras),
                      "scale_source": s.scale_source, "localised_share": s.localised_share}
                     for i, s in enumerate(place.sessions)],
        "poses": len(poses), "poses_with_covariance": sum(p.covariance is not None for p in poses),
        "pieces": len({p.piece for p in poses}), "gaps": sum(p.after_gap for p in poses),
        "extent_m": [f(axis) for f in (min, max) for axis in zip(*xy)] if xy else None,
        "landmarks": len(landmarks), "landmarks_on_ground": sum(m.ground for m in landmarks),
        "landmarks_with_covariance": sum(m.covariance is not None for m in landmarks),
        "observations": place._count("observations", "sum(count)"),
        "loops_accepted": sum(loop.accepted for loop in place.loops), "loops": len(place.loops),
        "layers": place.layer_names(), "rasters": place.raster_names(),
        "tables": place.table_names(), "changes": len(place.history),
        "last_change": place.history[-1][0] if place.history else None}


def summary_text(of: dict[str, Any]) -> str:
    """The summary in a dozen lines."""
    sessions = ", ".join(f"{s['name']} ({s['poses']} poses, {s['travelled_m'] or 0.0:.1f} m)"
                         for s in of["sessions"]) or "none"
    extent = "unknown"
    if of["extent_m"]:
        x0, y0, x1, y1 = of["extent_m"]
        extent = f"x {x0:.1f} to {x1:.1f} m, y {y0:.1f} to {y1:.1f} m"
    lines = {
        "map": f"{of['file']}, schema version {of['schema_version']}",
        "digest": of["digest"] or "none", "sessions": sessions,
        "poses": f"{of['poses']}, {of['poses_with_covariance']} with covariance; "
                 f"pieces: {of['pieces']}; after gaps: {of['gaps']}",
        "extent": extent,
        "landmarks": f"{of['landmarks']}, {of['landmarks_on_ground']} on the ground, "
                     f"{of['landmarks_with_covariance']} with covariance",
        "observations": str(of["observations"]),
        "loops": f"{of['loops']}, {of['loops_accepted']} accepted",
        "layers": ", ".join(of["layers"]) or "none",
        "rasters": ", ".join(of["rasters"]) or "none",
        "tables": ", ".join(of["tables"]) or "none",
        "changes": f"{of['changes']}, last: {of['last_change'] or 'none'}"}
    return "\n".join(f"{name + ':':14}{text}" for name, text in lines.items())


def main() -> int:
    if hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # `| head` is no error
    parser = argparse.ArgumentParser(description="Reads a map file of roadbook.")
    parser.add_argument("map", metavar="MAP")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--tum", action="store_true", help="print the poses as a TUM trajectory")
    what.add_argument("--json", action="store_true", help="print the summary as JSON")
    parser.add_argument("--session", metavar="NAME", help="with --tum: poses of this session alone")
    options = parser.parse_args()
    try:
        with MapFile(options.map) as place:
            if not options.tum:
                of = summary(place)
                print(json.dumps(of, indent=2) if options.json else summary_text(of))
                return 0
            names = [s.name for s in place.sessions]
            if options.session not in (None, *names):
                raise BadMap(options.map, "session", options.session, ", ".join(names))
            for i, name in enumerate(names):
                if options.session in (None, name):
                    print(f"# session {name}" if options.session is None else "", end="\n" if
                          options.session is None else "")
                    print(*(tum_line(p) for p in place.poses if p.session == i), sep="\n")
            return 0
    except BadMap as bad:
        print(f"error: {bad}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
