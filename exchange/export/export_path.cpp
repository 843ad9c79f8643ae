#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/whole_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "exchange/export/path_conditions.hpp"
#include "exchange/layers/stored_paths.hpp"
#include "roadnet/routing/route_path.hpp"

// Lanes as tables over their arc length: what a path-following controller reads.

namespace roadbook {
namespace {

using nlohmann::ordered_json;

constexpr const char* kSchema = "roadbook-path/1";

// A row of the table; a lane or a route is a run of them.
using Rows = std::vector<RoutePoint>;

Rows lane_rows(const LanePath& path, double step_m) {
  const PathCurve curve(path.path);
  const int steps = std::max(1, static_cast<int>(std::ceil(curve.length_m() / step_m)));
  Rows rows;
  for (int i = 0; i <= steps; ++i) {
    const double s = curve.length_m() * i / steps;
    rows.push_back({s, curve.at(s), path.width_m, path.lane, false});
  }
  return rows;
}

// The route between two places. Refused, with the reason, if no single curve connects them.
Rows route_rows(const StoredPaths& stored,
                const std::filesystem::path& map,
                const ExportOptions& options,
                double step_m) {
  constexpr double kReach_m = 10.0;
  const auto place = [&](const char* name, const Eigen::Vector3d& p) {
    const auto found = nearest_place(stored.network, p, kReach_m);
    if (!found)
      throw InvalidOption(name, fixed_text(p.x(), 2) + "," + fixed_text(p.y(), 2),
                          "a place within 10 m of a lane and, with Z, 1.5 m of its height");
    return *found;
  };
  if ((options.route->first - options.route->second).head<2>().norm() < 0.01)
    throw InvalidOption("--to", "the place of --from", "another place");
  RoutingOptions routing;
  routing.allow_reverse = false;  // a curve to follow has no cusp
  const Route route =
      Router(stored.network, routing)
          .route(place("--from", options.route->first), place("--to", options.route->second));
  RoutePath path = route_path(stored.network, lay_out(stored.network, stored.paths), route, step_m);
  if (path.points.empty())
    throw Refused("error: " + map.string() + ": route: got none, as " + path.reason +
                  ", want one driven forwards");
  return path.points;
}

const Lane* lane_of(const StoredPaths& stored, std::uint64_t id) {
  for (const Lane& lane : stored.network.lanes)
    if (lane.id == id) return &lane;
  return nullptr;
}

std::string sigma_or_none(double sigma_m) {
  return std::isnan(sigma_m) ? "none" : fixed_text(sigma_m, 4);
}

std::string csv_text(const StoredPaths& stored,
                     const std::vector<Rows>& tables,
                     const PathConditions& conditions) {
  std::string text = std::string("# ") + kSchema + "; map " + stored.digest + "; date " +
                     stored.source.date_utc + "; sessions " + stored.source.sessions +
                     "; sigma_m " + sigma_or_none(stored.source.sigma_m) + "; coverage " +
                     fixed_text(stored.network.coverage, 4) + "; speed_date " +
                     conditions.speed_date().value_or("none") + "; speed_coverage " +
                     fixed_text(conditions.speed_coverage(), 4) + "; friction_date " +
                     conditions.friction_date().value_or("none") + "; friction_coverage " +
                     fixed_text(conditions.friction_coverage(), 4) +
                     "\n# psi counter-clockwise from the map's x axis, kappa positive to the left\n"
                     "lane,s_m,x_m,y_m,z_m,psi_rad,kappa_radpm,width_m,"
                     "speed_limit_mps,speed_mps,friction,friction_sigma";
  const std::vector<std::string> further = conditions.further();
  for (const std::string& name : further) text += "," + name + "," + name + "_sigma";
  text += "\n";
  const auto add = [&](double value) {
    text += std::isfinite(value) ? "," + fixed_text(value, 6) : ",";
  };
  for (std::size_t k = 0; k < tables.size(); ++k) {
    for (std::size_t i = 0; i < tables[k].size(); ++i) {
      const RoutePoint& row = tables[k][i];
      text += std::to_string(row.lane);
      for (const double value : {row.s_m, row.at.position.x(), row.at.position.y(), row.at.height_m,
                                 row.at.heading(), row.at.curvature, row.width_m})
        text += "," + fixed_text(value, 6);
      const PathCondition& at = conditions.tables()[k][i];
      for (const double value : {at.speed_limit, at.speed, at.friction, at.friction_sigma})
        add(value);
      for (std::size_t n = 0; n < further.size(); ++n) {
        add(at.further.empty() ? NAN : at.further[n].mean);
        add(at.further.empty() ? NAN : std::sqrt(at.further[n].variance));
      }
      text += "\n";
    }
  }
  return text;
}

void add_columns(const Rows& rows,
                 const std::vector<PathCondition>& conditions,
                 const std::vector<std::string>& further,
                 ordered_json& json) {
  const auto column = [&](const char* name, const auto& value) {
    ordered_json values = ordered_json::array();
    for (const RoutePoint& row : rows) values.push_back(value(row));
    json[name] = values;
  };
  column("s_m", [](const RoutePoint& r) { return r.s_m; });
  column("x_m", [](const RoutePoint& r) { return r.at.position.x(); });
  column("y_m", [](const RoutePoint& r) { return r.at.position.y(); });
  column("z_m", [](const RoutePoint& r) { return r.at.height_m; });
  column("psi_rad", [](const RoutePoint& r) { return r.at.heading(); });
  column("kappa_radpm", [](const RoutePoint& r) { return r.at.curvature; });
  const auto known = [&](const char* name, double PathCondition::*field) {
    ordered_json values = ordered_json::array();
    for (const PathCondition& at : conditions)
      values.push_back(std::isfinite(at.*field) ? ordered_json(at.*field) : ordered_json());
    json[name] = values;
  };
  known("speed_limit_mps", &PathCondition::speed_limit);
  known("speed_mps", &PathCondition::speed);
  known("friction", &PathCondition::friction);
  known("friction_sigma", &PathCondition::friction_sigma);
  for (std::size_t n = 0; n < further.size(); ++n) {
    ordered_json mean = ordered_json::array();
    ordered_json sigma = ordered_json::array();
    for (const PathCondition& at : conditions) {
      mean.push_back(at.further.empty() ? ordered_json() : ordered_json(at.further[n].mean));
      sigma.push_back(at.further.empty() ? ordered_json()
                                         : ordered_json(std::sqrt(at.further[n].variance)));
    }
    json[further[n]] = mean;
    json[further[n] + "_sigma"] = sigma;
  }
}

ordered_json lane_json(const StoredPaths& stored,
                       const LanePath& path,
                       const Rows& rows,
                       const std::vector<PathCondition>& conditions,
                       const std::vector<std::string>& further) {
  const Lane* lane = lane_of(stored, path.lane);
  ordered_json json{{"lane", std::to_string(path.lane)},
                    {"closed", path.path.closed},
                    {"one_way", lane != nullptr && lane->one_way()},
                    {"length_m", path.length_m},
                    {"width_m", path.width_m},
                    {"deviation_m", path.deviation_m},
                    {"max_curvature_radpm", path.max_curvature},
                    {"tube_m", path.tube_m}};
  add_columns(rows, conditions, further, json);
  return json;
}

ordered_json route_json(const Rows& rows,
                        const std::vector<PathCondition>& conditions,
                        const std::vector<std::string>& further) {
  ordered_json json{{"length_m", rows.back().s_m}};
  add_columns(rows, conditions, further, json);
  json["width_m"] = ordered_json::array();
  json["lane"] = ordered_json::array();
  for (const RoutePoint& row : rows) {
    json["width_m"].push_back(row.width_m);
    json["lane"].push_back(std::to_string(row.lane));
  }
  return json;
}

ordered_json text_or_null(const std::optional<std::string>& text) {
  return text ? ordered_json(*text) : ordered_json();
}

std::string json_text(const StoredPaths& stored,
                      const std::vector<Rows>& tables,
                      const PathConditions& conditions,
                      bool route) {
  ordered_json json{
      {"schema", kSchema},
      {"map_digest", stored.digest},
      {"date_utc", stored.source.date_utc},
      {"sessions", stored.source.sessions},
      {"sigma_m", stored.source.sigma_m},
      {"coverage", stored.network.coverage},
      {"speed_date_utc", text_or_null(conditions.speed_date())},
      {"speed_coverage", conditions.speed_coverage()},
      {"friction_date_utc", text_or_null(conditions.friction_date())},
      {"friction_coverage", conditions.friction_coverage()},
      {"convention",
       "metres and radians, map frame; psi counter-clockwise from x; kappa positive to the "
       "left"}};
  if (route) {
    json["route"] = route_json(tables.front(), conditions.tables().front(), conditions.further());
  } else {
    json["lanes"] = ordered_json::array();
    for (std::size_t i = 0; i < tables.size(); ++i)
      json["lanes"].push_back(lane_json(stored, stored.paths[i], tables[i], conditions.tables()[i],
                                        conditions.further()));
  }
  return json.dump(1) + "\n";
}

}  // namespace

Paths export_path(const std::filesystem::path& map,
                  const std::filesystem::path& out,
                  const ExportOptions& options) {
  options.check();
  const StoredPaths stored = load_paths(map);
  std::vector<Rows> tables;
  Rows fine;
  if (options.route) {
    tables.push_back(route_rows(stored, map, options, options.step_m));
    fine = route_rows(stored, map, options, std::min(options.step_m, kSpeedStepM));
  } else {
    for (const LanePath& path : stored.paths) tables.push_back(lane_rows(path, options.step_m));
  }
  const PathConditions conditions(map, stored, tables, fine);
  write_whole_file(out, out.extension() == ".json"
                            ? json_text(stored, tables, conditions, options.route.has_value())
                            : csv_text(stored, tables, conditions));
  return {out};
}

}  // namespace roadbook
