"""Checks a Lanelet2 OSM file as its consumers would, with Python's standard library alone.

    check_lanelet2.py FILE LATITUDE LONGITUDE [autoware]     (of the map's origin, degrees)

Prints `problem TEXT` for each fault, and what is in the file:
`lanelet ID KMH LENGTH_M ONE_WAY PART [TURN]` (PART: lane or crosswalk), `bound ID left|right X Y Z`
(metres east and north of the origin), `follows A ahead|back B ahead|back`, `route A ahead|back B
ahead|back SECONDS` between all lanelets that vehicles may use, `area X Y ...`,
`crosswalk ID X Y ...` (outline), `space ID LANELET FRONT_X FRONT_Y BACK_X BACK_Y WIDTH`, `lot N`.
Exit status 1 where there is a problem.

Rules: Lanelet2 1.2: traffic rules of Germany, validator (tags, points too close, duplicated points,
curvature), OSM reader, routing graph. Autoware: autoware_lanelet2_extension (format, regulatory
elements, query.cpp: getLinkedLanelets), vector map requirements vm-01-01 and vm-05-01.
"""
import heapq
import math
import re
import sys
import xml.etree.ElementTree as ET

from plane_geometry import (LocalFrame, area, centre_line, cross, crosses_itself, distance,
                            is_inside, length, line_to_polygon, menger_curvature, polygons_meet,
                            subtract)

problems = 0

# Tag keys are known by how they begin, values by list: lanelet2_validation, CheckTags.
KNOWN_KEYS = {
    "node": ("ele", "type", "subtype"),
    "way": ("type", "subtype", "lane_change", "width", "height", "temporary", "color"),
    "lanelet": ("type", "subtype", "one_way", "name", "region", "speed_limit", "location",
                "participant"),
    "multipolygon": ("type", "subtype", "speed_limit", "location", "region", "name"),
    "regulatory_element": ("dynamic", "fallback", "sign_type", "speed_limit", "subtype", "type"),
}
LINE_TYPES = {
    "arrow", "bike_marking", "bump", "curbstone", "door", "fence", "gate", "guard_rail",
    "jersey_barrier", "keepout", "lift_gate", "line_thick", "line_thin", "pedestrian_marking",
    "rail", "road_border", "stop_line", "symbol", "traffic_light", "traffic_sign", "trajectory",
    "virtual", "visualization", "wall", "zebra_marking", "zig-zag"}
LANELET_SUBTYPES = {
    "bicycle_lane", "bus_lane", "crosswalk", "emergency_lane", "highway", "play_street", "rail",
    "road", "shared_walkway", "stairs", "walkway"}
AREA_SUBTYPES = LANELET_SUBTYPES - {"rail", "bicycle_lane"} | {
    "bicycle_lane", "building", "exit", "freespace", "keepout", "parking", "traffic_island",
    "vegetation"}
PLAIN_RULES = {"traffic_light", "traffic_sign", "speed_limit", "right_of_way", "all_way_stop"}
# Whom a subtype lets pass, and the limits of German traffic rules for vehicles [km/h].
VEHICLE_SUBTYPES = {"road", "highway", "play_street", "exit", ""}
GERMAN_LIMITS = {("urban", "road"): 50, ("nonurban", "road"): 100, ("urban", "highway"): 130,
                 ("nonurban", "highway"): 130, ("urban", "play_street"): 7,
                 ("nonurban", "play_street"): 7, ("urban", "exit"): 50}
UNITS = {"": 1.0, "km/h": 1.0, "kmh": 1.0, "kph": 1.0, "mps": 3.6, "m/s": 3.6, "mph": 1.609344}


def problem(text):
    global problems
    problems += 1
    print("problem", text)


def tags_of(element):
    return {t.get("k"): t.get("v") for t in element.findall("tag")}


def limit_kmh(tags):
    """What Lanelet2's traffic rules read for vehicles; 0 is their word for no limit known."""
    if "speed_limit" in tags:
        found = re.fullmatch(r"([0-9]+\.?[0-9]*) *([a-z/]*)", tags["speed_limit"])
        return float(found[1]) * UNITS.get(found[2], 0.0) if found else 0.0
    return float(GERMAN_LIMITS.get((tags.get("location", "urban"), tags.get("subtype", "road")), 0))


