"""Breaks an exported file in named ways, so that its checker can be seen to find each.

    break_export.py FILE FOLDER FAULT...

Writes FOLDER/FAULT for each of the faults.
"""
import copy
import math
import sys
import xml.etree.ElementTree as ET


class Osm:
    def __init__(self, path):
        self.tree = ET.parse(path)
        self.root = self.tree.getroot()
        self.by_id = {e.get("id"): e for e in self.root}

    def tag(self, element, key):
        return next((t for t in element.findall("tag") if t.get("k") == key), None)

    def value(self, element, key):
        tag = self.tag(element, key)
        return None if tag is None else tag.get("v")

    def put(self, element, key, value):
        self.drop(element, key)
        ET.SubElement(element, "tag", k=key, v=value)

    def drop(self, element, key):
        tag = self.tag(element, key)
        if tag is not None:
            element.remove(tag)

    def first(self, kind, **tags):
        return next(e for e in self.root.findall(kind)
                    if all(self.value(e, k) == v for k, v in tags.items()))

    def road(self):
        return self.first("relation", type="lanelet", subtype="road")

    def bound(self, relation, role):
        ref = next(m.get("ref") for m in relation.findall("member") if m.get("role") == role)
        return self.by_id[ref]

    def copy_of(self, node, east=0.0):
        other = copy.deepcopy(node)
        other.set("id", str(10 ** 15 + len(self.root)))
        other.set("lon", repr(float(other.get("lon")) + east))
        self.root.insert(0, other)
        return other.get("id")


def no_limit(osm):
    osm.drop(osm.road(), "speed_limit")


def zero_limit(osm):
    osm.put(osm.road(), "speed_limit", "0")


def private(osm):
    osm.put(osm.road(), "location", "private")


def no_subtype(osm):
    osm.drop(osm.road(), "subtype")


def unknown_tag(osm):
    osm.put(osm.road(), "roadbook:part", "lane")


def local_tags(osm):
    osm.put(osm.root.find("node"), "local_x", "0")


def unknown_line(osm):
    osm.put(osm.root.find("way"), "type", "painted")


def ring(osm):
    for role in ("left", "right"):
        way = osm.bound(osm.road(), role)
        ET.SubElement(way, "nd", ref=way.find("nd").get("ref")).tail = None
        nodes, tags = way.findall("nd"), way.findall("tag")
        for child in list(way):
            way.remove(child)
        way.extend(nodes + tags)


def unshared(osm):
    way = osm.bound(osm.road(), "left")
    last = way.findall("nd")[-1]
    last.set("ref", osm.copy_of(osm.by_id[last.get("ref")]))


def too_close(osm):
    osm.copy_of(osm.root.find("node"), east=2e-7)


def too_long(osm):
    for role in ("left", "right"):
        node = osm.by_id[osm.bound(osm.road(), role).findall("nd")[-1].get("ref")]
        node.set("lat", repr(float(node.get("lat")) + 0.002))


def no_length(osm):
    road = osm.road()
    for role in ("left", "right"):
        way = osm.bound(road, role)
        nodes = way.findall("nd")
        first = osm.by_id[nodes[0].get("ref")]
        for nd in nodes[1:]:
            node = osm.by_id[nd.get("ref")]
            node.set("lat", first.get("lat")), node.set("lon", first.get("lon"))


