#!/usr/bin/env python3
"""Reads a map file of roadbook (GeoPackage) with Python's standard library alone.

    from roadbook_map import MapFile

    with MapFile("place.gpkg") as place:
        for pose in place.poses:
            print(pose.t_ns, pose.T_map_vehicle)

Needs this file, roadbook_geopackage.py beside it, and Python 3.10 with SQLite 3.37 or newer. The
file is opened for reading only and no file is created beside it, so a read-only disk will do.
Schema versions 1 and 2 are read; `BadMap` is raised for a newer, foreign, cut or damaged file.
Digests of the tables are not compared: `roadbook check MAP` does that. All tables are defined in
docs/reference/map_file.md.

Units are SI and radians. `T_a_b` maps coordinates in frame b to coordinates in frame a; it is a
4x4 matrix as nested lists, row by row. Frames: `map`; `frame`, one of the fixed map frames;
`vehicle` (rear axle, x forward, y left, z up); `camera` (z forward, x right, y down). Pixels are
of the full image, centre of the first pixel (0, 0). Stamps are nanoseconds since 1970 as integers.
What is not known is None, never 0 or NaN. Numbers are those of the file to the last bit, and the
products T_map_vehicle and p_map are those of the library on x86-64.
"""

from __future__ import annotations

import argparse
import functools
import json
import math
import os
import signal
import struct
import sys
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from roadbook_geopackage import (BadMap, Fields, GeoPackage, Geometry, Level, Raster, Row, Tile,
                                 as_bytes, as_flag, as_index, as_integer, as_matrix, as_numbers,
                                 as_optional, as_real, as_text)

__all__ = ["BadMap", "Camera", "Geometry", "Landmark", "LandmarkSession", "Level", "LoneCorner",
           "Loop", "MapFile", "Observation", "Pose", "Raster", "Session", "Tile", "WheelMotion"]

NEWEST_SCHEMA = 2
Matrix = list[list[float]]

WHEEL_VALUES = ("radius_left_m", "radius_right_m", "track_width_m", "wheelbase_m",
                "steering_ratio", "ticks_per_turn", "time_offset_s", "sigma_distance_per_sqrt_m",
                "sigma_heading_per_sqrt_m", "sigma_lateral_per_sqrt_m", "sigma_angle_rad")
VEHICLE_VALUES = ("length_m", "width_m", "height_m", "rear_overhang_m", "wheelbase_m",
                  "track_width_m")


class Camera(NamedTuple):
    """A camera on the vehicle, as calibrated.

    model: pinhole-radtan, pinhole-equidistant, omni-radtan or ds-none
    width: [px]
    height: [px]
    max_angle_rad: largest angle from the optical axis
    time_offset_s: to add to the camera's stamps
    parameters: 9 numbers, those that the model does not use are zero
    T_vehicle_camera: 4x4
    exposed_after_s: of the middle row, after the stamp; the map's corners are moved to the stamp
    rolling_shutter_s: from the exposure of the first row to that of the last
    """

    name: str
    model: str
    width: int
    height: int
    max_angle_rad: float
    time_offset_s: float
    parameters: list[float]
    T_vehicle_camera: Matrix
    exposed_after_s: float
    rolling_shutter_s: float


class Session(NamedTuple):
    """One drive in the map.

    drive_digest: SHA-256 of the drive's files
    drive_path: relative to the map's folder
    wheel_scale: estimated factor on the wheels' distance; wheel_scale_sigma: its deviation
    scale_source: wheels, camera_height or free
    scale_sigma: relative deviation of the scale of the poses
    localised_share: of its keyframes; None: mapped without a map before it
    wheels: keys WHEEL_VALUES
    vehicle: keys VEHICLE_VALUES
    vehicle_source: none, measured, file or option
    """

    name: str
    drive_digest: str
    drive_path: str | None
    t_begin_ns: int
    t_end_ns: int
    wheel_scale: float
    wheel_scale_sigma: float | None
    scale_source: str
    scale_sigma: float | None
    localised_share: float | None
    cameras: list[Camera]
    wheels: dict[str, float] | None
    vehicle: dict[str, float | None]
    vehicle_source: str


