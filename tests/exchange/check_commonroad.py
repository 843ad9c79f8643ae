"""Checks a CommonRoad scenario (XML 2020a) as its reader would, with Python's standard library.

    check_commonroad.py FILE

Prints `problem TEXT` for each fault, and what is in the file: `lanelet ID TYPE,TYPE LIMIT_MPS
LENGTH_M`, `left|right ID X Y`, `follows A B`, `goal SECONDS` (by the limits, from the initial state).
Exit status 1 where there is a problem. Rules: the schema's order of elements and lists of values;
commonroad-io: reader (signs by country of the benchmark id, every sign is referred to), centre
midway between points of as many on both bounds, successors that begin where a lanelet ends.
"""
import heapq
import math
import re
import sys
import xml.etree.ElementTree as ET

from plane_geometry import cross, crosses_itself, distance, length, subtract

problems = 0

ORDER = ["location", "scenarioTags", "lanelet", "trafficSign", "trafficLight", "intersection",
         "staticObstacle", "dynamicObstacle", "phantomObstacle", "environmentObstacle",
         "planningProblem"]
LANELET_ORDER = ["leftBound", "rightBound", "predecessor", "successor", "adjacentLeft",
                 "adjacentRight", "stopLine", "laneletType", "userOneWay", "userBidirectional",
                 "trafficSignRef", "trafficLightRef"]
TYPES = {"urban", "interstate", "country", "highway", "sidewalk", "crosswalk", "busLane",
         "bicycleLane", "exitRamp", "mainCarriageWay", "accessRamp", "shoulder", "driveWay",
         "busStop", "intersection", "border", "parking", "restricted", "restricted_area", "unknown"}
USERS = {"vehicle", "car", "truck", "bus", "motorcycle", "bicycle", "pedestrian",
         "priorityVehicle", "train", "taxi"}
SPEED_SIGNS = {"ZAM": "274", "DEU": "274", "CHN": "274", "ITA": "274", "USA": "R2-1",
               "PRI": "R2-1", "ESP": "r301"}
NO_ROADS = {"crosswalk", "parking", "sidewalk"}


def problem(text):
    global problems
    problems += 1
    print("problem", text)


def check_order(element, order, name):
    places = [order.index(child.tag) if child.tag in order else -1 for child in element]
    if -1 in places or places != sorted(places):
        problem(f"{name}: elements {[c.tag for c in element]} are not those of the schema, in order")


def refs(element, name):
    return [int(child.get("ref")) for child in element.findall(name)]


