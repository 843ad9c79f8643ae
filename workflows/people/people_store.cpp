#include "workflows/people/people_store.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "exchange/layers/feature_column.hpp"
#include "mapping/session_track.hpp"
#include "semantics/labels/label_store.hpp"
#include "semantics/labels/labels.hpp"
#include "semantics/people/person_labels.hpp"

namespace roadbook {
namespace {

constexpr const char* kPersonTable = "person_examples";
constexpr const char* kAnswers = "person_answers";
constexpr const char* kInstantTable = "person_instants";
constexpr const char* kWantPeople = "what `roadbook detect` learnt";

std::vector<SearchAnswer> read_answers(const MapLayers& layers) {
  std::vector<SearchAnswer> answers;
  if (!layers.has(kAnswers)) return answers;
  const PlainTable table = layers.read_table(kAnswers);
  for (const auto& values : table.rows) {
    const TableRow row(layers.file().string(), table.name, table.fields, values, kWantPeople);
    const auto logit = row.get<double>("logit");
    if (!std::isfinite(logit)) row.fail("logit", "no finite number");
    answers.push_back({logit, row.get<std::int64_t>("person") != 0});
  }
  return answers;
}

std::set<std::string> read_instants(const MapLayers& layers) {
  std::set<std::string> instants;
  if (!layers.has(kInstantTable)) return instants;
  const PlainTable table = layers.read_table(kInstantTable);
  for (const auto& values : table.rows)
    instants.insert(TableRow(layers.file().string(), table.name, table.fields, values, kWantPeople)
                        .get<std::string>("instant"));
  return instants;
}

// Moves the feet vertically from the plane of the vehicle to the ground.
Eigen::Vector3d feet_in_vehicle(const Detection& d,
                                const Eigen::Isometry3d& T_map_vehicle,
                                const GroundModel& ground) {
  Eigen::Vector3d feet(d.x_m, d.y_m, 0.0);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d p = T_map_vehicle * feet;
    const auto z = ground.height(p.x(), p.y());
    if (!z) break;
    feet.z() += *z - p.z();
  }
  return feet;
}

Feature feature_of(const std::string& session,
                   const Detection& d,
                   const TrackPose& vehicle,
                   const GroundModel& ground) {
  const Eigen::Vector3d feet = feet_in_vehicle(d, vehicle.T_map_vehicle, ground);
  const Eigen::Vector3d p = vehicle.T_map_vehicle * feet;
  const Eigen::Matrix2d R = vehicle.T_map_vehicle.linear().topLeftCorner<2, 2>();
  const Eigen::Matrix2d C =
      R * covariance_of(d) * R.transpose() + covariance_of_point(vehicle, feet);
  const double sigma_m =
      is_known(C) ? std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(C).eigenvalues()[1])
                  : std::numeric_limits<double>::quiet_NaN();
  Feature feature;
  feature.points.emplace_back(p.x(), p.y(), p.z(), 0.0);
  feature.values = {session, d.t_ns,  utc_text(d.t_ns), d.probability,
                    sigma_m, C(0, 0), C(0, 1),          C(1, 1)};
  return feature;
}

}  // namespace

PersonExamples read_person_examples(const MapLayers& layers) {
  PersonExamples examples;
  if (!layers.has(kPersonTable)) return examples;
  const PlainTable table = layers.read_table(kPersonTable);
  for (const auto& values : table.rows) {
    const TableRow row(layers.file().string(), table.name, table.fields, values, kWantPeople);
    examples.features.push_back(feature_from_row(row, "feature", PersonWindow::feature_size()));
    examples.labels.push_back(row.get<std::int64_t>("person") != 0 ? std::int8_t{1}
                                                                   : std::int8_t{-1});
  }
  examples.answers = read_answers(layers);
  examples.instants = read_instants(layers);
  return examples;
}

void write_person_examples(MapUpdate& update, const PersonExamples& examples) {
  PlainTable table{
      kPersonTable, {{"person", FieldType::kInteger}, {"feature", FieldType::kBytes}}, {}};
  for (std::size_t i = 0; i < examples.size(); ++i)
    table.rows.push_back(
        {std::int64_t{examples.labels[i] > 0 ? 1 : 0}, feature_to_field(examples.features[i])});
  update.write_table(table);
  PlainTable answers{kAnswers, {{"logit", FieldType::kReal}, {"person", FieldType::kInteger}}, {}};
  for (const SearchAnswer& answer : examples.answers)
    answers.rows.push_back({answer.logit, std::int64_t{answer.positive ? 1 : 0}});
  update.write_table(answers);
  PlainTable instants{kInstantTable, {{"instant", FieldType::kText}}, {}};
  for (const std::string& instant : examples.instants) instants.rows.push_back({instant});
  update.write_table(instants);
}

void write_people_layer(MapUpdate& update,
                        const Map& map,
                        const GroundModel& ground,
                        const std::vector<SessionSightings>& sightings) {
  VectorLayer layer;
  layer.name = "people";
  layer.description = "People found in the images: feet on the ground";
  layer.type = GeometryType::kPointZ;
  layer.fields = {{"session", FieldType::kText},  {"t_ns", FieldType::kInteger},
                  {"date_utc", FieldType::kText}, {"probability", FieldType::kReal},
                  {"sigma_m", FieldType::kReal},  {"xx_m2", FieldType::kReal},
                  {"xy_m2", FieldType::kReal},    {"yy_m2", FieldType::kReal}};
  for (const SessionSightings& one : sightings)
    for (std::size_t s = 0; s < map.sessions.size(); ++s) {
      if (one.session != map.sessions[s].name) continue;
      for (const Detection& d : one.detections)
        if (const auto vehicle = track_pose(map, static_cast<int>(s), d.t_ns))
          layer.features.push_back(feature_of(one.session, d, *vehicle, ground));
    }
  update.write_layer(layer);
}

}  // namespace roadbook