def vehicles_pass(tags):
    participants = [k for k in tags if k.startswith("participant")]
    if participants:
        return any("participant:vehicle".startswith(k) and tags[k] in ("yes", "true", "1")
                   for k in participants)
    return tags.get("subtype", "") in VEHICLE_SUBTYPES


class OsmMap:
    def __init__(self, path, frame, autoware):
        self.autoware = autoware
        root = ET.parse(path).getroot()
        self.nodes, self.ways, self.relations = {}, {}, {}
        self.tags = {}
        ids = set()
        for element in root:
            if element.tag == "MetaInfo":
                continue
            key = element.get("id")
            if key is None or int(key) == 0 or key in ids:
                problem(f"{element.tag} {key}: id is not unique")
            ids.add(key)
            self.tags[key] = tags_of(element)
            if element.tag == "node":
                self.add_node(key, element, frame)
            elif element.tag == "way":
                self.ways[key] = [nd.get("ref") for nd in element.findall("nd")]
            elif element.tag == "relation":
                self.relations[key] = [(m.get("type"), m.get("ref"), m.get("role"))
                                       for m in element.findall("member")]
        for key, refs in self.ways.items():
            if len(refs) < 2 or any(r not in self.nodes for r in refs):
                problem(f"way {key}: fewer than two nodes, or one that is not in the file")
            if any(a == b for a, b in zip(refs, refs[1:])):
                problem(f"way {key}: the same node twice in succession")
        for key, members in self.relations.items():
            for kind, ref, _ in members:
                if ref not in (self.ways if kind == "way" else self.relations):
                    problem(f"relation {key}: no {kind} {ref}")

    def add_node(self, key, element, frame):
        latitude, longitude = float(element.get("lat")), float(element.get("lon"))
        if not (abs(latitude) <= 90 and abs(longitude) <= 180) or (latitude, longitude) == (0, 0):
            problem(f"node {key}: latitude and longitude are no place")
        tags = self.tags[key]
        x, y = frame.east_north(latitude, longitude)
        if "ele" not in tags:
            problem(f"node {key}: no ele")
        self.nodes[key] = (x, y, float(tags.get("ele", 0)))
        if not self.autoware:
            return
        if "local_x" not in tags or "local_y" not in tags:
            problem(f"node {key}: no local_x, local_y")
        elif distance((x, y), (float(tags["local_x"]), float(tags["local_y"]))) > 0.01:
            problem(f"node {key}: local_x, local_y are not where latitude and longitude are")

    def of_type(self, name):
        return [k for k in self.relations if self.tags[k].get("type") == name]

    def line(self, way):
        return [self.nodes[n][:2] for n in self.ways[way]]

    def check_tags(self):
        for key, tags in self.tags.items():
            kind = ("node" if key in self.nodes else "way" if key in self.ways
                    else tags.get("type", "no type"))
            if kind not in KNOWN_KEYS:
                problem(f"relation {key}: type {kind} is unknown")
                continue
            if kind != "node" and "type" not in tags:
                problem(f"{kind} {key}: no type")
            if kind in ("lanelet", "multipolygon"):
                self.check_place_tags(kind, key, tags)
            for name, value in tags.items():
                if name.startswith(("one_way", "participant", "dynamic", "area")) and value not in (
                        "yes", "no", "true", "false"):
                    problem(f"{kind} {key}: {name}={value} is neither yes nor no")
            if not self.autoware:
                self.check_plain_tags(kind, key, tags)

    @staticmethod
    def check_place_tags(kind, key, tags):
        for name in ("subtype", "location"):
            if name not in tags:
                problem(f"{kind} {key}: no {name}")
        if tags.get("location", "urban") not in ("urban", "nonurban"):
            problem(f"{kind} {key}: traffic rules do not know location {tags['location']}")
        known = LANELET_SUBTYPES if kind == "lanelet" else AREA_SUBTYPES
        if tags.get("subtype", "road") not in known:
            problem(f"{kind} {key}: subtype {tags['subtype']} is unknown")

    @staticmethod
    def check_plain_tags(kind, key, tags):
        for name in tags:
            if not name.startswith(KNOWN_KEYS[kind]):
                problem(f"{kind} {key}: tag {name} is unknown")
        if kind == "way" and tags.get("type") not in LINE_TYPES:
            problem(f"way {key}: type {tags.get('type')} is unknown")
        if kind == "regulatory_element" and tags.get("subtype") not in PLAIN_RULES:
            problem(f"regulatory element {key}: subtype {tags.get('subtype')} does not parse")

    def check_nodes(self):
        cells = {}
        for key, p in self.nodes.items():
            cells.setdefault((math.floor(p[0] / 0.05), math.floor(p[1] / 0.05)), []).append(key)
        for (i, j), keys in cells.items():
            near = [k for di in (-1, 0, 1) for dj in (-1, 0, 1)
                    for k in cells.get((i + di, j + dj), [])]
            for a in keys:
                for b in near:
                    if a < b and math.dist(self.nodes[a], self.nodes[b]) < 0.05:
                        problem(f"nodes {a} and {b} are too close and not shared")