class Lanelet:
    def __init__(self, element, signs, country):
        self.id = int(element.get("id"))
        name = f"lanelet {self.id}"
        check_order(element, LANELET_ORDER, name)
        self.left, self.right = (self.points(element.find(b)) for b in ("leftBound", "rightBound"))
        self.types = {t.text for t in element.findall("laneletType")}
        if not self.types or self.types - TYPES:
            problem(f"{name}: types {self.types}")
        users = {u.text for tag in ("userOneWay", "userBidirectional") for u in element.findall(tag)}
        if not users or users - USERS:
            problem(f"{name}: users {users}")
        self.is_road = not self.types & NO_ROADS
        self.predecessors, self.successors = refs(element, "predecessor"), refs(element, "successor")
        self.signs = refs(element, "trafficSignRef")
        self.limit = min((signs[s][1] for s in self.signs if s in signs
                          and signs[s][0] == SPEED_SIGNS.get(country)), default=math.inf)
        self.check(name)

    @staticmethod
    def points(bound):
        return [(float(p.find("x").text), float(p.find("y").text)) for p in bound.findall("point")]

    def check(self, name):
        if len(self.left) != len(self.right) or len(self.left) < 2:
            problem(f"{name}: {len(self.left)} points to the left, {len(self.right)} to the right")
            return
        self.centre = [((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
                       for a, b in zip(self.left, self.right)]
        self.length = length(self.centre)
        if not self.length > 0.05 or self.left[0] == self.left[-1]:
            problem(f"{name}: its centre line has no length, or is a ring")
        along = subtract(self.centre[1], self.centre[0])
        if cross(along, subtract(self.left[0], self.right[0])) <= 0.0:
            problem(f"{name}: the left bound lies to the right")
        if any(distance(a, b) == 0.0 for line in (self.left, self.right)
               for a, b in zip(line, line[1:])):
            problem(f"{name}: the same point twice in succession")
        if self.is_road and not 0.0 < self.limit < math.inf:
            problem(f"{name}: no speed limit that its country's reader knows")

    def ground(self):
        return self.left + self.right[::-1]


def read_signs(root):
    signs = {}
    for sign in root.findall("trafficSign"):
        element = sign.find("trafficSignElement")
        value = element.find("additionalValue")
        signs[int(sign.get("id"))] = (element.find("trafficSignID").text,
                                      float(value.text) if value is not None else math.inf)
    return signs


def check_ids(root):
    ids = [e.get("id") for tag in ORDER for e in root.findall(tag) if e.get("id")]
    ids += [e.get("id") for e in root.findall("intersection/incoming")]
    if len(set(ids)) != len(ids) or any(int(i) <= 0 for i in ids):
        problem("ids are not unique, or not above 0")
    for element in root.iter():
        if element.get("ref") is not None and element.get("ref") not in ids:
            problem(f"{element.tag}: nothing has id {element.get('ref')}")


def check_network(lanelets):
    for lanelet in lanelets.values():
        for after in lanelet.successors:
            print("follows", lanelet.id, after)
            other = lanelets.get(after)
            if other is None or lanelet.id not in other.predecessors:
                problem(f"lanelet {lanelet.id}: its successor {after} does not name it")
            elif max(distance(lanelet.left[-1], other.left[0]),
                     distance(lanelet.right[-1], other.right[0])) > 1e-3:
                problem(f"lanelet {lanelet.id}: its successor {after} begins elsewhere")
        for before in lanelet.predecessors:
            if before in lanelets and lanelet.id not in lanelets[before].successors:
                problem(f"lanelet {lanelet.id}: its predecessor {before} does not name it")
        for other in lanelets.values():
            if lanelet.is_road and other.is_road and other.id not in lanelet.successors and max(
                    distance(lanelet.left[-1], other.left[0]),
                    distance(lanelet.right[-1], other.right[0])) < 1e-3:
                problem(f"lanelet {lanelet.id}: {other.id} begins at its end, but is no successor")


def time_to(lanelets, start, goals):
    best = {start: 0.0}
    todo = [(0.0, start)]
    while todo:
        time, key = heapq.heappop(todo)
        if key in goals:
            return time
        for after in lanelets[key].successors:
            there = time + lanelets[key].length / lanelets[key].limit
            if there < best.get(after, math.inf):
                best[after] = there
                heapq.heappush(todo, (there, after))
    return math.inf


def check_problem(element, lanelets, step_s):
    state = element.find("initialState")
    place = Lanelet.points(state.find("position"))[0]
    heading = float(state.find("orientation/exact").text)
    ahead = math.cos(heading), math.sin(heading)

    def begins_there(lanelet):
        along = subtract(lanelet.centre[1], lanelet.centre[0])
        return distance(lanelet.centre[0], place) < 0.01 and (
            along[0] * ahead[0] + along[1] * ahead[1]) > 0.95 * math.hypot(*along)

    starts = [l.id for l in lanelets.values() if l.is_road and begins_there(l)]
    if not starts:
        problem("planning problem: its initial state is at the begin of no lanelet")
    for name in ("velocity", "yawRate", "slipAngle", "time"):
        if state.find(f"{name}/exact") is None:
            problem(f"initial state: no {name}")
    goal = element.find("goalState")
    latest = int(goal.find("time/intervalEnd").text) * step_s
    goals = set(refs(goal.find("position"), "lanelet"))
    time = min((time_to(lanelets, start, goals) for start in starts), default=math.inf)
    print("goal", time)
    if not time < latest:
        problem(f"planning problem: the goal takes {time} s, {latest} s are allowed")


def main():
    root = ET.parse(sys.argv[1]).getroot()
    if root.tag != "commonRoad" or root.get("commonRoadVersion") != "2020a":
        problem("no CommonRoad 2020a")
    for name in ("benchmarkID", "date", "author", "affiliation", "source", "timeStepSize"):
        if root.get(name) is None:
            problem(f"no attribute {name}")
    if not re.fullmatch(r"(C-)?[A-Z]{3}_[a-zA-Z0-9]+-[1-9][0-9]*(_[1-9][0-9]*)?",
                        root.get("benchmarkID", "")):
        problem(f"benchmark id {root.get('benchmarkID')}")
    check_order(root, ORDER, "scenario")
    check_ids(root)
    for name in ("geoNameId", "gpsLatitude", "gpsLongitude"):
        if root.find(f"location/{name}") is None:
            problem(f"location: no {name}")
    signs = read_signs(root)
    lanelets = {}
    for element in root.findall("lanelet"):
        lanelet = Lanelet(element, signs, root.get("benchmarkID", "")[:3])
        lanelets[lanelet.id] = lanelet
        print("lanelet", lanelet.id, ",".join(sorted(lanelet.types)), lanelet.limit,
              f"{lanelet.length:.3f}")
        for side, line in (("left", lanelet.left), ("right", lanelet.right)):
            for p in line:
                print(side, lanelet.id, *p)
        if not lanelet.is_road and crosses_itself(lanelet.ground()):
            problem(f"lanelet {lanelet.id}: its outline crosses itself")
    for sign in set(signs) - {s for l in lanelets.values() for s in l.signs}:
        problem(f"sign {sign}: no lanelet refers to it")
    check_network(lanelets)
    planning = root.findall("planningProblem")
    if not planning:
        problem("no planning problem")
    for element in planning:
        check_problem(element, lanelets, float(root.get("timeStepSize")))
    sys.exit(1 if problems else 0)


main()
