"""Reads masks for Nav2's costmap filters as Nav2's map_server and filters document it.

    read_nav2.py footprints MASK.yaml PATHS.json LENGTH WIDTH REAR_OVERHANG
    read_nav2.py connected MASK.yaml PATHS.json WIDTH SPACES.txt
    read_nav2.py cells MASK.yaml POINTS.txt
    read_nav2.py speeds MASK.yaml FILTER.yaml POINTS.txt

The rules (docs.nav2.org, map_server and costmap filters): the first row of the image is the top,
`origin` is the lower left corner of the lower left cell. trinary: p = (255 - x) / 255, or x / 255
with negate; occupied above occupied_thresh, free below free_thresh, else unknown. raw: x, unknown
above 100. A keep-out mask (type 0) forbids occupied cells; a speed mask (type 2) limits to
base + multiplier * x m/s, where x = 0 is no limit and unknown is an error.
"""

import json
import math
import sys

UNKNOWN, FREE, OCCUPIED = -1, 0, 100


def yaml_of(path):
    values = {}
    for line in open(path):
        key, colon, value = line.strip().partition(":")
        if colon:
            values[key] = value.strip().strip('"')
    return values


def pgm_of(path):
    """Width, height and pixels in rows of a binary PGM."""
    raw = open(path, "rb").read()
    words, at = [], 0
    while len(words) < 4:
        end = at
        while raw[end : end + 1] not in (b" ", b"\n"):
            end += 1
        words.append(raw[at:end])
        at = end + 1
    assert words[0] == b"P5" and words[3] == b"255", words
    width, height = int(words[1]), int(words[2])
    pixels = raw[at:]
    assert len(pixels) == width * height, (len(pixels), width, height)
    return width, height, pixels


class Grid:
    def __init__(self, path):
        info = yaml_of(path)
        folder = path.rpartition("/")[0]
        self.width, self.height, pixels = pgm_of((folder + "/" if folder else "") + info["image"])
        self.resolution = float(info["resolution"])
        self.x0, self.y0, turn = (float(v) for v in info["origin"].strip("[]").split(","))
        assert turn == 0.0
        self.mode = info.get("mode", "trinary")
        free, occupied = float(info["free_thresh"]), float(info["occupied_thresh"])
        negate = info["negate"] not in ("0", "false")
        self.value = [self.meaning(x, negate, free, occupied) for x in range(256)]
        # map_server turns the rows over: cell (0, 0) is the lower left one.
        self.rows = [pixels[r * self.width : (r + 1) * self.width] for r in range(self.height)]
        self.rows.reverse()

    def meaning(self, x, negate, free, occupied):
        if self.mode == "raw":
            return x if x <= 100 else UNKNOWN
        assert self.mode == "trinary", self.mode
        p = x / 255.0 if negate else 1.0 - x / 255.0
        if occupied < p:
            return OCCUPIED
        return FREE if p < free else UNKNOWN

    def cell(self, x, y):
        """Column and row of the cell that holds a point; None outside."""
        i = math.floor((x - self.x0) / self.resolution)
        j = math.floor((y - self.y0) / self.resolution)
        return (i, j) if 0 <= i < self.width and 0 <= j < self.height else None

    def at(self, i, j):
        return self.value[self.rows[j][i]]


def project(points, axis):
    values = [p[0] * axis[0] + p[1] * axis[1] for p in points]
    return min(values), max(values)


def cells_under(grid, corners):
    """Cells that a rectangle overlaps: by separating axes, those of the grid and its own."""
    ax = (corners[1][0] - corners[0][0], corners[1][1] - corners[0][1])
    ay = (corners[3][0] - corners[0][0], corners[3][1] - corners[0][1])
    own = [(axis, project(corners, axis)) for axis in (ax, ay)]
    r = grid.resolution
    low = [min(c[k] for c in corners) for k in (0, 1)]
    high = [max(c[k] for c in corners) for k in (0, 1)]
    for j in range(math.floor((low[1] - grid.y0) / r), math.floor((high[1] - grid.y0) / r) + 1):
        for i in range(math.floor((low[0] - grid.x0) / r), math.floor((high[0] - grid.x0) / r) + 1):
            x, y = grid.x0 + i * r, grid.y0 + j * r
            square = [(x, y), (x + r, y), (x + r, y + r), (x, y + r)]
            apart = False
            for axis, (least, most) in own:
                a, b = project(square, axis)
                apart = apart or b <= least or a >= most
            if not apart:
                yield i, j


