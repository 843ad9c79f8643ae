// What the C++ reader finds in a map file, line by line, for the test of the reader in Python.
//
//   print_map FILE             prints the map, its layers, tables and rasters
//   print_map --make FILE      writes a small map with layers, a table and a raster
//   print_map --make-one FILE  the same in schema version 1
//   print_map --make-old FILE  the same as programs wrote it that had zero for unknown
//
// A line is a name and its values: integers; floating-point numbers as %a; texts and bytes as
// hexadecimal digits behind x; - for what is not known.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "mapping/known_covariance.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/layers/map_layers_gdal.hpp"
#include "mapping/store/file_digest.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "mapping/store/map_file_digest.hpp"
#include "mapping/store/map_file_names.hpp"
#include "mapping/store/map_file_open.hpp"
#include "mapping/store/map_file_seal.hpp"
#include "mapping/store/map_file_sqlite.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

/// One line of the output.
class Line {
 public:
  explicit Line(std::string_view name) : text_(name) {}
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;
  ~Line() { std::puts(text_.c_str()); }

  Line& integer(std::int64_t value) { return word(std::to_string(value)); }
  Line& real(double value) {
    if (std::isnan(value)) return word("-");
    std::array<char, 64> digits{};
    std::snprintf(digits.data(), digits.size(), "%a", value);
    return word(digits.data());
  }
  Line& bytes(const void* data, std::size_t size) {
    static constexpr std::string_view kDigits = "0123456789abcdef";
    std::string digits = "x";
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint8_t byte = static_cast<const std::uint8_t*>(data)[i];
      digits += kDigits[byte >> 4U];
      digits += kDigits[byte & 15U];
    }
    return word(digits);
  }
  Line& text(std::string_view value) { return bytes(value.data(), value.size()); }
  Line& word(const std::string& value) {
    text_ += ' ' + value;
    return *this;
  }
  template <typename Derived>
  Line& matrix(const Eigen::MatrixBase<Derived>& m) {
    for (Eigen::Index r = 0; r < m.rows(); ++r)
      for (Eigen::Index c = 0; c < m.cols(); ++c) real(static_cast<double>(m(r, c)));
    return *this;
  }
  template <typename Derived>
  Line& covariance(const Eigen::MatrixBase<Derived>& m) {
    return is_known(m) ? matrix(m) : word("-");
  }
  Line& field(const FieldValue& value) {
    if (const auto* number = std::get_if<std::int64_t>(&value)) return integer(*number);
    if (const auto* number = std::get_if<double>(&value)) return real(*number);
    if (const auto* words = std::get_if<std::string>(&value)) return text(*words);
    if (const auto* data = std::get_if<Bytes>(&value)) return bytes(data->data(), data->size());
    return word("-");
  }

 private:
  std::string text_;
};

void print_wheels(const Session& session) {
  Line line("wheels");
  if (session.wheels)
    for (const double value : wheel_values(*session.wheels)) line.real(value);
  else
    line.word("-");
}

void print_sessions(const Map& map) {
  for (const Session& s : map.sessions) {
    Line("session")
        .text(s.name)
        .text(s.drive_digest)
        .text(s.drive_path)
        .integer(s.t_begin_ns)
        .integer(s.t_end_ns)
        .real(s.wheel_scale)
        .real(s.wheel_scale_sigma)
        .text(scale_source_name(s.scale_source))
        .real(s.scale_sigma)
        .real(s.localised_share);
    for (const MountedCamera& m : s.rig.cameras) {
      Line line("camera");
      line.text(m.name).text(camera_model_key(m.camera.model));
      line.integer(m.camera.width).integer(m.camera.height);
      line.real(m.camera.max_angle_rad).real(m.time_offset_s);
      for (const double parameter : m.camera.parameters) line.real(parameter);
      line.matrix(m.T_vehicle_camera.matrix());
      line.real(m.exposed_after_s).real(m.rolling_shutter_s);
    }
    print_wheels(s);
    Line vehicle("vehicle");
    vehicle.text(vehicle_source_name(s.vehicle_source));
    for (const auto& value : vehicle_values(s.vehicle)) vehicle.real(value.value_or(std::nan("")));
  }
}

void print_poses(const Map& map) {
  for (const MapFrame& frame : map.map_frames) Line("map_frame").matrix(frame.T_map_frame.matrix());
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& k = map.keyframes[i];
    Line("pose")
        .integer(k.session)
        .integer(k.t_ns)
        .integer(k.drive_frame)
        .integer(k.map_frame)
        .real(k.travelled_m)
        .integer(k.reversing ? 1 : 0)
        .integer(k.after_gap ? 1 : 0)
        .integer(k.piece);
    Line("T_frame_vehicle").matrix(k.T_frame_vehicle.matrix());
    Line("T_map_vehicle").matrix(map.T_map_vehicle(static_cast<int>(i)).matrix());
    Line("pose_covariance").covariance(k.covariance);
    Line wheels("wheel_motion");
    if (k.wheels)
      wheels.matrix(k.wheels->motion)
          .covariance(k.wheels->covariance)
          .real(k.wheels->distance_m)
          .integer(k.wheels->reversing ? 1 : 0);
    else
      wheels.word("-");
  }
}

