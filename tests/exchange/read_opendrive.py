"""Reads an OpenDRIVE file with Python's standard library alone and says what is in it.

Prints `point NAME S X Y Z` along every road's reference line, `turn FROM TO` (names) for every way
through a junction, `corner TYPE ID X Y Z` for the outlines of objects, `box TYPE ID X Y` for the
corners of their rectangles, `link ID LANE S SIDE` for parking spaces, `limit NAME S MAX UNIT` for
speeds, and `problem TEXT` for whatever does not fit together.
"""
import bisect
import math
import sys
import xml.etree.ElementTree as ET


def problem(text):
    print("problem " + text)


def cubic(element, suffix, p):
    a, b, c, d = (float(element.get(k + suffix)) for k in "abcd")
    return a + p * (b + p * (c + p * d))


def slope(element, suffix, p):
    b, c, d = (float(element.get(k + suffix)) for k in "bcd")
    return b + p * (2 * c + p * 3 * d)


class Road:
    def __init__(self, element):
        self.id = element.get("id")
        self.name = element.get("name")
        self.junction = element.get("junction")
        self.length = float(element.get("length"))
        self.geometry = element.findall("planView/geometry")
        self.elevation = element.findall("elevationProfile/elevation")
        self.begins = [float(g.get("s")) for g in self.geometry]
        self.rises = [float(e.get("s")) for e in self.elevation]
        self.link = {e.tag: e for e in element.find("link")}
        self.lane = element.find("lanes/laneSection/right/lane")
        self.width = float(self.lane.find("width").get("a"))
        self.objects = element.findall("objects/object")
        offset = float(element.find("lanes/laneOffset").get("a"))
        if abs(offset - self.width / 2) > 1e-6:
            problem(f"road {self.id}: lane not in the middle")
        end = 0.0
        for g in self.geometry:
            if abs(float(g.get("s")) - end) > 1e-6:
                problem(f"road {self.id}: gap in s at {g.get('s')}")
            end += float(g.get("length"))
        if abs(end - self.length) > 1e-5:
            problem(f"road {self.id}: geometry of {end} m on {self.length} m")

    def at(self, s):
        g = self.geometry[bisect.bisect_right(self.begins, s + 1e-9) - 1]
        poly = g.find("paramPoly3")
        if poly.get("pRange") != "arcLength":
            problem("pRange")
        p = s - float(g.get("s"))
        u, v = cubic(poly, "U", p), cubic(poly, "V", p)
        h = float(g.get("hdg"))
        x = float(g.get("x")) + u * math.cos(h) - v * math.sin(h)
        y = float(g.get("y")) + u * math.sin(h) + v * math.cos(h)
        heading = h + math.atan2(slope(poly, "V", p), slope(poly, "U", p))
        e = self.elevation[bisect.bisect_right(self.rises, s + 1e-9) - 1]
        return x, y, cubic(e, "", s - float(e.get("s"))), heading

    def say_objects(self):
        """Outlines and rectangles, by the standard's frames: road at s, moved by t, turned."""
        for o in self.objects:
            x, y, z, heading = self.at(float(o.get("s")))
            t = float(o.get("t"))
            x, y = x - t * math.sin(heading), y + t * math.cos(heading)
            z += float(o.get("zOffset"))
            heading += float(o.get("hdg"))
            c, s = math.cos(heading), math.sin(heading)
            what = f"{o.get('type')} {o.get('id')}"
            for k in o.findall("outlines/outline/cornerLocal"):
                u, v = float(k.get("u")), float(k.get("v"))
                print("corner", what, f"{x + c * u - s * v:.6f} {y + s * u + c * v:.6f}",
                      f"{z + float(k.get('z')):.6f}")
            l, w = float(o.get("length")) / 2, float(o.get("width")) / 2
            for u, v in ((-l, -w), (-l, w), (l, w), (l, -w)):
                print("box", what, f"{x + c * u - s * v:.6f} {y + s * u + c * v:.6f}")
            data = {d.get("code"): d.get("value") for d in o.findall("userData")}
            if "lane" in data:
                print("link", o.get("id"), data["lane"], data["lane_s_m"], data["lane_side"])

    def end(self, contact, outwards):
        """Place and direction at an end, looking out of the road or into it."""
        x, y, z, heading = self.at(self.length if contact == "end" else 0.0)
        if (contact == "end") != outwards:
            heading += math.pi
        return x, y, z, heading


