"""Small good inputs with which the fuzz targets begin, and the words that their formats know."""
import base64
import struct
import zlib

CAMERA = """sensor_type: camera
T_BS: {rows: 4, cols: 4, data: [0, 0, 1, 1.5, -1, 0, 0, 0, 0, -1, 0, 1.2, 0, 0, 0, 1]}
rate_hz: 10
resolution: [16, 12]
camera_model: pinhole
intrinsics: [10, 10, 8, 6]
distortion_model: equidistant
distortion_coefficients: [0.01, 0.002, -0.001, 0.0001]
"""
WHEELS = "sensor_type: wheels\nwheel_radius_left: 0.31\nwheel_radius_right: 0.31\ntrack_width: 1.52\nwheelbase: 2.7\n"
CHAIN = """cam0:
  camera_model: pinhole
  intrinsics: [190.9, 190.2, 254.9, 256.8]
  distortion_model: equidistant
  distortion_coeffs: [0.003, 0.0007, -0.002, 0.0002]
  resolution: [512, 512]
  T_cam_imu: [[0, -1, 0, 0.1], [1, 0, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]]
  timeshift_cam_imu: 0.001
"""
OPENCV = """%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [500, 0, 320, 0, 500, 240, 0, 0, 1]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [0.1, -0.2, 0.001, 0.002, 0]
"""
CAMODOCAL = """%YAML:1.0
---
model_type: MEI
camera_name: camera
image_width: 1400
image_height: 1400
mirror_parameters: {xi: 2.2}
distortion_parameters: {k1: 0.01, k2: 4.9, p1: 0.001, p2: 0.0003}
projection_parameters: {gamma1: 1336.3, gamma2: 1335.8, u0: 716.9, v0: 705.7}
"""
BASALT = """{"value0": {"T_imu_cam": [{"px": 0.1, "py": 0, "pz": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}],
"intrinsics": [{"camera_type": "kb4", "intrinsics": {"fx": 190, "fy": 190, "cx": 254, "cy": 256, "k1": 0.003,
"k2": 0.0007, "k3": -0.002, "k4": 0.0002}}], "resolution": [[512, 512]], "cam_time_offset_ns": 0}}"""
IMU = "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n"
TABLES = [
    "#timestamp [ns],rear_left_angle [rad],rear_right_angle [rad],steering_angle [rad]\n"
    + "".join(f"{20000000 * i},{0.1 * i},{0.1 * i},0.01\n" for i in range(8)),
    "#timestamp [ns],x,y,z,qw,qx,qy,qz\n" + "".join(f"{20000000 * i},{0.1 * i},0,0,1,0,0,0\n" for i in range(5)),
    IMU + "".join(f"{20000000 * i},0,0,0.1,0,0,9.8\n" for i in range(5)),
    "#timestamp [ns],friction [-],sigma [-],surface,temperature [degC]\n0,0.8,0.1,1,20\n20000000,0.7,0.1,5,20\n",
    "#timestamp [ns],beam,range [m]\n0,0,1.5\n0,1,2.5\n20000000,0,1.4\n",
    "#timestamp [ns],x [m],y [m],sigma [m],probability [-],eye_x [m],eye_y [m],xx [m^2],xy [m^2],yy [m^2]\n0,1,2,0.3,0.9,1,0,0.1,0,0.1\n",
    "#timestamp [ns],reach_0 [m],reach_1 [m]\n0,5,10\n20000000,4,8\n",
]
POSE = "1 0 0 0 0 1 0 0 0 0 1 0\n"
KITTI = "P0: 10 0 8 0 0 10 6 0 0 0 1 0\nP1: 10 0 8 -3 0 10 6 0 0 0 1 0\n====\n0.0\n0.1\n0.2\n====\n" + 3 * POSE
KITTI360 = (CAMODOCAL.replace("1400", "16") + "====\nimage_02: " + POSE
            + "====\n2013-05-28 08:46:02.904939008\n2013-05-28 08:46:03.008973312\n2013-05-28 08:46:03.112968448\n"
            + "====\n0 " + POSE + "1 " + POSE + "2 " + POSE)