void print_landmarks(const Map& map) {
  for (const Landmark& l : map.landmarks) {
    Line("landmark")
        .integer(l.map_frame)
        .matrix(l.p_frame)
        .integer(l.ground ? 1 : 0)
        .bytes(l.descriptor.data(), l.descriptor.size());
    Line("p_map").matrix(map.p_map(l));
    Line("landmark_covariance").covariance(l.covariance);
  }
  for (const Observation& o : map.observations)
    Line("observation")
        .integer(o.landmark)
        .integer(o.keyframe)
        .integer(o.camera)
        .matrix(o.pixel)
        .real(static_cast<double>(o.sigma_px));
  for (const LoneCorner& c : map.corners)
    Line("corner")
        .integer(c.keyframe)
        .integer(c.camera)
        .matrix(c.pixel)
        .bytes(c.descriptor.data(), c.descriptor.size());
  for (const LandmarkSession& s : map.landmark_sessions) {
    Line line("landmark_session");
    line.integer(s.landmark).integer(s.session).integer(s.expected).integer(s.seen);
    line.word(s.last_ns ? std::to_string(*s.last_ns) : "-");
  }
  for (const LoopEdge& l : map.loops)
    Line("loop")
        .integer(l.from)
        .integer(l.to)
        .matrix(l.T_from_to.matrix())
        .matrix(l.information)
        .integer(l.inliers)
        .integer(l.accepted ? 1 : 0)
        .real(l.weight)
        .text(l.reason);
}

void print_layers(const std::filesystem::path& file) {
  static constexpr std::array kAxes{"xyz", "xyzm", "xyz", "xyz"};
  static constexpr std::array kTypes{"Point", "Point", "LineString", "Polygon"};
  const MapLayers layers(file);
  std::set<std::string> shown;
  for (const LayerInfo& info : layers.list()) {
    shown.insert(info.name);
    if (info.raster) {
      const RasterInfo raster = layers.raster_info(info.name);
      Line("raster")
          .text(info.name)
          .text(info.description)
          .real(raster.corner.x())
          .real(raster.corner.y());
      continue;
    }
    const VectorLayer layer = layers.read_layer(info.name);
    const auto type = static_cast<std::size_t>(layer.type);
    for (const Feature& feature : layer.features) {
      Line line("feature");
      line.text(info.name).text(kTypes[type]).text(kAxes[type]);
      for (const Eigen::Vector4d& p : feature.points)
        line.matrix(p.head(layer.type == GeometryType::kPointZM ? 4 : 3));
      for (std::size_t i = 0; i < layer.fields.size(); ++i)
        line.text(layer.fields[i].name).field(feature.values[i]);
    }
  }
  for (const std::string& name : layers.all_names()) {
    if (shown.contains(name)) continue;
    const PlainTable table = layers.read_table(name);
    for (const auto& row : table.rows) {
      Line line("table");
      line.text(name);
      for (std::size_t i = 0; i < table.fields.size(); ++i)
        line.text(table.fields[i].name).field(row[i]);
    }
  }
}

void print_map(const std::filesystem::path& file) {
  const Map map = load_map_with_corners(file);
  const MapMeta meta = load_meta(file);
#if defined(__x86_64__) && !defined(__AVX__) && !defined(__FMA__)
  Line("sums").text("plain");  // without fused operations, in the order of SSE2
#else
  Line("sums").text("other");
#endif
  Line("meta").integer(meta.schema_version).text(meta.state).text(meta.digest);
  for (const auto& [key, value] : meta.values) Line("meta_value").text(key).text(value);
  print_sessions(map);
  print_poses(map);
  print_landmarks(map);
  print_layers(file);
}

Map map_with_unknowns() {
  Map map = test::small_map(1);
  map.sessions[0].name =
      "Stra\xc3\x9f"
      "e \"3\" 'a;b'";
  map.sessions[1].scale_sigma = std::nan("");
  map.keyframes[0].covariance.setZero();
  map.keyframes[2].covariance = unknown_covariance<Matrix6d>();
  for (std::size_t i = 0; i < map.keyframes.size(); i += 5) map.keyframes[i].t_ns -= 1;
  for (std::size_t i = map.keyframes.size() / 2; i < map.keyframes.size(); ++i)
    map.keyframes[i].piece = 1;
  map.landmarks[4].covariance = unknown_covariance<Eigen::Matrix3d>();
  map.loops[0].to = 3;
  return map;
}

