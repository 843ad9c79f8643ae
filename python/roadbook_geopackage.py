"""Reads GeoPackage files with Python's standard library alone: rows, layers, rasters.

roadbook_map.py, which reads roadbook's maps, rests on this module. A file is opened for reading
only, and no file is created beside it. What is not known is None, never 0 or NaN.
"""

from __future__ import annotations

import math
import os
import pathlib
import sqlite3
import stat
import struct
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, TypeVar

Row = dict[str, Any]
Self = TypeVar("Self", bound="GeoPackage")
Fields = dict[str, Callable[[Any], Any]]


class BadMap(Exception):
    """A file that is no map this reader knows; says "FILE: FIELD: got X, want Y"."""

    def __init__(self, file: str, field: str, got: str, want: str):
        super().__init__(f"{file}: {field}: got {got}, want {want}")
        self.file, self.field, self.got, self.want = file, field, got, want


class Geometry(NamedTuple):
    """A geometry in the map frame [m].

    type: Point, LineString, Polygon, MultiPoint, MultiLineString, MultiPolygon
    axes: xy, xyz, xym or xyzm; the meaning of m depends on the layer
    coordinates: as in GeoJSON: point (x, y, ...); line: points; polygon: rings of points
    """

    type: str
    axes: str
    coordinates: Any


class Level(NamedTuple):
    """A zoom level of a raster; the largest zoom has all pixels.

    columns: of tiles
    rows: of tiles
    tile_width: [px]
    tile_height: [px]
    """

    zoom: int
    columns: int
    rows: int
    tile_width: int
    tile_height: int
    pixel_x_m: float
    pixel_y_m: float


class Raster(NamedTuple):
    """Georeference of a raster: x grows with columns, y falls with rows.

    corner: outer corner of the first pixel of tile (0, 0): x, y [m]
    extent: of what is shown: least x, least y, most x, most y [m]
    levels: ascending in zoom
    coverage: datatype (integer or float), scale, offset and data_null (pixel without a value)
        of a raster of numbers: value = pixel * scale + offset; None: an image
    """

    name: str
    description: str
    corner: tuple[float, float]
    extent: tuple[float, ...] | None
    levels: list[Level]
    coverage: Row | None


class Tile(NamedTuple):
    """A tile of a raster.

    corner: outer corner of the first pixel: x, y [m]
    data: a PNG of 8 or 16 bits (UInt16), or a TIFF of Float32
    """

    zoom: int
    column: int
    row: int
    corner: tuple[float, float]
    data: bytes


class _Fault(Exception):
    """got, want"""


def _kind(kind: type, name: str) -> Callable[[Any], Any]:
    def convert(value: Any) -> Any:
        if type(value) is not kind:
            raise _Fault("nothing" if value is None else repr(value)[:60], name)
        return value
    return convert


as_integer, as_real = _kind(int, "an integer"), _kind(float, "a number")
as_text, as_bytes = _kind(str, "a text"), _kind(bytes, "bytes")


def as_flag(value: Any) -> bool:
    return as_integer(value) != 0


def as_optional(convert: Callable[[Any], Any]) -> Callable[[Any], Any]:
    return lambda value: None if value is None else convert(value)


def as_index(size: int) -> Callable[[Any], int]:
    def convert(value: Any) -> int:
        if not 0 <= as_integer(value) < size:
            raise _Fault(str(value), f"an index below {size}")
        return value
    return convert


def as_numbers(value: Any, count: int) -> list[float]:
    if len(as_bytes(value)) != 8 * count:
        raise _Fault(f"{len(value)} bytes", f"{8 * count} bytes")
    return list(struct.unpack(f"<{count}d", value))