KAIST = ("Encoder resolution: 4096\nEncoder left wheel diameter: 0.623479\nEncoder right wheel diameter: 0.622806\n"
         "Encoder wheel base: 1.52439\n====\nR: 1 0 0 0 1 0 0 0 1\nT: 1 0 1\n====\n"
         "1544578498418802396,10,12\n1544578498428802396,20,24\n1544578498438802396,30,36\n====\n"
         "1544578498418802396," + ",".join(POSE.split()) + "\n")
EUROC = (CAMERA + "====\n#timestamp [ns],filename\n0,000000000.png\n100000000,000000001.png\n====\n" + TABLES[2]
         + "====\n" + TABLES[1])
GEOJSON = """{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"class": "parking_space",
"space": 1, "version": 1}, "geometry": {"type": "Polygon", "coordinates": [[[9.18, 48.78], [9.1801, 48.78],
[9.1801, 48.7801], [9.18, 48.78]]]}}]}"""
ITEMS = """{"type": "FeatureCollection", "features": [
{"type": "Feature", "properties": {"kind": "road_works", "observed_utc": "2023-11-14T20:00:00Z", "half_life_s": 7200,
"speed_mps": 3, "reach_m": 4, "note": "a trench"}, "geometry": {"type": "LineString", "coordinates": [[9.18, 48.78],
[9.1801, 48.7801]]}},
{"type": "Feature", "properties": {"kind": "weather", "observed_utc": "2023-11-14T21:00:00+01:00", "grip_factor": 0.6},
"geometry": {"type": "MultiPolygon", "coordinates": [[[[9.18, 48.78], [9.1801, 48.78], [9.1801, 48.7801], [9.18, 48.78]]]]}},
{"type": "Feature", "properties": {"kind": "vehicle", "observed_utc": "2023-11-14T22:00:00.5Z"},
"geometry": {"type": "Point", "coordinates": [9.18, 48.78, 0]}}]}"""
COCO = """{"images": [{"id": 1, "width": 100, "height": 100, "file_name": "overhead.png"}],
"categories": [{"id": 1, "name": "parking_space"}],
"annotations": [{"id": 1, "image_id": 1, "category_id": 1, "bbox": [1, 2, 30, 40], "segmentation": [[1, 2, 31, 2, 31, 42]]}]}"""
YOLO = "names: [parking_space]\n====\n0 0.5 0.5 0.1 0.2\n0 0.1 0.1 0.2 0.1 0.2 0.2\n====\n0.05\n0\n0\n-0.05\n1\n2\n"
LOG = """name: log
vehicle: {wheelbase: 2.7}
poses: {file: log.csv, time: t, x: x, y: y, heading: heading}
wheels: {file: log.csv, time: t, speed: v, steering: s}
====
t,x,y,heading,v,s
""" + "".join(f"{0.1 * i},{0.1 * i},0,0,1,0\n" for i in range(6))
REQUEST = ("GET /api/labels?since=3 HTTP/1.1\r\nHost: 127.0.0.1:8080\r\nCookie: roadbook_8080=0123456789abcdef0123456789abcdef\r\n"
           "Range: bytes=0-1\r\nContent-Length: 2\r\n\r\n{}")
BODY = ("/api/labels\n====\ntoken=0123456789abcdef0123456789abcdef\n====\n127.0.0.1:8080\n====\n"
        '{"x": 1.5, "id": 3, "on": true, "who": "ann", "corner": [1, 2]}')


