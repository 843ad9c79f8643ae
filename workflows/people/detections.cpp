#include "workflows/people/detections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.hpp"
#include "exchange/layers/table_row.hpp"

namespace roadbook {
namespace {

constexpr const char* kWantDetections = "what `roadbook speeds` keeps of the people seen";

SessionSightings& sightings_of(std::vector<SessionSightings>& all, const std::string& session) {
  for (SessionSightings& one : all)
    if (one.session == session) return one;
  all.push_back({session, {}, {}, {}});
  return all.back();
}

// Returns the position of the camera that saw the person, if the map's table has this position.
std::optional<std::array<double, 2>> eye_of(const TableRow& row) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const double x = row.number("eye_x_m", none);
  const double y = row.number("eye_y_m", none);
  if (!std::isfinite(x) || !std::isfinite(y)) return std::nullopt;
  return std::array{x, y};
}

FieldValue eye_value(const Detection& d, std::size_t axis) {
  return d.eye_m ? FieldValue((*d.eye_m)[axis]) : FieldValue();
}

Detection stored_detection(const TableRow& row) {
  return {row.get<std::int64_t>("t_ns"),
          row.get<double>("x_m"),
          row.get<double>("y_m"),
          row.get<double>("sigma_m"),
          row.get<double>("probability"),
          {row.number("xx_m2", 0.0), row.number("xy_m2", 0.0), row.number("yy_m2", 0.0)},
          eye_of(row)};
}

template <class Take>
void for_each_row(const MapLayers& layers, const std::string& name, const Take& take) {
  const PlainTable table = layers.read_table(name);
  for (const auto& values : table.rows)
    take(TableRow(layers.file().string(), table.name, table.fields, values, kWantDetections));
}

void sort_by_time(std::vector<SessionSightings>& all) {
  for (SessionSightings& one : all)
    std::stable_sort(one.detections.begin(), one.detections.end(),
                     [](const Detection& a, const Detection& b) { return a.t_ns < b.t_ns; });
}

}  // namespace

std::vector<SessionSightings> by_session(const Map& map,
                                         const std::vector<Detection>& detections,
                                         const std::vector<std::string>& observed,
                                         std::size_t& without_session) {
  std::vector<SessionSightings> all;
  for (const std::string& name : observed) {
    const auto known = std::any_of(map.sessions.begin(), map.sessions.end(),
                                   [&](const Session& session) { return session.name == name; });
    if (!known) throw InvalidOption("--observed", name, "the name of a session of the map");
    (void)sightings_of(all, name);
  }
  // Rows carry the stamps of the images as written.
  for (Detection row : detections) {
    const auto session =
        std::find_if(map.sessions.begin(), map.sessions.end(), [&](const Session& one) {
          const std::int64_t t_ns = row.t_ns + image_offset_ns(one.rig);
          return t_ns >= one.t_begin_ns && t_ns <= one.t_end_ns;
        });
    if (session == map.sessions.end()) {
      ++without_session;
      continue;
    }
    row.t_ns += image_offset_ns(session->rig);
    sightings_of(all, session->name).detections.push_back(row);
  }
  sort_by_time(all);
  return all;
}

std::vector<SessionSightings> stored_sightings(const MapLayers& layers, const Map& map) {
  if (!layers.has("sighting_sessions")) return {};
  std::vector<SessionSightings> all;
  for_each_row(layers, "sighting_sessions", [&](const TableRow& row) {
    (void)sightings_of(all, row.get<std::string>("session"));
  });
  for_each_row(layers, "detections", [&](const TableRow& row) {
    sightings_of(all, row.get<std::string>("session")).detections.push_back(stored_detection(row));
  });
  // The sight blockers are in coordinates of the map. A new build of the map drops them.
  if (layers.has("sight_blockers"))
    for_each_row(layers, "sight_blockers", [&](const TableRow& row) {
      sightings_of(all, row.get<std::string>("session"))
          .blockers.push_back({{row.get<double>("from_x"), row.get<double>("from_y")},
                               {row.get<double>("to_x"), row.get<double>("to_y")}});
    });
  if (layers.has("looks"))
    for_each_row(layers, "looks", [&](const TableRow& row) {
      sightings_of(all, row.get<std::string>("session"))
          .looks.push_back({row.get<std::int64_t>("t_ns"), row.get<Bytes>("reach_dm")});
    });
  std::erase_if(all, [&](const SessionSightings& one) {
    return std::none_of(map.sessions.begin(), map.sessions.end(),
                        [&](const Session& session) { return session.name == one.session; });
  });
  sort_by_time(all);
  return all;
}

void write_sightings(MapUpdate& update, const std::vector<SessionSightings>& sightings) {
  PlainTable sessions{"sighting_sessions", {{"session", FieldType::kText}}, {}};
  PlainTable rows{"detections",
                  {{"session", FieldType::kText},
                   {"t_ns", FieldType::kInteger},
                   {"x_m", FieldType::kReal},
                   {"y_m", FieldType::kReal},
                   {"sigma_m", FieldType::kReal},
                   {"probability", FieldType::kReal},
                   {"xx_m2", FieldType::kReal},
                   {"xy_m2", FieldType::kReal},
                   {"yy_m2", FieldType::kReal},
                   {"eye_x_m", FieldType::kReal},
                   {"eye_y_m", FieldType::kReal}},
                  {}};
  PlainTable looks{"looks",
                   {{"session", FieldType::kText},
                    {"t_ns", FieldType::kInteger},
                    {"reach_dm", FieldType::kBytes}},
                   {}};
  PlainTable blockers{"sight_blockers",
                      {{"session", FieldType::kText},
                       {"from_x", FieldType::kReal},
                       {"from_y", FieldType::kReal},
                       {"to_x", FieldType::kReal},
                       {"to_y", FieldType::kReal}},
                      {}};
  for (const SessionSightings& one : sightings) {
    sessions.rows.push_back({one.session});
    for (const Detection& d : one.detections)
      rows.rows.push_back({one.session, d.t_ns, d.x_m, d.y_m, d.sigma_m, d.probability,
                           d.covariance[0], d.covariance[1], d.covariance[2], eye_value(d, 0),
                           eye_value(d, 1)});
    for (const Look& look : one.looks)
      looks.rows.push_back({one.session, look.t_ns, look.reach_dm});
    for (const SightBlocker& b : one.blockers)
      blockers.rows.push_back({one.session, b.a.x(), b.a.y(), b.b.x(), b.b.y()});
  }
  update.write_table(sessions);
  update.write_table(rows);
  update.write_table(blockers);
  update.write_table(looks);
}

}  // namespace roadbook
