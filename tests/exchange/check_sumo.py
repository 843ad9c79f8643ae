#!/usr/bin/env python3
"""Has SUMO read an OpenDRIVE file and drive on it, and compares both with tables of the map.

Knows nothing of roadbook but what the file's userData say: which lane a road is a part of.
Prints one line for each fact and `problem ...` for each fault:

  netconvert MESSAGE              lines that netconvert printed, without "Success."
  road ID lane DIRECTION          of lanes, by userData
  turn LANE DIRECTION LANE DIRECTION   a connection between roads of different lanes, in the net
  joint LANE DIRECTION            a connection between two parts of one lane
  shape WORST_M POINTS STUBS      farthest point of a lane's shape from the path table, and lanes
                                  that are shorter than the areas of the junctions at their ends
  speeds PIECES SHORTEST_M        limits of the lanes
  outline WORST_M COUNT           corners of --polygon-output against the expected ones
  drive VEHICLES ARRIVED TELEPORTS COLLISIONS EXCESS_MPS LANES TURNS

Usage: check_sumo.py FILE.xodr PATH.csv WORK_FOLDER [--outlines FILE.json] [--turn-deg A]
       [--origin LAT LON]
"""
import argparse
import bisect
import csv
import json
import math
import os
import subprocess
import sys
import xml.etree.ElementTree as ET

TYPES = """<types>
  <type id="driving" priority="1" numLanes="1" speed="13.89" oneway="1"/>
</types>
"""
STEP_S = 0.1


def problem(text):
    print("problem", text)


def run(command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    lines = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()]
    return done.returncode, lines


class Path:
    """Rows of one lane's table, and the place nearest to a point."""

    def __init__(self, rows, turn_rad):
        self.s = [r[0] for r in rows]
        c, n = math.cos(turn_rad), math.sin(turn_rad)
        self.xy = [(c * r[1] - n * r[2], n * r[1] + c * r[2]) for r in rows]
        self.speed = [r[3] for r in rows]
        self.kappa = [r[4] for r in rows]
        self.cells = {}
        for i, (x, y) in enumerate(self.xy):
            self.cells.setdefault((math.floor(x), math.floor(y)), []).append(i)

    def nearest(self, x, y, reach=2):
        """Distance and place (row and share of the way to the next), or None beyond `reach` m."""
        rows = []
        cx, cy = math.floor(x), math.floor(y)
        for ring in range(reach + 1):
            for i in range(cx - ring, cx + ring + 1):
                for j in range(cy - ring, cy + ring + 1):
                    if max(abs(i - cx), abs(j - cy)) == ring:
                        rows += self.cells.get((i, j), ())
            if rows and ring > 0:
                break
        if not rows:
            return None
        k = min(rows, key=lambda r: (self.xy[r][0] - x) ** 2 + (self.xy[r][1] - y) ** 2)
        near = {k - 1, k}
        if k in (0, len(self.xy) - 1):  # the seam of a ring
            near |= {0, len(self.xy) - 2}
        return min(self._on(a, x, y) for a in near if 0 <= a < len(self.xy) - 1)

    def _on(self, a, x, y):
        (ax, ay), (bx, by) = self.xy[a], self.xy[a + 1]
        dx, dy = bx - ax, by - ay
        d2 = dx * dx + dy * dy
        u = 0.0 if d2 == 0.0 else max(0.0, min(1.0, ((x - ax) * dx + (y - ay) * dy) / d2))
        return math.hypot(ax + u * dx - x, ay + u * dy - y), a, u

    def speed_at(self, place):
        a = place[1]
        # A row holds the least of all up to its neighbours: within 0.2 m of the place.
        rows = [v for v in self.speed[max(0, a - 1):a + 3] if v is not None]
        return max(rows) if rows else None