class Lanelet:
    def __init__(self, osm, key):
        self.key, self.tags = key, osm.tags[key]
        bounds = {}
        for kind, ref, role in osm.relations[key]:
            if role in ("left", "right"):
                if kind != "way" or role in bounds:
                    problem(f"lanelet {key}: {role} bound is not one way")
                bounds[role] = osm.ways[ref]
        if set(bounds) != {"left", "right"}:
            problem(f"lanelet {key}: bounds {sorted(bounds)}")
            raise SystemExit(1)
        self.left, self.right = self.aligned(osm, bounds["left"], bounds["right"])
        self.left_line = [osm.nodes[n][:2] for n in self.left]
        self.right_line = [osm.nodes[n][:2] for n in self.right]
        self.centre = centre_line(self.left_line, self.right_line)
        self.length = length(self.centre)
        self.limit = limit_kmh(self.tags)
        self.ground = self.left_line + self.right_line[::-1]
        self.rules = [ref for _, ref, role in osm.relations[key] if role == "regulatory_element"]
        self.one_way = self.tags.get("one_way", "yes") in ("yes", "true", "1")

    def aligned(self, osm, left, right):
        """The same direction on both bounds, the left one to the left: as the reader turns them."""
        def points(way):
            return [osm.nodes[n][:2] for n in way]
        l, r = points(left), points(right)
        if distance(l[0], r[0]) + distance(l[-1], r[-1]) > distance(l[0], r[-1]) + distance(
                l[-1], r[0]):
            right, r = right[::-1], r[::-1]
        centre = centre_line(l, r)
        if cross(subtract(centre[26], centre[24]), subtract(centre_line(l, l)[25], centre[25])) < 0:
            left, right = left[::-1], right[::-1]
        return left, right

    def ends(self, ahead):
        left, right = (self.left, self.right) if ahead else (self.right[::-1], self.left[::-1])
        return (left[0], right[0]), (left[-1], right[-1])

    def check(self):
        if "speed_limit" not in self.tags:
            problem(f"lanelet {self.key}: no speed_limit")
        if not self.limit > 0.0:
            problem(f"lanelet {self.key}: traffic rules read 0 km/h")
        if "one_way" not in self.tags:
            problem(f"lanelet {self.key}: no one_way")
        if not 0.05 < self.length:
            problem(f"lanelet {self.key}: its centre line has no length")
        if self.length > 50.0:
            problem(f"lanelet {self.key}: {self.length:.1f} m long, at most 50 m are wanted")
        if self.left[0] == self.left[-1] or self.right[0] == self.right[-1]:
            problem(f"lanelet {self.key}: a ring in one lanelet")
        for line in (self.left_line, self.right_line):
            sharpest = max((menger_curvature(*line[i:i + 3]) for i in range(len(line) - 2)),
                           default=0.0)
            if sharpest > 0.5:
                problem(f"lanelet {self.key}: a bound bends with {sharpest:.2f} 1/m")


