#include "workflows/compare/compare_files.hpp"

#include <map>

#include "mapping/store/map_file.hpp"
#include "mapping/store/map_reading.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/session_worth.hpp"
#include "workflows/stored_network.hpp"

namespace roadbook {
namespace {

constexpr double kLabelStillM = 0.10;
constexpr double kSameLaneM = 0.5;

std::optional<Eigen::Vector3d> middle_in_map(const Map& map, const Label& label) {
  const auto pose = vehicle_of(map, label.anchor);
  if (!pose) return std::nullopt;
  return pose->T_map_vehicle * middle_of(label);
}

std::vector<Polyline> in_plan(const std::vector<std::vector<Eigen::Vector3d>>& lines,
                              const Eigen::Isometry3d& T) {
  std::vector<Polyline> plan;
  for (const auto& line : lines) {
    Polyline& flat = plan.emplace_back();
    for (const Eigen::Vector3d& p : line) flat.emplace_back((T * p).head<2>());
  }
  return plan;
}

std::vector<std::vector<Eigen::Vector3d>> centres(const MapLayers& layers) {
  std::vector<std::vector<Eigen::Vector3d>> lines;
  if (const auto network = stored_network(layers))
    for (const Lane& lane : network->lanes) lines.push_back(lane.centre);
  return lines;
}

// Each name with the digest of its content.
std::map<std::string, std::string> contents(const MapLayers& layers) {
  const auto digests = load_meta(layers.file()).table_digests;
  std::map<std::string, std::string> list;
  for (const std::string& name : layers.all_names()) {
    const auto found = digests.find(name);
    list.emplace(name, found == digests.end() ? std::string() : found->second);
  }
  return list;
}

LayerComparison compare_layers(const MapLayers& a, const MapLayers& b) {
  const auto in_a = contents(a);
  const auto in_b = contents(b);
  LayerComparison comparison;
  for (const auto& [name, digest] : in_a) {
    const auto found = in_b.find(name);
    if (found == in_b.end())
      comparison.only_a.push_back(name);
    else
      comparison.both.push_back({name, !digest.empty() && found->second == digest});
  }
  for (const auto& [name, digest] : in_b)
    if (!in_a.contains(name)) comparison.only_b.push_back(name);
  return comparison;
}

}  // namespace

LabelComparison compare_labels(const Map& map_a,
                               const std::vector<Label>& a,
                               const Map& map_b,
                               const std::vector<Label>& b,
                               const std::optional<Eigen::Isometry3d>& T_a_b) {
  std::map<std::int64_t, const Label*> by_id;
  for (const Label& label : b) by_id.emplace(label.id, &label);
  LabelComparison comparison;
  for (const Label& label : a) {
    const auto found = by_id.find(label.id);
    if (found == by_id.end()) {
      ++comparison.only_a;
      continue;
    }
    const Label& other = *found->second;
    ++comparison.both;
    if (other.kind != label.kind) ++comparison.kind_changed;
    const auto in_a = middle_in_map(map_a, label);
    const auto in_b = middle_in_map(map_b, other);
    if (!T_a_b || !in_a || !in_b) continue;
    ++comparison.compared;
    if ((*in_a - *T_a_b * *in_b).norm() > kLabelStillM) comparison.moved.push_back(label.id);
  }
  comparison.only_b = b.size() - comparison.both;
  return comparison;
}

LaneComparison compare_lanes(const std::vector<std::vector<Eigen::Vector3d>>& a,
                             const std::vector<std::vector<Eigen::Vector3d>>& b,
                             const std::optional<Eigen::Isometry3d>& T_a_b) {
  const auto plan_a = in_plan(a, Eigen::Isometry3d::Identity());
  const auto plan_b = in_plan(b, T_a_b.value_or(Eigen::Isometry3d::Identity()));
  LaneComparison comparison;
  comparison.length_a_m = total_length_m(plan_a);
  comparison.length_b_m = total_length_m(plan_b);
  if (T_a_b && comparison.length_a_m > 0.0)
    comparison.share_a = share_within(plan_a, plan_b, kSameLaneM);
  if (T_a_b && comparison.length_b_m > 0.0)
    comparison.share_b = share_within(plan_b, plan_a, kSameLaneM);
  return comparison;
}

FileComparison compare_files(const std::filesystem::path& a,
                             const std::filesystem::path& b,
                             bool with_value) {
  const MapReading reading_a(a);
  const MapReading reading_b(b);
  FileComparison comparison;
  comparison.a = load_map(a);
  comparison.b = load_map(b);
  const MapLayers layers_a(a);
  const MapLayers layers_b(b);
  comparison.maps = compare_maps(comparison.a, comparison.b);
  const auto& T_a_b = comparison.maps.T_a_b;
  const std::vector<Label> labels_a = read_labels(a);
  const std::vector<Label> labels_b = read_labels(b);
  comparison.labels = compare_labels(comparison.a, labels_a, comparison.b, labels_b, T_a_b);
  comparison.lanes = compare_lanes(centres(layers_a), centres(layers_b), T_a_b);
  comparison.layers = compare_layers(layers_a, layers_b);
  reading_a.require_same_map();
  reading_b.require_same_map();
  if (!with_value) return comparison;
  comparison.value_a = worth_of_sessions(comparison.a, labels_a);
  comparison.value_b = worth_of_sessions(comparison.b, labels_b);
  return comparison;
}

}  // namespace roadbook