class WheelMotion(NamedTuple):
    """Motion from the session's pose before, by the wheels.

    motion: x [m], y [m], heading [rad] in the vehicle frame of that pose
    covariance: 3x3, of the motion
    distance_m: along the path, at least 0
    """

    motion: list[float]
    covariance: Matrix | None
    distance_m: float
    reversing: bool


class Pose(NamedTuple):
    """A vehicle pose with images (keyframe). Its id is its place in the list.

    drive_frame: index of the images in the drive
    map_frame: index of its frame in map_frames
    T_map_vehicle: 4x4, map_frames[map_frame] times T_frame_vehicle
    T_frame_vehicle: 4x4, as stored
    covariance: 6x6 of the right perturbation (x, y, z [m], then rotation [rad]; vehicle frame),
        relative to the first pose of its piece, which has zeros
    travelled_m: since the session began
    after_gap: odometry does not know the motion from the pose before
    piece: poses of different pieces have no common place
    """

    session: int
    t_ns: int
    drive_frame: int
    map_frame: int
    T_map_vehicle: Matrix
    T_frame_vehicle: Matrix
    covariance: Matrix | None
    travelled_m: float
    reversing: bool
    after_gap: bool
    piece: int
    wheels: WheelMotion | None


class Landmark(NamedTuple):
    """A point that cameras recognise. Its id is its place in the list.

    p_map: x, y, z [m] in the map
    p_frame: x, y, z [m] in its map frame, as stored
    covariance: 3x3 [m^2], map axes, given the poses
    ground: lies on the driven surface
    descriptor: 64 bytes
    """

    map_frame: int
    p_map: list[float]
    p_frame: list[float]
    covariance: Matrix | None
    ground: bool
    descriptor: bytes


class Observation(NamedTuple):
    """A landmark in an image of a pose.

    u: [px]
    v: [px]
    """

    landmark: int
    pose: int
    camera: int
    u: float
    v: float
    sigma_px: float


class LoneCorner(NamedTuple):
    """A corner that no landmark explains.

    u: [px]
    v: [px]
    descriptor: 64 bytes
    """

    pose: int
    camera: int
    u: float
    v: float
    descriptor: bytes


class LandmarkSession(NamedTuple):
    """What a later session saw of a landmark.

    expected: localised poses in whose images it lay
    seen: of them, poses that saw it
    last_ns: when it was seen for the last time
    """

    landmark: int
    session: int
    expected: int
    seen: int
    last_ns: int | None


class Loop(NamedTuple):
    """A revisit, accepted or refused.

    T_from_to: 4x4
    information: 6x6 of the right perturbation, inverse covariance
    weight: of the robust solver, 0 to 1
    """

    from_pose: int
    to_pose: int
    T_from_to: Matrix
    information: Matrix
    inliers: int
    accepted: bool
    weight: float
    reason: str


def as_pose(value: Any) -> Matrix:
    return as_matrix(3, 4)(value) + [[0.0, 0.0, 0.0, 1.0]]


def as_covariance(size: int) -> Callable[[Any], Matrix | None]:
    def convert(value: Any) -> Matrix | None:
        if value is None or not all(map(math.isfinite, as_numbers(value, size * size))):
            return None
        return as_matrix(size, size)(value)
    return convert


def _transform(T: Matrix, p: list[float]) -> list[float]:
    return [row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] for row in T[:3]]


def _product(A: Matrix, B: Matrix) -> Matrix:
    # Sums in the order of Eigen's code for SSE2, which takes rows 0 and 1 together and row 2 apart:
    # the rounding is then that of the library on x86-64.
    def element(r: int, c: int) -> float:
        x, y, z = A[r][0] * B[0][c], A[r][1] * B[1][c], A[r][2] * B[2][c]
        return x + y + z if r < 2 else x + (y + z)
    rows = [[*(element(r, c) for c in range(3)), element(r, 3) + A[r][3]] for r in range(3)]
    return rows + [[0.0, 0.0, 0.0, 1.0]]


