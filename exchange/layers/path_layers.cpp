#include "exchange/layers/path_layers.hpp"

#include <charconv>
#include <cmath>
#include <cstring>
#include <map>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "roadnet/paths/path_curve.hpp"

namespace roadbook {
namespace {

constexpr double kDrawn_m = 0.5;  // between the points of the lines that GIS programs show

Bytes pack_points(const Eigen::Vector3d* points, int count) {
  Bytes bytes(static_cast<std::size_t>(count) * 3 * sizeof(double));
  std::memcpy(bytes.data(), points, bytes.size());
  return bytes;
}

VectorLayer line_layer(const std::vector<LanePath>& paths,
                       const RoadNetwork& network,
                       const NetworkSource& source) {
  VectorLayer layer;
  layer.name = "lane_paths";
  layer.description = "Lanes as curves with continuous curvature, one point every half metre";
  layer.type = GeometryType::kLineStringZ;
  layer.fields = {{"lane", FieldType::kText},          {"status", FieldType::kText},
                  {"length_m", FieldType::kReal},      {"width_m", FieldType::kReal},
                  {"max_curvature", FieldType::kReal}, {"max_curvature_s_m", FieldType::kReal},
                  {"deviation_m", FieldType::kReal},   {"deviation_s_m", FieldType::kReal},
                  {"tube_m", FieldType::kReal},        {"sigma_m", FieldType::kReal},
                  {"coverage", FieldType::kReal},      {"date_utc", FieldType::kText},
                  {"sessions", FieldType::kText}};
  for (const LanePath& path : paths) {
    if (path.status == LanePathStatus::kDegenerate) continue;
    const PathCurve curve(path.path);
    Feature feature;
    const int steps = std::max(1, static_cast<int>(std::ceil(curve.length_m() / kDrawn_m)));
    for (int i = 0; i <= steps; ++i) {
      const PathPoint at =
          curve.at(i == steps && !curve.closed() ? curve.length_m() : curve.length_m() * i / steps);
      feature.points.emplace_back(at.position.x(), at.position.y(), at.height_m, 0.0);
    }
    feature.values = {std::to_string(path.lane),
                      std::string(to_text(path.status)),
                      path.length_m,
                      path.width_m,
                      path.max_curvature,
                      path.max_curvature_s_m,
                      path.deviation_m,
                      path.deviation_s_m,
                      path.tube_m,
                      source.sigma_m,
                      network.coverage,
                      source.date_utc,
                      source.sessions};
    layer.features.push_back(std::move(feature));
  }
  return layer;
}

PlainTable segment_table(const std::vector<LanePath>& paths) {
  PlainTable table;
  table.name = "lane_path_segments";
  table.fields = {{"lane", FieldType::kText},      {"segment", FieldType::kInteger},
                  {"closed", FieldType::kInteger}, {"degree", FieldType::kInteger},
                  {"t_begin", FieldType::kReal},   {"t_end", FieldType::kReal},
                  {"points", FieldType::kBytes}};
  for (const LanePath& lane : paths) {
    const BezierPath& path = lane.path;
    if (lane.status == LanePathStatus::kDegenerate) continue;
    for (int i = 0; i < path.segments(); ++i)
      table.rows.push_back({std::to_string(lane.lane), std::int64_t{i},
                            std::int64_t{path.closed ? 1 : 0}, std::int64_t{path.degree},
                            path.knots[static_cast<std::size_t>(i)],
                            path.knots[static_cast<std::size_t>(i) + 1],
                            pack_points(path.segment(i), path.degree + 1)});
  }
  return table;
}

// A value by name, of the type wanted.
class Record {
 public:
  Record(const std::string& file,
         const std::string& table,
         const std::vector<Field>& fields,
         const std::vector<FieldValue>& values)
      : file_(file), table_(table), fields_(fields), values_(values) {}

  template <typename T>
  [[nodiscard]] const T& get(const std::string& name) const {
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (fields_[i].name == name && std::holds_alternative<T>(values_[i]))
        return std::get<T>(values_[i]);
    fail(name, "no value of its type");
  }
  [[noreturn]] void fail(const std::string& name, const std::string& got) const {
    throw BadInput(Problem{Severity::kError, file_, 0, table_ + "." + name, got, "lane paths"});
  }

 private:
  const std::string& file_;
  std::string table_;
  const std::vector<Field>& fields_;
  const std::vector<FieldValue>& values_;
};

void add_segment(const Record& row, BezierPath& path) {
  path.closed = row.get<std::int64_t>("closed") != 0;
  path.degree = static_cast<int>(row.get<std::int64_t>("degree"));
  const Bytes& bytes = row.get<Bytes>("points");
  const auto count = static_cast<std::size_t>(path.degree) + 1;
  if (path.degree < kMinPathDegree || path.degree > kMaxPathDegree ||
      bytes.size() != count * 3 * sizeof(double))
    row.fail("points", std::to_string(bytes.size()) + " bytes");
  if (row.get<std::int64_t>("segment") != std::max(0, path.segments()))
    row.fail("segment", std::to_string(row.get<std::int64_t>("segment")));
  if (path.knots.empty()) path.knots.push_back(row.get<double>("t_begin"));
  path.knots.push_back(row.get<double>("t_end"));
  std::vector<Eigen::Vector3d> points(count);
  std::memcpy(points.front().data(), bytes.data(), bytes.size());
  path.points.insert(path.points.end(), points.begin(), points.end());
}

LanePathStatus status_of(const Record& row) {
  const auto& text = row.get<std::string>("status");
  for (const LanePathStatus status : {LanePathStatus::kOk, LanePathStatus::kDeviates})
    if (text == to_text(status)) return status;
  row.fail("status", text);
}

std::uint64_t number_of(const Record& row, const std::string& name) {
  const auto& text = row.get<std::string>(name);
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) row.fail(name, text);
  return number;
}

}  // namespace