def states_of(lanelets):
    passable = [l for l in lanelets if vehicles_pass(l.tags)]
    return [(l, True) for l in passable] + [(l, False) for l in passable if not l.one_way]


def followers(states):
    begins = {}
    for index, (lanelet, ahead) in enumerate(states):
        begins.setdefault(lanelet.ends(ahead)[0], []).append(index)
    return [begins.get(lanelet.ends(ahead)[1], []) for lanelet, ahead in states]


def times_from(states, follow, start):
    """Seconds to the end of each state, that of the start included; Dijkstra."""
    def time_of(index):
        lanelet = states[index][0]
        return lanelet.length / (lanelet.limit / 3.6) if lanelet.limit > 0.0 else math.inf
    best = {start: time_of(start)}
    open_states = [(best[start], start)]
    while open_states:
        time, index = heapq.heappop(open_states)
        if time > best[index]:
            continue
        for after in follow[index]:
            there = time + time_of(after)
            if math.isfinite(there) and there < best.get(after, math.inf):
                best[after] = there
                heapq.heappush(open_states, (there, after))
    return best


def print_routes(lanelets):
    states = states_of(lanelets)
    follow = followers(states)
    def name(state):
        return f"{state[0].key} {'ahead' if state[1] else 'back'}"
    if not states:
        problem("no lanelet lets vehicles pass")
    for index, state in enumerate(states):
        for after in follow[index]:
            print("follows", name(state), name(states[after]))
        for there, time in times_from(states, follow, index).items():
            if there != index:
                print("route", name(state), name(states[there]), f"{time:.3f}")
                if not 0.0 < time < math.inf:
                    problem(f"route from {name(state)}: {time} s")
    return states, follow


def check_areas(osm):
    for key in osm.of_type("multipolygon"):
        ways = [list(osm.ways[ref]) for _, ref, role in osm.relations[key] if role == "outer"]
        ring = ways.pop(0) if ways else []
        while ways and ring[0] != ring[-1]:
            after = next((w for w in ways if ring[-1] in (w[0], w[-1])), None)
            if after is None:
                break
            ways.remove(after)
            ring += (after if after[0] == ring[-1] else after[::-1])[1:]
        if len(ring) < 4 or ring[0] != ring[-1] or ways:
            problem(f"area {key}: its outer ways are no ring")
            continue
        points = [osm.nodes[n][:2] for n in ring[:-1]]
        if crosses_itself(points) or abs(area(points)) < 0.1:
            problem(f"area {key}: its ring crosses itself or holds no ground")
        print("area", *(f"{c:.4f}" for p in points for c in p))


def check_crosswalks(osm, lanelets):
    walks = [l for l in lanelets if l.tags.get("subtype") == "crosswalk"]
    rules = {}
    for key in osm.of_type("regulatory_element"):
        if osm.tags[key].get("subtype") != "crosswalk":
            continue
        members = osm.relations[key]
        refers = [ref for kind, ref, role in members if role == "refers" and kind == "relation"]
        outlines = [ref for kind, ref, role in members
                    if role == "crosswalk_polygon" and kind == "way"]
        if len(refers) != 1 or not outlines:
            problem(f"regulatory element {key}: needs one refers and a crosswalk_polygon")
            continue
        for way in outlines:
            if osm.tags[way].get("type") != "crosswalk_polygon" or osm.tags[way].get(
                    "area") != "yes" or len(osm.ways[way]) < 3:
                problem(f"way {way}: no crosswalk_polygon with an area")
        rules.setdefault(refers[0], []).append((key, osm.line(outlines[0])))
    for walk in walks:
        outline = walk.ground
        if osm.autoware:
            if walk.key not in rules:
                problem(f"crosswalk {walk.key}: no regulatory element refers to it")
                continue
            rule, outline = rules[walk.key][0]
            for road in lanelets:
                over = road is not walk and vehicles_pass(road.tags) and any(
                    is_inside(p, outline) for p in road.centre)
                if over and rule not in road.rules:
                    problem(f"lanelet {road.key}: crosses {walk.key} without its rule")
        print("crosswalk", walk.key, *(f"{c:.4f}" for p in outline for c in p))