class MapFile(GeoPackage):
    """A map file, open for reading. Close it, or use it in a `with` statement.

    `path`: of the file. Raises BadMap for a file that is missing, not complete, damaged or newer.
    Properties read their tables at first use and keep them; they, too, raise BadMap, with table,
    row and column. Lists are in the order of ids, which count from 0. Layers, rasters and plain
    tables are read as of any GeoPackage: `layer`, `tiles`, `table` and the lists of their names.
    """

    own_tables = ("map_meta", "sessions", "session_places", "cameras", "wheel_models", "vehicles",
                  "map_frames", "keyframes", "keyframe_motions", "keyframe_corners", "landmarks",
                  "descriptors", "observations", "landmark_sessions", "loops", "audit")
    # Maps of earlier programs lack them.
    later_tables = ("vehicles", "keyframe_motions", "keyframe_corners", "landmark_sessions")

    def __init__(self, path: str | os.PathLike[str]):
        super().__init__(path)
        try:
            self.meta = self._read_meta()
        except BaseException:
            self.close()
            raise

    def _read_meta(self) -> dict[str, str]:
        """Key to value of `map_meta`: schema_version, state, digest, seed, options, ..."""
        meta = {r["key"]: r["value"] for r in
                self._read("map_meta", {"key": as_text, "value": as_text})}
        version, state = meta.get("schema_version", "nothing"), meta.get("state", "nothing")
        if not (version.isascii() and version.isdigit()) or int(version[:9]) < 1:
            raise self._bad("schema_version", version, "a number from 1")
        if int(version[:9]) > NEWEST_SCHEMA:
            raise self._bad("schema_version", version + ", of a newer roadbook",
                            f"at most {NEWEST_SCHEMA}")
        if state != "complete":
            raise self._bad("state", state, "complete")
        return meta

    @functools.cached_property
    def sessions(self) -> list[Session]:
        fields = {"id": as_integer, "name": as_text, "drive_digest": as_text,
                  "t_begin_ns": as_integer, "t_end_ns": as_integer, "wheel_scale": as_real,
                  "wheel_scale_sigma": as_optional(as_real), "scale_source": as_text,
                  "scale_sigma": as_optional(as_real), "localised_share": as_optional(as_real)}
        rows = self._numbered("sessions", fields)
        which = as_index(len(rows))
        paths = {r["session"]: r["drive_path"] for r in
                 self._read("session_places", {"session": which, "drive_path": as_text})}
        cameras: list[list[Camera]] = [[] for _ in rows]
        for r in self._read("cameras", {
                "session": which, "camera": as_integer, "name": as_text, "model": as_text,
                "width": as_integer, "height": as_integer, "max_angle_rad": as_real,
                "time_offset_s": as_real, "parameters": as_matrix(1, 9),
                "T_vehicle_camera": as_pose, "exposed_after_s": as_optional(as_real),
                "rolling_shutter_s": as_optional(as_real)}):
            own = cameras[r.pop("session")]
            if r.pop("camera") != len(own):
                raise self._bad("cameras", "a number twice or a gap", "numbers from 0")
            # Earlier programs took all images for exposed at the stamp.
            times = {key: r[key] or 0.0 for key in ("exposed_after_s", "rolling_shutter_s")}
            own.append(Camera(**r | {"parameters": r["parameters"][0]} | times))
        wheels = {r.pop("session"): r for r in self._read(
            "wheel_models", {"session": which} | dict.fromkeys(WHEEL_VALUES, as_real))}
        vehicles = {r.pop("session"): r for r in self._read(
            "vehicles", {"session": which, "source": as_text}
            | dict.fromkeys(VEHICLE_VALUES, as_optional(as_real)))}
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
                self._numbered("map_frames", {"id": as_integer, "T_map_frame": as_pose})]

    @functools.cached_property
    def poses(self) -> list[Pose]:
        """All keyframes: session by session, ascending in time."""
        fields = {"id": as_integer, "session": as_index(len(self.sessions)), "t_ns": as_integer,
                  "drive_frame": as_integer, "map_frame": as_index(len(self.map_frames)),
                  "T_frame_vehicle": as_pose, "covariance": as_covariance(6),
                  "travelled_m": as_real, "reversing": as_flag, "after_gap": as_flag,
                  "piece": as_optional(as_index(1 << 31))}
        rows = self._numbered("keyframes", fields)
        motions = {r.pop("keyframe"): r for r in self._read("keyframe_motions", {
            "keyframe": as_index(len(rows)), "motion": as_matrix(1, 3),
            "covariance": as_covariance(3), "distance_m": as_real, "reversing": as_flag})}
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
        fields = {"id": as_integer, "map_frame": as_index(len(self.map_frames)), "x": as_real,
                  "y": as_real, "z": as_real, "covariance": as_covariance(3), "ground": as_flag}
        rows = self._numbered("landmarks", fields)
        descriptors = {r["landmark"]: r["data"] for r in self._read(
            "descriptors", {"landmark": as_index(len(rows)), "data": as_bytes})}
        if len(descriptors) != len(rows) or any(len(d) != 64 for d in descriptors.values()):
            raise self._bad("descriptors", "some missing or of another size",
                            f"{len(rows)} of 64 bytes")
        zero = [[0.0] * 3] * 3
        landmarks = []
        for i, r in enumerate(rows):
            p_frame = [r["x"], r["y"], r["z"]]
            p_map = _transform(self.map_frames[r["map_frame"]], p_frame)
            covariance = r["covariance"]
            if self._zero_is_unknown and covariance == zero:
                covariance = None
            landmarks.append(Landmark(r["map_frame"], p_map, p_frame, covariance, r["ground"],
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
            "landmark": as_index(self._count("landmarks")), "session": as_index(len(self.sessions)),
            "expected": as_integer, "seen": as_integer, "last_ns": as_optional(as_integer)})]

    @functools.cached_property
    def loops(self) -> list[Loop]:
        pose = as_index(self._count("keyframes"))
        fields = {"from_keyframe": pose, "to_keyframe": pose, "T_from_to": as_pose,
                  "information": as_matrix(6, 6), "inliers": as_integer, "accepted": as_flag,
                  "weight": as_real, "reason": as_text}
        return [Loop(*r.values()) for r in self._read("loops", fields)]

    @functools.cached_property
    def history(self) -> list[tuple[str, str]]:
        """What was done to the map: action and detail, oldest first."""
        return [(r["action"], r["detail"]) for r in
                self._read("audit", {"action": as_text, "detail": as_text})]

    def _packed(self, table: str, size: int) -> Iterator[tuple[int, int, bytes]]:
        """Pose, camera and data of rows that have `count` records of `size` bytes."""
        fields = {"keyframe": as_index(len(self.poses)), "camera": as_integer, "count": as_integer,
                  "data": as_bytes}
        for number, r in enumerate(self._read(table, fields)):
            if not 0 <= r["camera"] < len(self.sessions[self.poses[r["keyframe"]].session].cameras):
                raise self._bad(f"{table} row {number} camera", str(r["camera"]),
                                "a camera of the session")
            if len(r["data"]) != size * r["count"]:
                raise self._bad(f"{table} row {number} data", f"{len(r['data'])} bytes",
                                f"{r['count']} times {size}")
            yield r["keyframe"], r["camera"], r["data"]

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
                if options.session is None:
                    print("# session", name)
                if options.session in (None, name):
                    for pose in place.poses:
                        if pose.session == i:
                            print(tum_line(pose))
            return 0
    except BadMap as bad:
        print(f"error: {bad}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