def as_matrix(rows: int, columns: int) -> Callable[[Any], list[list[float]]]:
    def convert(value: Any) -> list[list[float]]:
        numbers = as_numbers(value, rows * columns)
        if not all(map(math.isfinite, numbers)):
            raise _Fault("a number that is not finite", "finite numbers")
        return [numbers[columns * r:columns * (r + 1)] for r in range(rows)]
    return convert


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

    def numbers(self, order: str, count: int) -> tuple[float | None, ...]:
        return tuple(None if math.isnan(x) else x for x in self.take(order, "d", count))

    def points(self, order: str, axes: int) -> list[tuple[float | None, ...]]:
        numbers = self.numbers(order, axes * self.take(order, "I")[0])
        return [numbers[i:i + axes] for i in range(0, len(numbers), axes)]

    def geometry(self, part_of: int = 0) -> Geometry:
        order = {0: ">", 1: "<"}.get(self.take("<", "B")[0], "")
        dimensions, kind = divmod(self.take(order, "I")[0], 1000)
        if not order or dimensions > 3 or not 1 <= kind <= (6 if part_of == 0 else 3):
            raise _Fault(f"geometry type {1000 * dimensions + kind}", "a point, line or polygon")
        axes = ("xy", "xyz", "xym", "xyzm")[dimensions]
        coordinates: Any
        if kind == 1:
            point = self.numbers(order, len(axes))
            coordinates = None if point[0] is None else point  # POINT EMPTY
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


def as_geometry(value: Any) -> Geometry:
    """From GeoPackage's binary: "GP", version, flags, srs_id, envelope, well-known binary."""
    if len(as_bytes(value)) < 8 or value[:2] != b"GP" or value[3] >> 1 & 7 > 4:
        raise _Fault("other bytes", "a GeoPackage geometry")
    return _Wkb(value, 8 + (0, 32, 48, 48, 64)[value[3] >> 1 & 7]).geometry()