def poses_of(path):
    """x, y, heading of every row of an exported path: of all lanes, or of the route."""
    data = json.load(open(path))
    poses = []
    for table in data["lanes"] if "lanes" in data else [data["route"]]:
        for row in zip(table["x_m"], table["y_m"], table["psi_rad"]):
            poses.append(row)
            if "one_way" in table and not table["one_way"]:
                poses.append((row[0], row[1], row[2] + math.pi))
    return poses


def footprint(x, y, heading, length, width, overhang):
    c, s = math.cos(heading), math.sin(heading)
    return [
        (x + c * a - s * b, y + s * a + c * b)
        for a, b in (
            (-overhang, -width / 2),
            (length - overhang, -width / 2),
            (length - overhang, width / 2),
            (-overhang, width / 2),
        )
    ]


def footprints(grid, paths, length, width, overhang):
    """Poses, and how many of them touch a cell that is not free, or leave the mask."""
    poses = poses_of(paths)
    wrong = 0
    for x, y, heading in poses:
        under = cells_under(grid, footprint(x, y, heading, length, width, overhang))
        wrong += any(
            not (0 <= i < grid.width and 0 <= j < grid.height) or grid.at(i, j) != FREE
            for i, j in under
        )
    print(len(poses), wrong)


def wide_cells(grid, width):
    """Cells in whose middle a disc of that width stands on free cells alone."""
    reach = math.ceil(width / 2 / grid.resolution)
    disc = [
        (i, j)
        for i in range(-reach, reach + 1)
        for j in range(-reach, reach + 1)
        if math.hypot(max(abs(i) - 0.5, 0), max(abs(j) - 0.5, 0)) * grid.resolution < width / 2
    ]
    disc.sort(key=lambda d: -d[0] * d[0] - d[1] * d[1])

    def wide(i, j):
        for di, dj in disc:
            a, b = i + di, j + dj
            if not (0 <= a < grid.width and 0 <= b < grid.height) or grid.at(a, b) != FREE:
                return False
        return True

    return wide


def connected(grid, paths, width, spaces):
    """For each space (middle x, y of a line): 1 where the disc gets there from a lane."""
    wide = wide_cells(grid, width)
    known, open_cells = {}, []

    def reach(cell):
        if cell is not None and cell not in known:
            known[cell] = wide(*cell)
            if known[cell]:
                open_cells.append(cell)

    for x, y, _ in poses_of(paths):
        reach(grid.cell(x, y))
    while open_cells:
        i, j = open_cells.pop()
        for cell in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)):
            if 0 <= cell[0] < grid.width and 0 <= cell[1] < grid.height:
                reach(cell)
    for line in open(spaces):
        x, y = (float(v) for v in line.split())
        print(int(known.get(grid.cell(x, y), False)))


def cells(grid, points):
    for line in open(points):
        x, y = (float(v) for v in line.split())
        cell = grid.cell(x, y)
        print("outside" if cell is None else grid.at(*cell))


def speeds(grid, parameters, points):
    """Least and largest of mask minus speed over points (x, y, speed of a line)."""
    assert grid.mode == "raw" and parameters["type"] == "2"
    base, multiplier = float(parameters["base"]), float(parameters["multiplier"])
    least, largest = math.inf, -math.inf
    for line in open(points):
        x, y, speed = (float(v) for v in line.split())
        value = grid.at(*grid.cell(x, y))
        assert 1 <= value <= 100, "no limit, or unknown"
        limit = base + multiplier * value
        assert limit > 0.0, "Nav2 takes it for no limit"
        least, largest = min(least, limit - speed), max(largest, limit - speed)
    print(least, largest, multiplier)


def main(job, mask, *rest):
    grid = Grid(mask)
    if job == "footprints":
        footprints(grid, rest[0], *(float(v) for v in rest[1:]))
    elif job == "connected":
        connected(grid, rest[0], float(rest[1]), rest[2])
    elif job == "cells":
        cells(grid, rest[0])
    elif job == "speeds":
        speeds(grid, yaml_of(rest[0]), rest[1])


main(*sys.argv[1:])
