#include <cmath>
#include <nlohmann/json.hpp>

#include "exchange/export_formats.hpp"
#include "exchange/output_file.hpp"
#include "exchange/stored_paths.hpp"
#include "roadnet/path_curve.hpp"

// Lanes as tables over their arc length: what a path-following controller reads.

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "roadbook-path/1";

std::vector<double> places(const PathCurve& curve, double step_m) {
  const int steps = std::max(1, static_cast<int>(std::ceil(curve.length_m() / step_m)));
  std::vector<double> s;
  for (int i = 0; i <= steps; ++i) s.push_back(curve.length_m() * i / steps);
  return s;
}

const Lane* lane_of(const StoredPaths& stored, std::uint64_t id) {
  for (const Lane& lane : stored.network.lanes)
    if (lane.id == id) return &lane;
  return nullptr;
}

std::string csv_text(const StoredPaths& stored, double step_m) {
  std::string text = std::string("# ") + kSchema + "; map " + stored.digest + "; date " +
                     stored.source.date_utc + "; sessions " + stored.source.sessions +
                     "; sigma_m " + fixed_text(stored.source.sigma_m, 4) + "; coverage " +
                     fixed_text(stored.network.coverage, 4) +
                     "\n# psi counter-clockwise from the map's x axis, kappa positive to the left\n"
                     "lane,s_m,x_m,y_m,z_m,psi_rad,kappa_radpm,width_m\n";
  for (const LanePath& path : stored.paths) {
    const PathCurve curve(path.path);
    for (const double s : places(curve, step_m)) {
      const PathPoint p = curve.at(s);
      text += std::to_string(path.lane);
      for (const double value :
           {s, p.position.x(), p.position.y(), p.height_m, p.heading(), p.curvature, path.width_m})
        text += "," + fixed_text(value, 6);
      text += "\n";
    }
  }
  return text;
}

Json lane_json(const StoredPaths& stored, const LanePath& path, double step_m) {
  const PathCurve curve(path.path);
  const Lane* lane = lane_of(stored, path.lane);
  Json json{{"lane", std::to_string(path.lane)},
            {"closed", path.path.closed},
            {"one_way", lane != nullptr && lane->one_way()},
            {"length_m", path.length_m},
            {"width_m", path.width_m},
            {"deviation_m", path.deviation_m},
            {"max_curvature_radpm", path.max_curvature},
            {"tube_m", path.tube_m}};
  Json s_m = Json::array();
  Json x_m = Json::array();
  Json y_m = Json::array();
  Json z_m = Json::array();
  Json psi = Json::array();
  Json kappa = Json::array();
  for (const double s : places(curve, step_m)) {
    const PathPoint p = curve.at(s);
    s_m.push_back(s);
    x_m.push_back(p.position.x());
    y_m.push_back(p.position.y());
    z_m.push_back(p.height_m);
    psi.push_back(p.heading());
    kappa.push_back(p.curvature);
  }
  json["s_m"] = s_m;
  json["x_m"] = x_m;
  json["y_m"] = y_m;
  json["z_m"] = z_m;
  json["psi_rad"] = psi;
  json["kappa_radpm"] = kappa;
  return json;
}

std::string json_text(const StoredPaths& stored, double step_m) {
  Json json{{"schema", kSchema},
            {"map_digest", stored.digest},
            {"date_utc", stored.source.date_utc},
            {"sessions", stored.source.sessions},
            {"sigma_m", stored.source.sigma_m},
            {"coverage", stored.network.coverage},
            {"convention",
             "metres and radians, map frame; psi counter-clockwise from x; kappa positive to the "
             "left"}};
  json["lanes"] = Json::array();
  for (const LanePath& path : stored.paths)
    json["lanes"].push_back(lane_json(stored, path, step_m));
  return json.dump(1) + "\n";
}

}  // namespace

Paths export_path(const std::filesystem::path& map,
                  const std::filesystem::path& out,
                  const ExportOptions& options) {
  options.check();
  const StoredPaths stored = load_paths(map);
  write_text_file(out, out.extension() == ".json" ? json_text(stored, options.step_m)
                                                  : csv_text(stored, options.step_m));
  return {out};
}

}  // namespace roadbook
