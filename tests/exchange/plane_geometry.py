"""Geometry in plan for the checkers of exported files: Python's standard library alone."""
import math


def subtract(a, b):
    return a[0] - b[0], a[1] - b[1]


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def distance(a, b):
    return math.hypot(a[0] - b[0], a[1] - b[1])


def length(line):
    return sum(distance(a, b) for a, b in zip(line, line[1:]))


def even_points(line, count):
    """So many points of a polyline and its end, at equal distances along it."""
    step = length(line) / count
    points, passed = [line[0]], 0.0
    for a, b in zip(line, line[1:]):
        edge = distance(a, b)
        while len(points) < count and step * len(points) <= passed + edge and edge > 0.0:
            t = (step * len(points) - passed) / edge
            points.append((a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])))
        passed += edge
    return points + [line[-1]] * (count + 1 - len(points))


def centre_line(left, right, points=50):
    """Midway between two bounds, at equal shares of their lengths."""
    return [((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
            for a, b in zip(even_points(left, points), even_points(right, points))]


def menger_curvature(a, b, c):
    product = distance(a, b) * distance(b, c) * distance(a, c)
    if product < 1e-20:
        return math.inf
    return 2.0 * abs(cross(subtract(b, a), subtract(c, a))) / product


def point_to_segment(p, a, b):
    d = subtract(b, a)
    square = d[0] * d[0] + d[1] * d[1]
    t = 0.0
    if square > 0.0:
        t = min(1.0, max(0.0, (d[0] * (p[0] - a[0]) + d[1] * (p[1] - a[1])) / square))
    return distance(p, (a[0] + t * d[0], a[1] + t * d[1]))


def segments_meet(a, b, c, d):
    def side(p, q, r):
        value = cross(subtract(q, p), subtract(r, p))
        return (value > 0) - (value < 0)

    if side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0:
        return True
    return min(point_to_segment(a, c, d), point_to_segment(b, c, d),
               point_to_segment(c, a, b), point_to_segment(d, a, b)) < 1e-12


def ring_edges(ring):
    return list(zip(ring, ring[1:] + ring[:1]))


def is_inside(p, ring):
    inside = False
    for (ax, ay), (bx, by) in ring_edges(ring):
        if (ay > p[1]) != (by > p[1]) and p[0] < ax + (p[1] - ay) / (by - ay) * (bx - ax):
            inside = not inside
    return inside


def line_to_polygon(line, ring):
    """Distance of a polyline from a polygon's ground; 0 where they meet."""
    if is_inside(line[0], ring) or is_inside(line[-1], ring):
        return 0.0
    least = math.inf
    for a, b in zip(line, line[1:]):
        for c, d in ring_edges(ring):
            if segments_meet(a, b, c, d):
                return 0.0
            least = min(least, point_to_segment(a, c, d), point_to_segment(b, c, d),
                        point_to_segment(c, a, b), point_to_segment(d, a, b))
    return least


def polygons_meet(a, b):
    return line_to_polygon(a + a[:1], b) == 0.0 or is_inside(b[0], a)


def area(ring):
    return 0.5 * sum(cross(a, b) for a, b in ring_edges(ring))


def crosses_itself(ring):
    edges = ring_edges(ring)
    for i, (a, b) in enumerate(edges):
        for j in range(i + 2, len(edges)):
            if (i, j) != (0, len(edges) - 1) and segments_meet(a, b, *edges[j]):
                return True
    return False


class LocalFrame:
    """East and north of a place on the WGS84 ellipsoid, by way of earth-centred coordinates."""
    A, F = 6378137.0, 1.0 / 298.257223563

    def __init__(self, latitude_deg, longitude_deg):
        self.latitude, self.longitude = math.radians(latitude_deg), math.radians(longitude_deg)
        self.origin = self.earth_centred(self.latitude, self.longitude)

    def earth_centred(self, latitude, longitude):
        e2 = self.F * (2.0 - self.F)
        n = self.A / math.sqrt(1.0 - e2 * math.sin(latitude) ** 2)
        return (n * math.cos(latitude) * math.cos(longitude),
                n * math.cos(latitude) * math.sin(longitude), n * (1.0 - e2) * math.sin(latitude))

    def east_north(self, latitude_deg, longitude_deg):
        p = self.earth_centred(math.radians(latitude_deg), math.radians(longitude_deg))
        x, y, z = (p[i] - self.origin[i] for i in range(3))
        sin_lat, cos_lat = math.sin(self.latitude), math.cos(self.latitude)
        sin_lon, cos_lon = math.sin(self.longitude), math.cos(self.longitude)
        return (-sin_lon * x + cos_lon * y,
                -sin_lat * cos_lon * x - sin_lat * sin_lon * y + cos_lat * z)
