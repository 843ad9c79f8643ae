"""Compares python/roadbook_map.py with the C++ reader, and hands it files that it must refuse.

map_reader_test.py PRINT_MAP SOURCE_FOLDER: `print_map` is tests/python/print_map.cpp. Ends with 77
where this Python cannot read maps.
"""

from __future__ import annotations

import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from typing import Any, Iterable

try:
    import sqlite3
    TOO_OLD = sys.version_info < (3, 10) or sqlite3.sqlite_version_info < (3, 37)
except ImportError:
    TOO_OLD = True
if TOO_OLD:
    print("skipped: needs Python 3.10 and SQLite 3.37")
    sys.exit(77)

PRINT_MAP, SOURCES = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
READER = SOURCES / "python" / "roadbook_map.py"
sys.path.insert(0, str(READER.parent))
from roadbook_map import BadMap, Geometry, MapFile  # noqa: E402

FUZZED_FILES, FUZZ_SECONDS = 200, 10.0
LARGEST_M = 8.0  # of a coordinate of the small map: sums round in proportion


def words(name: str, *values: Any) -> str:
    """A line as print_map prints it."""
    line = [name]
    for value in values:
        if value is None:
            line.append("-")
        elif isinstance(value, (bool, int)):
            line.append(str(int(value)))
        elif isinstance(value, float):
            line.append(value.hex())
        elif isinstance(value, str):
            line.append("x" + value.encode().hex())
        elif isinstance(value, bytes):
            line.append("x" + value.hex())
        else:  # a vector or a matrix
            line += words("", *value).split()
    return " ".join(line)


def vertices(geometry: Geometry) -> list[tuple[float, ...]]:
    if geometry.type == "Point":
        return [geometry.coordinates]
    return geometry.coordinates if geometry.type == "LineString" else geometry.coordinates[0]


def lines_of(place: MapFile) -> Iterable[str]:
    """Everything in the map, as print_map prints it."""
    meta = place.meta
    yield words("meta", int(meta["schema_version"]), meta["state"], meta["digest"])
    own = ("schema_version", "state", "digest", "schema_digest", "digest_of_file")
    for key in sorted(meta):
        if key not in own and not key.startswith("digest."):
            yield words("meta_value", key, meta[key])
    for s in place.sessions:
        yield words("session", s.name, s.drive_digest, s.drive_path, s.t_begin_ns, s.t_end_ns,
                    s.wheel_scale, s.wheel_scale_sigma, s.scale_source, s.scale_sigma,
                    s.localised_share)
        for c in s.cameras:
            yield words("camera", *c)
        yield words("wheels", s.wheels and list(s.wheels.values()))
        yield words("vehicle", s.vehicle_source, list(s.vehicle.values()))
    for T in place.map_frames:
        yield words("map_frame", T)
    for p in place.poses:
        yield words("pose", p.session, p.t_ns, p.drive_frame, p.map_frame, p.travelled_m,
                    p.reversing, p.after_gap, p.piece)
        yield words("T_frame_vehicle", p.T_frame_vehicle)
        yield words("T_map_vehicle", p.T_map_vehicle)
        yield words("pose_covariance", p.covariance)
        yield words("wheel_motion", p.wheels)
    for m in place.landmarks:
        yield words("landmark", m.map_frame, m.p_frame, m.ground, m.descriptor)
        yield words("p_map", m.p_map)
        yield words("landmark_covariance", m.covariance)
    for o in place.observations():
        yield words("observation", *o)
    for corner in place.corners():
        yield words("corner", *corner)
    for s in place.landmark_sessions:
        yield words("landmark_session", *s)
    for loop in place.loops:
        yield words("loop", *loop)
    for name in place.layer_names():
        for row in place.layer(name):
            geometry = row.pop("geom")
            del row["fid"]
            yield words("feature", name, geometry.type, geometry.axes, vertices(geometry),
                        *(part for item in row.items() for part in item))
    for name in place.raster_names():
        raster = place.raster(name)
        yield words("raster", name, raster.description, raster.corner)
    for name in place.table_names():
        for row in place.table(name):
            yield words("table", name, *(part for item in row.items() for part in item))


def layer_of(line: str) -> list[str]:
    """Sorts layers and tables by name, below all else; their rows stay in order."""
    return line.split()[:2] if line.startswith(("feature", "raster", "table")) else []