def read_paths(name, turn_rad):
    rows = {}
    with open(name, newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            speed = float(row["speed_mps"]) if row["speed_mps"] else None
            rows.setdefault(row["lane"], []).append(
                (float(row["s_m"]), float(row["x_m"]), float(row["y_m"]), speed,
                 float(row["kappa_radpm"])))
    return {lane: Path(r, turn_rad) for lane, r in rows.items()}


class Road:
    def __init__(self, element):
        self.id = element.get("id")
        self.junction = element.get("junction")
        self.length = float(element.get("length"))
        data = {u.get("code"): u.get("value") for u in element.findall("userData")}
        self.lane = data.get("lane")
        self.direction = data.get("lane_direction")
        lane = element.find("lanes/laneSection/right/lane")
        self.speeds = [(float(s.get("sOffset")), float(s.get("max")), s.get("unit"))
                       for s in lane.findall("speed")]
        self.type = lane.get("type")


def road_of_edge(edge):
    return edge.lstrip("-").split("#")[0]


class Net:
    def __init__(self, name):
        root = ET.parse(name).getroot()
        offset = root.find("location").get("netOffset").split(",")
        self.offset = (float(offset[0]), float(offset[1]))
        self.lanes = {}  # id: (edge, speed, length, shape)
        self.internal = set()
        self.ends = {}
        for edge in root.findall("edge"):
            inside = edge.get("function") == "internal"
            for lane in edge.findall("lane"):
                shape = [tuple(float(v) for v in p.split(",")[:2])
                         for p in lane.get("shape").split()]
                shape = [(x - self.offset[0], y - self.offset[1]) for x, y in shape]
                self.lanes[lane.get("id")] = (edge.get("id"), float(lane.get("speed")),
                                              float(lane.get("length")), shape, lane)
            if inside:
                self.internal.add(edge.get("id"))
            else:
                self.ends[edge.get("id")] = (edge.get("from"), edge.get("to"))
        self.connections = [(c.get("from"), c.get("to")) for c in root.findall("connection")
                            if c.get("from") not in self.internal]

    def edges(self):
        return [e for e in self.ends]


def check_roads(roads, net):
    for road in roads.values():
        if road.type != "driving":
            problem(f"road {road.id}: lane type {road.type}")
        if not road.speeds or road.speeds[0][0] != 0.0:
            problem(f"road {road.id}: no limit from its begin")
        if any(unit != "m/s" or speed <= 0.0 for _, speed, unit in road.speeds):
            problem(f"road {road.id}: limits {road.speeds}")
        if road.junction == "-1":
            print("road", road.id, road.lane, road.direction)
    for edge, (start, end) in net.ends.items():
        if start == end:
            problem(f"edge {edge} joins junction {start} twice")
    for a, b in net.connections:
        if a == b:
            problem(f"edge {a} follows itself")
    pieces = []
    for road in roads.values():
        at = [s for s, _, _ in road.speeds] + [road.length]
        pieces += [(b - a, road.length) for a, b in zip(at, at[1:])]
    for length, whole in pieces:
        if length < 4.999 and length < whole - 0.001:
            problem(f"a limit over {length} m")
    print("speeds", len(pieces), f"{min(p[0] for p in pieces):.3f}")
    for road in roads.values():
        if road.junction == "-1" and not any(road_of_edge(e) == road.id for e in net.edges()):
            problem(f"road {road.id} is not in the net")


def check_turns(roads, net):
    for a, b in net.connections:
        ra, rb = roads[road_of_edge(a)], roads[road_of_edge(b)]
        if ra.id == rb.id:
            continue  # where the limit changes
        if (ra.lane, ra.direction) == (rb.lane, rb.direction) and net.ends[a][1].count(".") == 1:
            print("joint", ra.lane, ra.direction)
        else:
            print("turn", ra.lane, ra.direction, rb.lane, rb.direction)


def along(shape, step):
    yield shape[0]
    for (ax, ay), (bx, by) in zip(shape, shape[1:]):
        n = max(1, math.ceil(math.hypot(bx - ax, by - ay) / step))
        for k in range(1, n + 1):
            yield ax + (bx - ax) * k / n, ay + (by - ay) * k / n


def check_shapes(roads, net, paths):
    worst, points, short = 0.0, 0, 0
    for name, (edge, speed, length, shape, _) in net.lanes.items():
        if edge in net.internal:
            continue
        road = roads[road_of_edge(edge)]
        path = paths[road.lane]
        if length <= 0.2:
            short += 1  # covered by the areas of junctions: netconvert leaves a stub somewhere
            continue
        for x, y in along(shape, 0.1):
            place = path.nearest(x, y)
            points += 1
            if place is None or place[0] > 0.01:
                problem(f"lane {name}: {x:.3f},{y:.3f} is {place} from lane {road.lane}")
                break
            worst = max(worst, place[0])
            limit = path.speed_at(place)
            if limit is not None and speed > limit + 0.006:
                problem(f"lane {name}: limit {speed} where the map has {limit:.3f}")
                break
        forward = road.direction == "forward"
        first, last = path.nearest(*shape[0]), path.nearest(*shape[-1])
        if first and last and math.dist(shape[0], shape[-1]) > 0.5:
            way = (last[1] + last[2]) - (first[1] + first[2])
            if (way > 0) != forward and abs(way) < 0.5 * len(path.s):
                problem(f"lane {name} runs the wrong way")
        if edge_allows_no_cars(net.lanes[name][4]):
            problem(f"lane {name} is closed for cars")
    print("shape", f"{worst:.5f}", points, short)


def edge_allows_no_cars(lane):
    allow, disallow = lane.get("allow"), lane.get("disallow")
    return (allow is not None and "passenger" not in allow.split() and allow != "all") or (
        disallow is not None and ("passenger" in disallow.split() or disallow == "all"))


def geo_to_metres(lon, lat, origin):
    """East and north of an origin that is some hundred metres away, by the ellipsoid's radii."""
    phi = math.radians(0.5 * (lat + origin[0]))
    e2 = 0.00669437999014
    w = 1.0 - e2 * math.sin(phi) ** 2
    north = math.radians(lat - origin[0]) * 6378137.0 * (1.0 - e2) / w ** 1.5
    east = math.radians(lon - origin[1]) * 6378137.0 / math.sqrt(w) * math.cos(phi)
    return east, north


def check_outlines(name, expected, turn_rad, origin):
    found = {}
    if os.path.exists(name):
        for poly in ET.parse(name).getroot().findall("poly"):
            points = [tuple(float(v) for v in p.split(",")[:2])
                      for p in poly.get("shape").split()]
            if origin:
                points = [geo_to_metres(x, y, origin) for x, y in points]
            if len(points) > 1 and points[0] == points[-1]:
                points.pop()
            found[(poly.get("type"), poly.get("id"))] = points
    c, s = math.cos(turn_rad), math.sin(turn_rad)
    worst = 0.0
    left = set(found)
    for outline in expected:
        corners = [(c * x - s * y, s * x + c * y) for x, y in outline["corners"]]
        best = None
        for key in left:
            if key[0] != outline["type"] or len(found[key]) != len(corners):
                continue
            far = max(min(math.dist(p, q) for q in found[key]) for p in corners)
            if best is None or far < best[0]:
                best = (far, key)
        if best is None or best[0] > 0.01:
            problem(f"outline {outline}: nearest {best}")
        else:
            worst = max(worst, best[0])
            left.discard(best[1])
    if left:
        problem(f"outlines that nobody expects: {sorted(left)}")
    print("outline", f"{worst:.5f}", len(found))


def edges_of_roads(net):
    """Edges of each road in driving order."""
    edges = {}
    for edge in net.edges():
        edges.setdefault(road_of_edge(edge), []).append(edge)
    for of_road in edges.values():
        of_road.sort(key=lambda e: int(e.split("#")[1]) if "#" in e else 0)
    return edges


def write_routes(name, net, together):
    """A vehicle through every road, and one from every road into every one that follows it.

    Not `together`: each one starts after the last has arrived.
    """
    edges = edges_of_roads(net)
    routes = [of_road for of_road in edges.values()]
    for a, b in net.connections:
        if road_of_edge(a) != road_of_edge(b):
            routes.append(edges[road_of_edge(a)] + edges[road_of_edge(b)])
    with open(name, "w") as file:
        file.write('<routes>\n<vType id="car" speedFactor="1" speedDev="0" sigma="0" '
                   'accel="2" decel="4" length="4" minGap="1"/>\n')
        depart = 0.0
        for i, route in enumerate(routes):
            file.write(f'<vehicle id="{i}" type="car" depart="{depart:.1f}" departSpeed="0">'
                       f'<route edges="{" ".join(route)}"/></vehicle>\n')
            lanes = [net.lanes[edge + "_0"] for edge in route]
            depart += 5.0 if together else 20.0 + 1.5 * sum((n[2] + 10.0) / n[1] for n in lanes)
        file.write("</routes>\n")
    return len(routes)


def nearest_limit(paths, x, y):
    """What the map says at a place: of the lane nearest to it."""
    best = None
    for path in paths.values():
        place = path.nearest(x, y, 5)
        if place is not None and (best is None or place[0] < best[0][0]):
            best = (place, path)
    if best is None or best[0][0] > 6.0:
        return None
    return best[1].speed_at(best[0])


def check_speeds(name, net, roads, paths):
    excess = 0.0
    lanes, turns = set(), set()
    for _, vehicle in ET.iterparse(name):
        if vehicle.tag != "vehicle":
            continue
        x = float(vehicle.get("x")) - net.offset[0]
        y = float(vehicle.get("y")) - net.offset[1]
        speed = float(vehicle.get("speed"))
        edge = vehicle.get("lane").rsplit("_", 1)[0]
        if edge in net.internal:
            turns.add(edge)
            limit = nearest_limit(paths, x, y)
        else:
            lanes.add(edge)
            path = paths[roads[road_of_edge(edge)].lane]
            place = path.nearest(x, y)
            limit = path.speed_at(place) if place else None
            if limit is None and place:
                bend = abs(path.kappa[place[1]])
                limit = min(30 / 3.6, math.sqrt(1.5 / bend) if bend > 0 else 99)
        if limit is not None:
            if speed - limit > 0.3 and speed - limit > excess:
                problem(f"{speed} m/s at {x:.2f},{y:.2f} on {edge}, map has {limit:.2f}")
            excess = max(excess, speed - limit)
        vehicle.clear()
    for edge in net.edges():
        if edge not in lanes and net.lanes[edge + "_0"][2] > 2.0:
            problem(f"nobody was seen on {edge}")
    return excess, len(lanes), len(turns)


def drive(folder, net, roads, paths, together):
    routes, fcd = os.path.join(folder, "r.rou.xml"), os.path.join(folder, "fcd.xml")
    trips, stats = os.path.join(folder, "trips.xml"), os.path.join(folder, "stats.xml")
    vehicles = write_routes(routes, net, together)
    status, lines = run(["sumo", "-n", os.path.join(folder, "net.xml"), "-r", routes,
                         "--xml-validation", "never", "--xml-validation.net", "never",
                         "--xml-validation.routes", "never",
                         "--step-length", str(STEP_S), "--no-step-log", "--seed", "1",
                         "--fcd-output", fcd, "--device.fcd.period", "0.5", "--tripinfo-output", trips,
                         "--statistic-output", stats, "--collision.action", "warn",
                         "--time-to-teleport", "60", "--precision", "4"]
                        # Both ways of a narrow street lie in one place: one by one there.
                        + ([] if together else ["--collision.check-junctions"]))
    if status != 0:
        problem(f"sumo ended with {status}")
    for line in lines:
        if "SUMO_HOME" not in line:
            problem(f"sumo: {line}")
    arrived = len(ET.parse(trips).getroot().findall("tripinfo"))
    root = ET.parse(stats).getroot()
    teleports = int(root.find("teleports").get("total"))
    collisions = int(root.find("safety").get("collisions"))
    excess, lanes, turns = check_speeds(fcd, net, roads, paths)
    print("drive", vehicles, arrived, teleports, collisions, f"{excess:.4f}", lanes, turns)
    if arrived != vehicles or teleports or collisions:
        problem(f"{vehicles} vehicles, {arrived} arrived, {teleports} teleports, "
                f"{collisions} collisions")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("xodr")
    parser.add_argument("paths")
    parser.add_argument("folder")
    parser.add_argument("--outlines")
    parser.add_argument("--turn-deg", type=float, default=0.0)
    parser.add_argument("--origin", type=float, nargs=2)
    args = parser.parse_args()
    turn_rad = math.radians(args.turn_deg)
    types = os.path.join(args.folder, "own.typ.xml")
    with open(types, "w") as file:
        file.write(TYPES)
    net_file = os.path.join(args.folder, "net.xml")
    polygons = os.path.join(args.folder, "poly.xml")
    command = ["netconvert", "--opendrive-files", args.xodr, "-t", types,
               "--xml-validation", "never", "-o", net_file, "--polygon-output", polygons,
               "--precision", "4"]
    if args.origin:
        command += ["--precision.geo", "9"]
    status, lines = run(command)
    if status != 0:
        problem(f"netconvert ended with {status}")
    for line in lines:
        if line.strip() == "Success." or "SUMO_HOME" in line:
            continue
        problem(f"netconvert: {line}")
    if not os.path.exists(net_file):
        sys.exit(0)
    roads = {r.get("id"): Road(r) for r in ET.parse(args.xodr).getroot().findall("road")}
    net = Net(net_file)
    paths = read_paths(args.paths, turn_rad)
    check_roads(roads, net)
    check_turns(roads, net)
    check_shapes(roads, net, paths)
    expected = json.load(open(args.outlines)) if args.outlines else []
    check_outlines(polygons, expected, turn_rad, args.origin)
    drive(args.folder, net, roads, paths, False)
    drive(args.folder, net, roads, paths, True)


main()
