"""Reads a Lanelet2 OSM file with Python's standard library alone and says what is in it.

Prints `lanelet ID PART ONE_WAY`, `bound ID left|right X Y Z` (local_x, local_y, ele), `degrees LON LAT
X Y` for every node, `follows A B` where B begins with the nodes that A ends with, and `problem TEXT`.
"""
import sys
import xml.etree.ElementTree as ET


def problem(text):
    print("problem " + text)


def tags(element):
    return {t.get("k"): t.get("v") for t in element.findall("tag")}


def main():
    root = ET.parse(sys.argv[1]).getroot()
    nodes = {e.get("id"): e for e in root.findall("node")}
    ways = {e.get("id"): e for e in root.findall("way")}
    relations = root.findall("relation")
    if len(nodes) != len(root.findall("node")) or len(ways) != len(root.findall("way")):
        problem("ids are not unique")
    if len({e.get("id") for e in relations}) != len(relations):
        problem("lanelet ids are not unique")
    places = {}
    for key, node in nodes.items():
        t = tags(node)
        places[key] = (float(t["local_x"]), float(t["local_y"]), float(t["ele"]))
        print("degrees", node.get("lon"), node.get("lat"), t["local_x"], t["local_y"])
    if len({p for p in places.values()}) != len(places):
        problem("points at the same place do not share their node")
    bounds, one_way = {}, {}
    for relation in relations:
        t = tags(relation)
        key = relation.get("id")
        for name, value in (("type", "lanelet"), ("subtype", "road"), ("location", "private")):
            if t.get(name) != value:
                problem(f"lanelet {key}: {name} is {t.get(name)}")
        if t.get("one_way") not in ("yes", "no"):
            problem(f"lanelet {key}: one_way is {t.get('one_way')}")
        side = {}
        for member in relation.findall("member"):
            refs = [nd.get("ref") for nd in ways[member.get("ref")].findall("nd")]
            if len(refs) < 2 or any(r not in nodes for r in refs) or "type" not in tags(
                    ways[member.get("ref")]):
                problem(f"way {member.get('ref')}")
            side[member.get("role")] = refs
        if set(side) != {"left", "right"}:
            problem(f"lanelet {key}: bounds {sorted(side)}")
        # The left bound lies to the left: the quadrilateral at the begin turns the right way.
        (ax, ay, _), (bx, by, _) = places[side["right"][0]], places[side["right"][1]]
        cx, cy, _ = places[side["left"][0]]
        if (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) <= 0.0:
            problem(f"lanelet {key}: bounds on the wrong side")
        bounds[key], one_way[key] = side, t["one_way"] == "yes"
        print("lanelet", key, t["roadbook:part"], t["one_way"])
        for role, refs in side.items():
            for r in refs:
                print("bound", key, role, *places[r])

    def ends(key, inverted):
        left, right = bounds[key]["left"], bounds[key]["right"]
        if inverted:
            left, right = right[::-1], left[::-1]
        return (left[0], right[0]), (left[-1], right[-1])

    states = [(k, False) for k in bounds] + [(k, True) for k in bounds if not one_way[k]]
    starts = {}
    for state in states:
        starts.setdefault(ends(*state)[0], []).append(state)
    for state in states:
        for follower in starts.get(ends(*state)[1], []):
            print("follows", state[0], "back" if state[1] else "ahead", follower[0],
                  "back" if follower[1] else "ahead")


main()