def png(bits=8, colour=0, interlaced=0):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    samples = {0: 1, 2: 3, 6: 4}[colour]
    row = b"\1" + bytes(range(16 * samples * bits // 8))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 16, 12, bits, colour, 0, 0, interlaced))
            + chunk(b"IDAT", zlib.compress(12 * row)) + chunk(b"IEND", b""))


# 16x8 pixels of grey.
JPEG = base64.b64decode(
    "/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDABALDA4MChAODQ4SERATGCgaGBYWGDEjJR0oOjM9PDkzODdASFxOQERXRTc4UG1RV19iZ2hnPk1xeX"
    "BkeFxlZ2P/wAALCAAIABABAREA/8QAHwAAAQUBAQEBAQEAAAAAAAAAAAECAwQFBgcICQoL/8QAtRAAAgEDAwIEAwUFBAQAAAF9AQIDAAQRBRIh"
    "MUEGE1FhByJxFDKBkaEII0KxwRVS0fAkM2JyggkKFhcYGRolJicoKSo0NTY3ODk6Q0RFRkdISUpTVFVWV1hZWmNkZWZnaGlqc3R1dnd4eXqDhI"
    "WGh4iJipKTlJWWl5iZmqKjpKWmp6ipqrKztLW2t7i5usLDxMXGx8jJytLT1NXW19jZ2uHi4+Tl5ufo6erx8vP09fb3+Pn6/9oACAEBAAA/AMCL"
    "R/8AZq5Fo/8As1//2Q==")


def npy(values):
    header = "{'descr': '<f8', 'fortran_order': False, 'shape': (%d, 3), }" % (len(values) // 3)
    header += " " * (63 - (10 + len(header)) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + struct.pack(f"<{len(values)}d", *values)


def chosen(texts):
    """Inputs whose first byte chooses what reads the rest."""
    return [bytes([i]) + text.encode() for i, text in enumerate(texts)]


def inputs(name, place):
    if name == "map_file":
        return [place.read_bytes()] if place and place.stat().st_size < longest(name) else [b"SQLite format 3\0" + 84 * b"\0"]
    return {
        "yaml": [t.encode() for t in (CAMERA, WHEELS, CHAIN, OPENCV, "a: {b: [1, 2.5], c: true}\nd: [[1], [2]]\ne: [{f: 1}]\n")],
        "sensor_yaml": chosen([CAMERA, WHEELS, "sensor_type: range\nbeam_azimuths: [0, 0.1]\nmax_range: 10\nsigma: 0.02\n",
                               "length: 4.7\nwidth: 1.8\nheight: 1.5\nrear_overhang: 1\nwheelbase: 2.7\n"]),
        "tables": chosen(TABLES) + [bytes([133]) + TABLES[0].replace("_angle [rad],rear", "_ticks,rear")
                                    .replace("right_angle [rad]", "right_ticks").encode()],
        "image": [png(), png(16), png(8, 2), png(8, 6), png(8, 0, 1), JPEG],
        "calibration": chosen([CHAIN, OPENCV, CAMODOCAL, BASALT, CHAIN]),
        "npy": [npy([0.5 * i for i in range(12)]), npy([])],
        "import": chosen([KITTI, KITTI360, KAIST, EUROC]),
        "items": chosen([ITEMS, ITEMS.replace("9.18", "9.1").replace("48.78", "4.7")]),
        "labels": chosen([COCO, GEOJSON, YOLO]),
        "plain_log": [LOG.encode(), (LOG.split("====")[0] + "====\nMATLAB 5.0 MAT-file" + 200 * "\0").encode()],
        "edits": [b"edits:\n  - loop: {a: m@1, b: x@2, motion: [1, 2, 3]}\n"
                  b"  - same_points: {a: m@1, camera: cam0, pixels: [[1, 2], [3, 4]], b: x@2, "
                  b"pixels_b: [[1, 2], [3, 4]]}\n"],
        "scenario": [b"seed: 1\nsizes: {small: {}}\n"],
        "property_table": chosen(["wheels0.left_radius: 0.01\ncam.focal: 0.02\n", TABLES[3]]),
        "http": chosen([REQUEST, BODY]),
    }[name]


def write(name, folder, place):
    folder.mkdir(parents=True, exist_ok=True)
    for i, data in enumerate(inputs(name, place)):
        (folder / f"{i:02}").write_bytes(data)


def longest(name):
    return {"map_file": 1_000_000, "image": 20_000, "scenario": 20_000}.get(name, 6_000)


def dictionary(name):
    words = ["nan", "inf", "1e308", "-1", "9223372036854775807", "\\x00", "\\xEF\\xBB\\xBF", ": ", "[", "{", "&a", "*a", "---\\x0A",
             "...\\x0A", "====\\x0A", "#timestamp [ns]", ",", "\\x0D\\x0A\\x0D\\x0A", "Content-Length: ", "T_BS", "null", "\\\"coordinates\\\":"]
    if name == "image":
        words = ["IHDR", "IDAT", "IEND", "PLTE", "\\xFF\\xD8\\xFF", "\\xFF\\xC0", "\\xFF\\xDA", "\\xFF\\xD9"]
    if name == "npy":
        words = ["'descr':", "'fortran_order':", "'shape':", "'<f8'", "'<f4'", "'<i8'", "(4294967296, 4294967296)"]
    return "".join(f'"{word}"\n' for word in words)