def bent(osm):
    nodes = osm.bound(osm.road(), "left").findall("nd")
    node = osm.by_id[nodes[len(nodes) // 2].get("ref")]
    node.set("lat", repr(float(node.get("lat")) + 3e-5))
    node.set("lon", repr(float(node.get("lon")) + 8e-6))


def same_id(osm):
    way = osm.root.find("way")
    way.set("id", osm.root.find("node").get("id"))


def area_participant(osm):
    osm.put(osm.first("relation", type="multipolygon"), "participant:vehicle", "yes")


def open_area(osm):
    area = osm.first("relation", type="multipolygon")
    area.remove(area.find("member"))


def rule_in_plain(osm):
    rule = ET.SubElement(osm.root, "relation", id=str(10 ** 15))
    osm.put(rule, "type", "regulatory_element")
    osm.put(rule, "subtype", "crosswalk")


def walking_cars(osm):
    for relation in osm.root.findall("relation"):
        if osm.value(relation, "subtype") == "road":
            osm.put(relation, "subtype", "walkway")


def unturned(osm):
    turn = math.radians(-30)
    for node in osm.root.findall("node"):
        x, y = float(osm.value(node, "local_x")), float(osm.value(node, "local_y"))
        osm.put(node, "local_x", repr(math.cos(turn) * x - math.sin(turn) * y))
        osm.put(node, "local_y", repr(math.sin(turn) * x + math.cos(turn) * y))


def no_local(osm):
    osm.drop(osm.root.find("node"), "local_y")


def no_height(osm):
    osm.drop(osm.root.find("node"), "ele")


def two_ways(osm):
    osm.put(osm.road(), "one_way", "no")


def three_nodes(osm):
    way = osm.first("way", type="parking_space")
    way.insert(1, ET.Element("nd", ref=osm.root.find("node").get("id")))


def turned_space(osm):
    first, last = osm.first("way", type="parking_space").findall("nd")
    a, b = first.get("ref"), last.get("ref")
    first.set("ref", b), last.set("ref", a)


def no_width(osm):
    osm.drop(osm.first("way", type="parking_space"), "width")


def no_lot(osm):
    for way in osm.root.findall("way"):
        if osm.value(way, "type") == "parking_lot":
            osm.root.remove(way)


def open_lot(osm):
    osm.drop(osm.first("way", type="parking_lot"), "area")


def far_space(osm):
    for nd in osm.first("way", type="parking_space").findall("nd"):
        node = osm.by_id[nd.get("ref")]
        node.set("lat", repr(float(node.get("lat")) + 0.01))


def turn_of(osm, direction):
    return osm.first("relation", type="lanelet", turn_direction=direction)


def no_turn_direction(osm):
    for relation in osm.root.findall("relation"):
        osm.drop(relation, "turn_direction")


def wrong_turn_direction(osm):
    osm.put(turn_of(osm, "left"), "turn_direction", "right")


def straight_turn(osm):
    osm.put(turn_of(osm, "right"), "turn_direction", "straight")


def no_rule(osm):
    rule = osm.first("relation", type="regulatory_element")
    osm.root.remove(rule)
    for relation in osm.root.findall("relation"):
        for member in relation.findall("member"):
            if member.get("ref") == rule.get("id"):
                relation.remove(member)


def rule_without_walk(osm):
    rule = osm.first("relation", type="regulatory_element")
    rule.remove(next(m for m in rule.findall("member") if m.get("role") == "refers"))


def rule_without_outline(osm):
    rule = osm.first("relation", type="regulatory_element")
    rule.remove(next(m for m in rule.findall("member") if m.get("role") == "crosswalk_polygon"))


def road_without_rule(osm):
    for relation in osm.root.findall("relation"):
        for member in relation.findall("member"):
            if member.get("role") == "regulatory_element":
                relation.remove(member)


# CommonRoad.

def cr_no_problem(osm):
    osm.root.remove(osm.root.find("planningProblem"))


def cr_no_limit(osm):
    lanelet = osm.root.find("lanelet")
    lanelet.remove(lanelet.find("trafficSignRef"))


def cr_foreign_sign(osm):
    osm.root.find("trafficSign/trafficSignElement/trafficSignID").text = "R2-1"


def cr_zero_limit(osm):
    osm.root.find("trafficSign/trafficSignElement/additionalValue").text = "0"


def cr_no_type(osm):
    lanelet = osm.root.find("lanelet")
    lanelet.remove(lanelet.find("laneletType"))


def cr_uneven_bounds(osm):
    bound = osm.root.find("lanelet/leftBound")
    bound.remove(bound.findall("point")[-1])


def cr_one_sided(osm):
    lanelet = next(l for l in osm.root.findall("lanelet") if l.find("successor") is not None)
    lanelet.remove(lanelet.find("successor"))


def cr_no_links(osm):
    for lanelet in osm.root.findall("lanelet"):
        for name in ("successor", "predecessor"):
            for child in lanelet.findall(name):
                lanelet.remove(child)


def cr_moved(osm):
    point = next(l for l in osm.root.findall("lanelet") if l.find("successor") is not None).findall(
        "leftBound/point")[-1]
    point.find("x").text = str(float(point.find("x").text) + 0.5)


def cr_order(osm):
    lanelet = osm.root.find("lanelet")
    bound = lanelet.find("rightBound")
    lanelet.remove(bound)
    lanelet.insert(0, bound)


def cr_swapped(osm):
    lanelet = osm.root.find("lanelet")
    left, right = lanelet.find("leftBound"), lanelet.find("rightBound")
    left.tag, right.tag = "rightBound", "leftBound"
    lanelet.remove(right)
    lanelet.insert(0, right)


def cr_dangling(osm):
    osm.root.find("lanelet/trafficSignRef").set("ref", "1234567")


def cr_same_id(osm):
    osm.root.find("trafficSign").set("id", osm.root.find("lanelet").get("id"))


def cr_version(osm):
    osm.root.set("commonRoadVersion", "2018b")


def cr_hasty(osm):
    osm.root.find("planningProblem/goalState/time/intervalEnd").text = "1"


def main():
    for fault in sys.argv[3:]:
        osm = Osm(sys.argv[1])
        globals()[fault](osm)
        osm.tree.write(f"{sys.argv[2]}/{fault}")


main()