std::string paths_digest(const std::vector<LanePath>& paths) {
  Sha256 digest;
  for (const LanePath& lane : paths) {
    if (lane.status == LanePathStatus::kDegenerate) continue;
    digest.update(lane.lane).update(std::int64_t{lane.path.closed ? 1 : 0});
    digest.update(std::int64_t{lane.path.degree}).update(lane.tube_m);
    for (const double knot : lane.path.knots) digest.update(knot);
    for (const Eigen::Vector3d& p : lane.path.points) digest.update(p.x()).update(p.y());
  }
  return digest.hex();
}

void write_path_layers(MapUpdate& update,
                       const std::vector<LanePath>& paths,
                       const RoadNetwork& network,
                       const NetworkSource& source) {
  update.write_layer(line_layer(paths, network, source));
  update.write_table(segment_table(paths));
}

std::vector<LanePath> read_path_layers(const MapLayers& layers) {
  const std::string file = layers.file().string();
  const VectorLayer lines = layers.read_layer("lane_paths");
  const PlainTable segments = layers.read_table("lane_path_segments");
  std::vector<LanePath> paths;
  std::map<std::uint64_t, std::size_t> index;
  for (const Feature& feature : lines.features) {
    const Record row(file, lines.name, lines.fields, feature.values);
    LanePath path;
    path.lane = number_of(row, "lane");
    path.status = status_of(row);
    path.length_m = row.get<double>("length_m");
    path.width_m = row.get<double>("width_m");
    path.max_curvature = row.get<double>("max_curvature");
    path.max_curvature_s_m = row.get<double>("max_curvature_s_m");
    path.deviation_m = row.get<double>("deviation_m");
    path.deviation_s_m = row.get<double>("deviation_s_m");
    path.tube_m = row.get<double>("tube_m");
    index[path.lane] = paths.size();
    paths.push_back(std::move(path));
  }
  for (const auto& values : segments.rows) {
    const Record row(file, segments.name, segments.fields, values);
    const auto found = index.find(number_of(row, "lane"));
    if (found == index.end()) row.fail("lane", "a lane without path");
    add_segment(row, paths[found->second].path);
  }
  for (const LanePath& path : paths) path.path.check();
  return paths;
}

std::vector<Eigen::Vector3d> corners_with_open_side_first(std::vector<Eigen::Vector3d> corners,
                                                          const RoadNetwork& network) {
  ROADBOOK_ASSERT(corners.size() == 4);
  const double a = (corners[1] - corners[0]).norm() + (corners[3] - corners[2]).norm();
  const double b = (corners[2] - corners[1]).norm() + (corners[0] - corners[3]).norm();
  if (b < a) std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  constexpr double kFar_m = 1e4;
  const auto way = [&](const Eigen::Vector3d& p) {
    const auto place = nearest_place(network, p, kFar_m);
    return place ? place->distance_m : kFar_m;
  };
  if (way(0.5 * (corners[2] + corners[3])) < way(0.5 * (corners[0] + corners[1])))
    std::rotate(corners.begin(), corners.begin() + 2, corners.end());
  return corners;
}

std::vector<SpacePlace> read_spaces(const std::filesystem::path& map,
                                    const VectorLayer& polygons,
                                    const RoadNetwork& network) {
  const auto column = polygons.field("space");
  std::vector<SpacePlace> spaces;
  for (const Feature& feature : polygons.features) {
    if (polygons.type != GeometryType::kPolygonZ || feature.points.size() != 5)
      throw BadInput(Problem{Severity::kError, map.string(), 0, polygons.name,
                             std::to_string(feature.points.size()) + " points",
                             "rectangles: four corners, the first repeated"});
    std::uint64_t id = spaces.size();
    if (column && std::holds_alternative<std::int64_t>(feature.values[*column]))
      id = static_cast<std::uint64_t>(std::get<std::int64_t>(feature.values[*column]));
    std::vector<Eigen::Vector3d> corners;
    for (std::size_t i = 0; i < 4; ++i) corners.emplace_back(feature.points[i].head<3>());
    spaces.push_back(space_place(id, corners_with_open_side_first(std::move(corners), network)));
  }
  return spaces;
}

void write_link_table(MapUpdate& update, const std::vector<LaneLink>& links) {
  PlainTable table;
  table.name = "space_links";
  table.fields = {{"space", FieldType::kInteger}, {"lane", FieldType::kText},
                  {"s_m", FieldType::kReal},      {"distance_m", FieldType::kReal},
                  {"left", FieldType::kInteger},  {"linked", FieldType::kInteger},
                  {"reason", FieldType::kText}};
  for (const LaneLink& link : links) {
    const bool near = link.place.lane >= 0;
    table.rows.push_back({static_cast<std::int64_t>(link.space),
                          near ? FieldValue(std::to_string(link.lane)) : FieldValue{},
                          near ? FieldValue(link.place.s_m) : FieldValue{},
                          near ? FieldValue(link.place.distance_m) : FieldValue{},
                          std::int64_t{link.left ? 1 : 0},
                          std::int64_t{link.status == LinkStatus::kLinked ? 1 : 0}, link.reason});
  }
  update.write_table(table);
}

}  // namespace roadbook