class GeoPackage:
    """A GeoPackage file, open for reading. Close it, or use it in a `with` statement.

    Raises BadMap for a file that is missing, cut, damaged or no GeoPackage.
    """

    own_tables: tuple[str, ...] = ()    #: tables that `table_names` leaves out
    later_tables: tuple[str, ...] = ()  #: tables that may be missing

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
            raise self._refusal(error) from None
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        if self._db is not None:
            self._db.close()
        self._db = None

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def layer_names(self) -> list[str]:
        """Names of the vector layers, such as poses, lanes, parking_spaces."""
        return self._contents("features")

    def layer(self, name: str) -> list[Row]:
        """Rows of a vector layer; `geom` is a Geometry or None. KeyError: no such layer."""
        if name not in self.layer_names():
            raise KeyError(f"{self.path} has no layer {name}")
        sql = "SELECT column_name FROM gpkg_geometry_columns WHERE table_name = ?"
        column = next(self._rows(sql, name), {"column_name": "geom"})["column_name"]
        return list(self._read(name, {column: as_optional(as_geometry)}, all_columns=True))

    def table_names(self) -> list[str]:
        """Names of plain tables, neither layers nor those of the map itself or of the format."""
        other = {*self.own_tables, *self.layer_names(), *self.raster_names()}
        return sorted(n for n in self._tables if n not in other
                      and not n.startswith(("gpkg_", "rtree_", "sqlite_")))

    def table(self, name: str) -> list[Row]:
        """Rows of any table, values as stored, BLOBs as bytes. KeyError: no such table."""
        if name not in self._tables:
            raise KeyError(f"{self.path} has no table {name}")
        return list(self._rows(f"SELECT * FROM {_quoted(name)}"))

    def raster_names(self) -> list[str]:
        return self._contents("tiles") + self._contents("2d-gridded-coverage")

    def raster(self, name: str) -> Raster:
        """Georeference of a raster. KeyError: no such raster."""
        if name not in self.raster_names():
            raise KeyError(f"{self.path} has no raster {name}")
        of_name = "WHERE table_name = ?"
        about = self._one("gpkg_contents", {"description": as_optional(as_text)} | dict.fromkeys(
            ("min_x", "min_y", "max_x", "max_y"), as_optional(as_real)), of_name, name)
        corner = self._one("gpkg_tile_matrix_set", {"min_x": as_real, "max_y": as_real},
                           of_name, name)
        levels = [Level(*r.values()) for r in self._read("gpkg_tile_matrix", {
            "zoom_level": as_integer, "matrix_width": as_integer, "matrix_height": as_integer,
            "tile_width": as_integer, "tile_height": as_integer, "pixel_x_size": as_real,
            "pixel_y_size": as_real}, of_name + " ORDER BY zoom_level", name)]
        coverage = None
        if name not in self._contents("tiles"):
            coverage = self._one("gpkg_2d_gridded_coverage_ancillary", {
                "datatype": as_text, "scale": as_real, "offset": as_real,
                "data_null": as_optional(as_real)}, "WHERE tile_matrix_set_name = ?", name)
        description, *edges = about.values()
        return Raster(name, description or "", (corner["min_x"], corner["max_y"]),
                      None if None in edges else tuple(edges), levels, coverage)

    def tiles(self, name: str, zoom: int | None = None) -> Iterator[Tile]:
        """Yields the tiles of a raster at `zoom`, or of its largest; empty tiles are left out."""
        raster = self.raster(name)
        levels = {level.zoom: level for level in raster.levels}
        level = levels.get(max(levels, default=0) if zoom is None else zoom)
        if level is None:
            raise KeyError(f"{self.path} has no zoom {zoom} of {name}")
        fields = {"tile_column": as_index(level.columns), "tile_row": as_index(level.rows),
                  "tile_data": as_bytes}
        for r in self._read(name, fields, "WHERE zoom_level = ? ORDER BY tile_row, tile_column",
                            level.zoom):
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
        page, pages = struct.unpack_from(">H10xI", header, 16)
        whole = pages * (65536 if page == 1 else page)
        journal = os.path.exists(beside + "-journal")
        if header[24:28] == header[92:96] and status.st_size < whole and not journal:
            raise self._bad("size", f"{status.st_size} bytes", f"{whole} bytes: the file is cut")
        self._budget_of_query = 200 + status.st_size // 2000
        if 2 not in header[18:20]:
            return "mode=ro"
        # Another program left the file in WAL mode. SQLite would then create a -shm file beside it
        # and fail on a read-only disk. Without changes in a -wal file, the file itself is whole:
        # `immutable` reads it as it is.
        if os.path.exists(beside + "-wal") and os.path.getsize(beside + "-wal") > 0:
            raise self._bad("map", "changes of another program that are not in the file (-wal)",
                            "a map that no other program has open")
        return "mode=ro&immutable=1"

    def _check(self) -> None:
        assert self._db is not None
        # A damaged file must not make a query run for ever: the file's size limits its steps.
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
            raise self._refusal(error) from None  # ValueError: names that are no UTF-8

    def _refusal(self, error: Exception) -> BadMap:
        got = str(error) or "no memory"
        if os.path.exists(os.path.realpath(self.path) + "-journal"):
            return self._bad("database", got + "; a change is not complete (-journal)",
                             "a whole map (`roadbook check` takes back a change that was cut off)")
        if "locked" in got:
            return self._bad("database", got, "a map that no other program is writing")
        return self._bad("database", got, "an undamaged map file")

    def _query(self, sql: str) -> list[tuple[Any, ...]]:
        return [tuple(row.values()) for row in self._rows(sql)]

    def _read(self, table: str, fields: Fields, where: str = "",
              *values: Any, all_columns: bool = False) -> Iterator[Row]:
        """Yields the rows with `fields` converted and checked; a column that is missing is None."""
        if table not in self._tables:
            if table in self.later_tables:
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

    def _one(self, table: str, fields: Fields, where: str, *values: Any) -> Row:
        rows = list(self._read(table, fields, where, *values))
        if len(rows) != 1:
            raise self._bad(table, f"{len(rows)} rows of {values[0]}", "one")
        return rows[0]

    def _numbered(self, table: str, fields: Fields) -> list[Row]:
        """The rows, whose ids must count from 0; without the ids."""
        rows = list(self._read(table, fields))
        for number, row in enumerate(rows):
            if row.pop("id") != number:
                raise self._bad(f"{table} row {number} id", "another number", str(number))
        return rows

    def _count(self, table: str, what: str = "count(*)") -> int:
        return self._query(f"SELECT {what} FROM {_quoted(table)}")[0][0] or 0

    def _contents(self, data_type: str) -> list[str]:
        if "gpkg_contents" not in self._tables:
            return []
        sql = "SELECT table_name FROM gpkg_contents WHERE data_type = ? ORDER BY table_name"
        return [r["table_name"] for r in self._rows(sql, data_type)
                if r["table_name"] in self._tables]