def read_all(path: pathlib.Path) -> None:
    with MapFile(path) as place:
        for _ in lines_of(place):
            pass
        for name in place.raster_names():
            list(place.tiles(name))
        place.history


class MapReader(unittest.TestCase):
    folder: pathlib.Path
    map: pathlib.Path

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="roadbook-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.map = cls.folder / "place.gpkg"
        subprocess.run([PRINT_MAP, "--make", cls.map], check=True)

    def copy(self, name: str) -> pathlib.Path:
        return pathlib.Path(shutil.copy(self.map, self.folder / name))

    def change(self, name: str, *sql: str) -> pathlib.Path:
        path = self.copy(name)
        database = sqlite3.connect(path)
        with database:
            # The triggers need functions that GDAL brings.
            for (name,) in list(database.execute("SELECT name FROM sqlite_master "
                                                 "WHERE type = 'trigger'")):
                database.execute(f'DROP TRIGGER "{name}"')
            for statement in sql:
                database.execute(statement)
        database.close()
        return path

    def refusal(self, path: pathlib.Path) -> str:
        with self.assertRaises(BadMap) as caught:
            read_all(path)
        text = str(caught.exception)
        self.assertRegex(text, f"(?s)^{re.escape(str(path))}: .+: got .*, want .+")
        return text.removeprefix(str(path) + ": ")

    def check_same(self, path: pathlib.Path) -> list[str]:
        """Compares every number to the bit; layers and tables may come in another order."""
        printed = subprocess.run([PRINT_MAP, path], check=True, capture_output=True, text=True)
        with MapFile(path) as place:
            ours = list(lines_of(place))
        # C prints 0x1.8p+3, Python 0x1.8000000000000p+3: compare the numbers, which are exact.
        exact = re.compile(r"-?0x[0-9a-f.]+p[+-]\d+")
        sums, *theirs = [exact.sub(lambda m: float.fromhex(m[0]).hex(), line)
                         for line in printed.stdout.splitlines()]
        ours.sort(key=layer_of)
        theirs.sort(key=layer_of)
        for a, b in zip(ours, theirs):
            name = a.split()[0]
            if sums == words("sums", "plain") or name not in ("T_map_vehicle", "p_map"):
                self.assertEqual(a, b)
                continue
            self.assertEqual(name, b.split()[0])
            for x, y in zip(map(float.fromhex, a.split()[1:]), map(float.fromhex, b.split()[1:])):
                self.assertAlmostEqual(x, y, delta=8 * sys.float_info.epsilon * LARGEST_M)
        self.assertEqual(len(ours), len(theirs))
        return ours

    def test_every_number_is_that_of_the_library(self) -> None:
        lines = self.check_same(self.map)
        kinds = {line.split()[0] for line in lines}
        self.assertEqual(len(kinds), 22, kinds)

    def test_schema_version_one_is_read(self) -> None:
        path = self.folder / "one.gpkg"
        subprocess.run([PRINT_MAP, "--make-one", path], check=True)
        self.check_same(path)
        with MapFile(path) as place:
            self.assertEqual(place.meta["schema_version"], "1")
            self.assertTrue(all(p.wheels is None for p in place.poses))
            self.assertIsNone(place.sessions[1].localised_share)
            self.assertEqual((list(place.corners()), place.landmark_sessions), ([], []))

    def test_zeros_of_earlier_programs_are_unknown(self) -> None:
        path = self.folder / "old.gpkg"
        subprocess.run([PRINT_MAP, "--make-old", path], check=True)
        self.check_same(path)
        with MapFile(path) as place:
            self.assertEqual([i for i, p in enumerate(place.poses) if p.covariance is None], [2])
            self.assertEqual(place.poses[0].covariance, [[0.0] * 6] * 6)  # holds the gauge
            self.assertIsNone(place.landmarks[4].covariance)
            self.assertIsNone(place.sessions[0].scale_sigma)

    def test_unknown_is_none(self) -> None:
        with MapFile(self.map) as place:
            self.assertEqual([i for i, p in enumerate(place.poses) if p.covariance is None], [2])
            self.assertIsNone(place.landmarks[4].covariance)
            self.assertIsNone(place.sessions[1].scale_sigma)
            self.assertIsNone(place.sessions[1].wheels)
            self.assertIsNone(place.sessions[0].vehicle["width_m"])
        nan = "x'" + "000000000000f87f" * 36 + "'"
        path = self.change("nan.gpkg", f"UPDATE keyframes SET covariance = {nan} WHERE id = 5")
        with MapFile(path) as place:
            self.assertIsNone(place.poses[5].covariance)

    def test_rasters_have_tiles_and_places(self) -> None:
        with MapFile(self.map) as place:
            raster = place.raster("overhead")
            self.assertEqual(raster.levels[-1].pixel_x_m, 0.05)
            self.assertIsNone(raster.coverage)
            tiles = list(place.tiles("overhead"))
            self.assertEqual({(t.column, t.row) for t in tiles},
                             {(c, r) for c in range(3) for r in range(2)})
            for tile in tiles:
                self.assertEqual(tile.data[:8], b"\x89PNG\r\n\x1a\n")
                self.assertAlmostEqual(tile.corner[0], -3.0 + 12.8 * tile.column, delta=1e-9)
                self.assertAlmostEqual(tile.corner[1], 7.0 - 12.8 * tile.row, delta=1e-9)
            self.assertLess(len(list(place.tiles("overhead", 0))), len(tiles))
            self.assertRaises(KeyError, place.raster, "lanes")
            self.assertRaises(KeyError, place.layer, "overhead")
            self.assertRaises(KeyError, place.table, "x\"y")

    def test_a_read_only_folder_will_do_and_gets_no_file(self) -> None:
        locked = self.folder / "locked %3F #"
        locked.mkdir()
        for name, mode in (("plain.gpkg", "DELETE"), ("wal.gpkg", "WAL")):
            path = pathlib.Path(shutil.copy(self.map, locked / name))
            database = sqlite3.connect(path)
            database.execute(f"PRAGMA journal_mode = {mode}")
            database.close()
        before = sorted(os.listdir(locked))
        for writable in (True, False):
            os.chmod(locked, 0o755 if writable else 0o555)
            for name in before:
                with MapFile(locked / name) as place:
                    self.assertEqual(len(place.poses), 24)
                    self.assertEqual(len(list(place.observations())), 480)
                    self.assertEqual(sorted(os.listdir(locked)), before)
        os.chmod(locked, 0o755)

    def test_what_another_program_has_not_completed_is_refused(self) -> None:
        path = self.copy("open.gpkg")
        database = sqlite3.connect(path, isolation_level=None)
        database.execute("PRAGMA journal_mode = WAL")
        database.execute("UPDATE audit SET detail = 'changed'")
        self.assertIn("-wal", self.refusal(path))
        database.close()
        # A writer is killed within a transaction; its journal remains.
        database = sqlite3.connect(self.copy("begun.gpkg"), isolation_level=None)
        for sql in ("PRAGMA cache_size = 1", "PRAGMA cache_spill = 1", "BEGIN",
                    "UPDATE landmarks SET x = 0.0", "UPDATE observations SET data = zeroblob(160)"):
            database.execute(sql)
        for end in ("", "-journal"):
            shutil.copy(self.folder / f"begun.gpkg{end}", self.folder / f"cut off.gpkg{end}")
        database.execute("ROLLBACK")
        database.close()
        self.assertIn("-journal", self.refusal(self.folder / "cut off.gpkg"))

    def test_other_files_are_refused_in_plain_words(self) -> None:
        version = "UPDATE map_meta SET value = '{}' WHERE key = 'schema_version'"
        self.assertEqual(self.refusal(self.change("a.gpkg", version.format(3))),
                         "schema_version: got 3, of a newer roadbook, want at most 2")
        for wrong in ("0", "-1", "²", "1e9", ""):
            path = self.change("b.gpkg", version.format(wrong))
            self.assertEqual(self.refusal(path),
                             f"schema_version: got {wrong}, want a number from 1")
        path = self.change("c.gpkg", "UPDATE map_meta SET value = 'part' WHERE key = 'state'")
        self.assertEqual(self.refusal(path), "state: got part, want complete")
        path = self.change("d.gpkg", "DROP TABLE map_meta")
        self.assertIn("map_meta: got no such table", self.refusal(path))
        path = self.change("e.gpkg", "DROP TABLE keyframes")
        self.assertIn("keyframes: got no such table", self.refusal(path))
        path = self.change("f.gpkg", "UPDATE keyframes SET T_frame_vehicle = x'00' WHERE id = 3")
        self.assertEqual(self.refusal(path),
                         "keyframes row 3 T_frame_vehicle: got 1 bytes, want 96 bytes")
        path = self.change("g.gpkg", "CREATE VIEW v AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL "
                                     "SELECT i + 1 FROM n) SELECT i FROM n")
        self.assertIn("view v", self.refusal(path))
        path = self.change("h.gpkg", "UPDATE lanes SET geom = x'4750' WHERE fid = 2")
        self.assertIn("lanes row 1 geom: got other bytes", self.refusal(path))
        path = self.folder / "text.gpkg"
        path.write_text("no database at all")
        self.assertIn("no SQLite database", self.refusal(path))
        self.assertIn("no such file", self.refusal(self.folder / "none.gpkg"))
        self.assertIn("no regular file", self.refusal(self.folder))

    def test_cut_files_are_refused(self) -> None:
        whole = self.map.read_bytes()
        path = self.folder / "cut.gpkg"
        for size in [0, 1, 99, 100, 4096, len(whole) // 2, len(whole) - 1]:
            path.write_bytes(whole[:size])
            self.refusal(path)
        self.assertIn("the file is cut", self.refusal(path))

    def test_changed_bytes_give_a_map_or_a_refusal(self) -> None:
        whole = self.map.read_bytes()
        path = self.folder / "fuzz.gpkg"
        dice = random.Random(7)
        read = 0
        begin = time.process_time()
        for _ in range(FUZZED_FILES):
            data = bytearray(whole)
            for _ in range(dice.choice((1, 3, 30))):
                data[dice.randrange(len(data))] = dice.randrange(256)
            path.write_bytes(data)
            try:
                read_all(path)
                read += 1
            except BadMap as bad:
                self.assertRegex(str(bad), "(?s): got .*, want .+")
        self.assertLess(time.process_time() - begin, FUZZ_SECONDS)
        self.assertTrue(0 < read < FUZZED_FILES, read)

    def run_reader(self, *arguments: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run([sys.executable, "-B", READER, *map(str, arguments)], text=True,
                              capture_output=True, env=os.environ | {"PYTHONIOENCODING": "utf-8"})

    def test_the_command_prints_a_summary_and_a_trajectory(self) -> None:
        text = self.run_reader(self.map).stdout
        self.assertEqual(len(text.splitlines()), 12, text)
        self.assertRegex(text, r"(?m)^poses: +24, 23 with covariance; pieces: 2; after gaps: 2$")
        of = json.loads(self.run_reader("--json", self.map).stdout)
        self.assertEqual((of["poses"], of["landmarks"], of["observations"]), (24, 40, 480))
        tum = self.run_reader("--tum", "--session", "drive 1", self.map).stdout.splitlines()
        self.assertEqual(len(tum), 12)
        with MapFile(self.map) as place:
            pose = place.poses[13]
        t_s, x, y, z, *q = tum[1].split()
        self.assertEqual(t_s.replace(".", ""), str(pose.t_ns))
        T = pose.T_map_vehicle
        for i, value in enumerate((x, y, z)):
            self.assertAlmostEqual(float(value), T[i][3], delta=1e-9)
        qx, qy, qz, qw = map(float, q)  # the first column of the rotation, from the quaternion
        for i, value in enumerate((1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy + qz * qw),
                                   2 * (qx * qz - qy * qw))):
            self.assertAlmostEqual(value, T[i][0], delta=1e-8)
        bad = self.run_reader(self.folder)
        self.assertEqual((bad.returncode, bad.stdout), (2, ""))
        self.assertIn("map: got no regular file, want a map file", bad.stderr)

    def test_the_example_of_the_guide_runs(self) -> None:
        page = (SOURCES / "docs" / "guide" / "library.md").read_text()
        (example,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
        result = subprocess.run([sys.executable, "-B", "-c", example], cwd=self.folder, text=True,
                                capture_output=True, env=os.environ | {"PYTHONPATH": READER.parent})
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater(len(result.stdout.splitlines()), 5)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