void write_geotiff(const std::filesystem::path& path) {
  const GdalScope scope;
  std::string pixels(300UL * 520UL, '\0');
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<char>(i * 7 % 251);
  const GdalDataset file(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), 520, 300, 1, GDT_Byte, nullptr));
  std::array<double, 6> transform{-3.0, 0.05, 0.0, 7.0, 0.0, -0.05};
  file->SetGeoTransform(transform.data());
  file->SetProjection(map_crs_wkt().c_str());
  if (file->RasterIO(GF_Write, 0, 0, 520, 300, pixels.data(), 520, 300, GDT_Byte, 1, nullptr, 0, 0,
                     0, nullptr) != CE_None)
    throw std::runtime_error("a GeoTIFF: got an error, want a file");
}

VectorLayer some_layer(const std::string& name, GeometryType type) {
  VectorLayer layer;
  layer.name = name;
  layer.description = "of the test";
  layer.type = type;
  layer.fields = {
      {"number", FieldType::kInteger}, {"width_m", FieldType::kReal}, {"note", FieldType::kText}};
  for (int i = 0; i < 3; ++i) {
    Feature f;
    for (int k = 0; k < 4; ++k) f.points.emplace_back(i + 0.1 * k, (k % 3) / 3.0, -1.0 / 7.0, 0.0);
    if (type == GeometryType::kPolygonZ) f.points.push_back(f.points.front());
    f.values = {std::int64_t{1} << (25 * i), 1.0 / (i + 3), "Nr. \"" + std::to_string(i) + "\""};
    layer.features.push_back(f);
  }
  layer.features[1].values = {std::monostate{}, std::monostate{}, std::monostate{}};
  return layer;
}

void make_map(const std::filesystem::path& file) {
  MapFileBuilder(file, "key").finish(map_with_unknowns(), {{"seed", "7"}, {"place.host", "here"}});
  const std::filesystem::path geotiff = file.string() + ".tif";
  write_geotiff(geotiff);
  MapUpdate update(file);
  update.write_layer(some_layer("parking_spaces", GeometryType::kPolygonZ));
  update.write_layer(some_layer("lanes", GeometryType::kLineStringZ));
  update.write_raster("overhead", geotiff, {.description = "grey"});
  update.write_table(
      {.name = "detector",
       .fields = {{"name", FieldType::kText}, {"weights", FieldType::kBytes}},
       .rows = {{std::string("svm"), Bytes{0, 1, 2}}, {std::string("none"), std::monostate{}}}});
  update.note("layers", "of the test");
  update.commit();
  std::filesystem::remove(geotiff);
}

/// Takes away what schema version 1 lacks. `zeros`: as programs wrote it that had no NULL.
void make_earlier(const std::filesystem::path& file, bool zeros) {
  {
    const SqlDatabase database(file, SqlMode::kReadWrite);
    for (const char* table : {"keyframe_motions", "keyframe_corners", "landmark_sessions"})
      database.run(std::string("DROP TABLE ") + table);
    database.run("ALTER TABLE sessions DROP COLUMN localised_share");
    database.run("UPDATE map_meta SET value = '1' WHERE key = 'schema_version'");
    if (zeros) {
      database.run("DROP TABLE vehicles");
      database.run("UPDATE sessions SET scale_sigma = 0.0, wheel_scale_sigma = 0.0");
      database.run("UPDATE landmarks SET covariance = zeroblob(72) WHERE covariance IS NULL");
      database.run("ALTER TABLE keyframes RENAME TO newer");
      database.run(
          "CREATE TABLE keyframes(id INTEGER PRIMARY KEY, session INTEGER NOT NULL, "
          "t_ns INTEGER NOT NULL, drive_frame INTEGER NOT NULL, map_frame INTEGER NOT NULL, "
          "T_frame_vehicle BLOB NOT NULL, covariance BLOB NOT NULL, travelled_m REAL NOT NULL, "
          "reversing INTEGER NOT NULL, after_gap INTEGER NOT NULL) STRICT");
      database.run(
          "INSERT INTO keyframes SELECT id, session, t_ns, drive_frame, map_frame, "
          "T_frame_vehicle, ifnull(covariance, zeroblob(288)), travelled_m, reversing, after_gap "
          "FROM newer");
      database.run("DROP TABLE newer");
    }
    store_digests(database, compute_digests(database));
    reserve_file_digest(database);
  }
  write_file_digest(file);
}

int run(const std::string& mode, const std::filesystem::path& file) {
  if (mode.empty()) {
    print_map(file);
  } else if (mode == "--make" || mode == "--make-one" || mode == "--make-old") {
    make_map(file);
    if (mode != "--make") make_earlier(file, mode == "--make-old");
  } else {
    std::fputs("print_map [--make|--make-one|--make-old] FILE\n", stderr);
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace roadbook

int main(int argc, char** argv) {
  try {
    return roadbook::run(argc > 2 ? argv[1] : "", argc > 1 ? argv[argc - 1] : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