def compare(what, a, b):
    if math.dist(a[:3], b[:3]) > 0.01:
        problem(f"{what}: {math.dist(a[:3], b[:3]):.4f} m apart")
    if abs(math.remainder(a[3] - b[3], 2 * math.pi)) > 0.01:
        problem(f"{what}: kink of {math.remainder(a[3] - b[3], 2 * math.pi):.4f} rad")


def main():
    root = ET.parse(sys.argv[1]).getroot()
    header = root.find("header")
    if (header.get("revMajor"), header.get("revMinor")) != ("1", "6"):
        problem("revision")
    print("georeference", (header.findtext("geoReference") or "none").strip())
    roads = {e.get("id"): Road(e) for e in root.findall("road")}
    junctions = {e.get("id"): e for e in root.findall("junction")}
    if len(roads) + len(junctions) != len(root.findall("road")) + len(root.findall("junction")):
        problem("ids are not unique")
    for road in roads.values():
        steps = max(1, math.ceil(road.length))
        for i in range(steps + 1):
            s = road.length * i / steps
            x, y, z, _ = road.at(s)
            print("point", road.name.replace(" ", "_"), f"{s:.9f} {x:.9f} {y:.9f} {z:.9f}")
        road.say_objects()
        for v in road.lane.findall("speed"):
            print("limit", road.name.replace(" ", "_"), v.get("sOffset"), v.get("max"),
                  v.get("unit"))
        # Inside, neighbouring geometries meet.
        for g in road.geometry[1:]:
            s = float(g.get("s"))
            compare(f"road {road.id} at {s}", road.at(s - 1e-6), road.at(s + 1e-6))
        for tag, e in road.link.items():
            if e.get("elementType") == "junction":
                if e.get("elementId") not in junctions:
                    problem(f"road {road.id}: no junction {e.get('elementId')}")
                continue
            other = roads[e.get("elementId")]
            mine = "end" if tag == "successor" else "start"
            compare(f"road {road.id} and {other.id}", road.end(mine, True),
                    other.end(e.get("contactPoint"), False))
    connecting = set()
    for junction in junctions.values():
        for c in junction.findall("connection"):
            incoming, through = roads[c.get("incomingRoad")], roads[c.get("connectingRoad")]
            connecting.add(through.id)
            if through.junction != junction.get("id"):
                problem(f"connecting road {through.id} of another junction")
            if not any(e.get("elementId") == junction.get("id") for e in incoming.link.values()):
                problem(f"road {incoming.id} does not lead to junction {junction.get('id')}")
            link = c.find("laneLink")
            if (link.get("from"), link.get("to")) != ("-1", "-1"):
                problem("lane link")
            if c.get("contactPoint") != "start" or through.lane.get("type") != "driving":
                problem(f"connecting road {through.id} is driven against its way")
            if through.link["predecessor"].get("elementId") != incoming.id:
                problem(f"connecting road {through.id} does not come from road {incoming.id}")
            print("turn", incoming.name.replace(" ", "_"),
                  roads[through.link["successor"].get("elementId")].name.replace(" ", "_"))
    for road in roads.values():
        if (road.junction != "-1") != (road.id in connecting):
            problem(f"road {road.id} is in a junction without connection")
        print("road", road.name.replace(" ", "_"), road.lane.get("type"), f"{road.length:.6f}",
              f"{road.width:.6f}")


main()