def check_parking(osm, lanelets):
    roads = [l for l in lanelets if vehicles_pass(l.tags)]
    ways = {k: osm.tags[k].get("type") for k in osm.ways}
    lots = [osm.line(k) for k in ways if ways[k] == "parking_lot"]
    for key in (k for k in ways if ways[k] == "parking_lot"):
        if osm.tags[key].get("area") != "yes" or crosses_itself(osm.line(key)):
            problem(f"way {key}: a parking_lot is an area that does not cross itself")
    print("lot", len(lots))
    for key in (k for k in ways if ways[k] == "parking_space"):
        line = osm.line(key)
        if len(line) != 2:
            problem(f"way {key}: a parking_space has two nodes, not {len(line)}")
            continue
        width = float(osm.tags[key].get("width", 0))
        if not width > 0.0:
            problem(f"way {key}: a parking_space has a width")
        lot = next((l for l in lots if line_to_polygon(line, l) == 0.0), None)
        if lot is None or not all(is_inside(p, lot) for p in line):
            problem(f"way {key}: in no parking_lot")
            continue
        front, back = line
        before = tuple(f - 5.0 * (b - f) for f, b in zip(front, back))
        linked = [l for l in roads if line_to_polygon(line, l.ground) <= 5.0
                  and line_to_polygon([before, back], l.ground) == 0.0
                  and polygons_meet(l.ground, lot)]
        if not linked:
            problem(f"way {key}: no lanelet within 5 m that it faces and that its lot touches")
            continue
        nearest = min(linked, key=lambda l: line_to_polygon(line, l.ground))
        if line_to_polygon([front, front], nearest.ground) > line_to_polygon(
                [back, back], nearest.ground):
            problem(f"way {key}: its first node is not the one at the lane")
        print("space", key, nearest.key, *(f"{c:.4f}" for p in line for c in p), f"{width:.3f}")


def check_autoware(osm, lanelets, states, follow):
    for lanelet in lanelets:
        if vehicles_pass(lanelet.tags) and not lanelet.one_way:
            problem(f"lanelet {lanelet.key}: Autoware does not know one_way=no")
    before = [[i for i in range(len(states)) if index in follow[i]] for index in range(len(states))]
    for index, (lanelet, _) in enumerate(states):
        forks = any(len(follow[i]) > 1 for i in before[index]) or any(
            len(before[i]) > 1 for i in follow[index])
        turn = lanelet.tags.get("turn_direction")
        if turn is None and forks:
            problem(f"lanelet {lanelet.key}: a turn without turn_direction")
        if turn is None:
            continue
        line = lanelet.centre
        a, b = subtract(line[1], line[0]), subtract(line[-1], line[-2])
        angle = math.degrees(math.atan2(cross(a, b), a[0] * b[0] + a[1] * b[1]))
        fits = {"left": angle > 10.0, "right": angle < -10.0, "straight": abs(angle) < 50.0}
        if not fits.get(turn, False):
            problem(f"lanelet {lanelet.key}: turn_direction {turn} turns by {angle:.0f} degrees")


def main():
    autoware = "autoware" in sys.argv[4:]
    osm = OsmMap(sys.argv[1], LocalFrame(float(sys.argv[2]), float(sys.argv[3])), autoware)
    osm.check_tags()
    osm.check_nodes()
    lanelets = [Lanelet(osm, key) for key in osm.of_type("lanelet")]
    for lanelet in lanelets:
        lanelet.check()
        part = "lane" if vehicles_pass(lanelet.tags) else lanelet.tags.get("subtype")
        print("lanelet", lanelet.key, f"{lanelet.limit:.4f}", f"{lanelet.length:.3f}",
              lanelet.tags.get("one_way"), part, lanelet.tags.get("turn_direction", ""))
        for role, way in (("left", lanelet.left), ("right", lanelet.right)):
            for node in way:
                print("bound", lanelet.key, role, *osm.nodes[node])
    states, follow = print_routes(lanelets)
    check_areas(osm)
    check_crosswalks(osm, lanelets)
    if autoware:
        check_autoware(osm, lanelets, states, follow)
        check_parking(osm, lanelets)
    sys.exit(1 if problems else 0)


main()
