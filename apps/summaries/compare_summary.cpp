#include "apps/summaries/compare_summary.hpp"

#include <nlohmann/json.hpp>
#include <tuple>

#include "apps/summaries/value_summary.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

template <typename T>
nlohmann::ordered_json or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

nlohmann::ordered_json counts_json(const CommonCounts& counts) {
  return {{"both", counts.both}, {"only_a", counts.only_a}, {"only_b", counts.only_b}};
}

std::string counts_text(const CommonCounts& counts) {
  return std::to_string(counts.both) + " in both, " + std::to_string(counts.only_a) +
         " only in A, " + std::to_string(counts.only_b) + " only in B";
}

struct WorstPlace {
  std::string session;
  std::int64_t t_ns = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double distance_m = 0.0;
};

std::optional<WorstPlace> worst_place(const FileComparison& c) {
  if (!c.maps.worst) return std::nullopt;
  const ComparedPose& pose = c.maps.poses[*c.maps.worst];
  const Keyframe& keyframe = c.a.keyframes[static_cast<std::size_t>(pose.a)];
  return WorstPlace{c.a.sessions[static_cast<std::size_t>(keyframe.session)].name, keyframe.t_ns,
                    c.a.T_map_vehicle(pose.a).translation(), pose.distance_m};
}

nlohmann::ordered_json poses_json(const FileComparison& c) {
  nlohmann::ordered_json object = {{"compared", c.maps.poses.size()},
                                   {"of_other_pieces", c.maps.poses_of_other_pieces},
                                   {"median_m", or_null(c.maps.median_m)},
                                   {"p95_m", or_null(c.maps.p95_m)},
                                   {"worst", nullptr},
                                   {"T_a_b", nullptr}};
  if (const auto worst = worst_place(c))
    object["worst"] = {{"session", worst->session},
                       {"t_ns", worst->t_ns},
                       {"x_m", worst->position.x()},
                       {"y_m", worst->position.y()},
                       {"distance_m", worst->distance_m}};
  if (c.maps.T_a_b) {
    object["T_a_b"] = nlohmann::ordered_json::array();
    for (Eigen::Index r = 0; r < 4; ++r) {
      const Eigen::RowVector4d row = c.maps.T_a_b->matrix().row(r);
      object["T_a_b"].push_back({row[0], row[1], row[2], row[3]});
    }
  }
  return object;
}

nlohmann::ordered_json comparison_json(const FileComparison& c) {
  nlohmann::ordered_json landmarks = counts_json(c.maps.landmarks);
  landmarks["compared"] = c.maps.landmarks.compared;
  landmarks["judged"] = c.maps.landmarks.judged;
  landmarks["moved"] = c.maps.landmarks.moved;
  landmarks["median_m"] = or_null(c.maps.landmarks.median_m);
  nlohmann::ordered_json labels = counts_json(c.labels);
  labels["class_changed"] = c.labels.kind_changed;
  labels["compared"] = c.labels.compared;
  labels["moved"] = c.labels.moved;
  nlohmann::ordered_json layers = {{"same", nlohmann::ordered_json::array()},
                                   {"changed", nlohmann::ordered_json::array()},
                                   {"only_a", c.layers.only_a},
                                   {"only_b", c.layers.only_b}};
  for (const CommonLayer& layer : c.layers.both)
    layers[layer.same ? "same" : "changed"].push_back(layer.name);
  return {{"sessions",
           {{"both", c.maps.common_sessions},
            {"only_a", c.maps.sessions_only_a},
            {"only_b", c.maps.sessions_only_b}}},
          {"poses", poses_json(c)},
          {"landmarks", landmarks},
          {"loops", counts_json(c.maps.loops)},
          {"labels", labels},
          {"lanes",
           {{"length_a_m", c.lanes.length_a_m},
            {"length_b_m", c.lanes.length_b_m},
            {"share_a", or_null(c.lanes.share_a)},
            {"share_b", or_null(c.lanes.share_b)}}},
          {"layers", layers},
          {"value", nullptr}};
}

void say_poses(const Console& console, const FileComparison& c) {
  const auto worst = worst_place(c);
  if (!worst) {
    console.say("poses: none in both, so places are not compared");
    return;
  }
  console.say("poses: " + std::to_string(c.maps.poses.size()) + " in both, apart by " +
              fixed(*c.maps.median_m, 3) + " m (median), " + fixed(*c.maps.p95_m, 3) +
              " m (95 %), at most " + fixed(worst->distance_m, 3) + " m: " + worst->session +
              " at " + std::to_string(worst->t_ns) + ", x " + fixed(worst->position.x(), 1) +
              " m, y " + fixed(worst->position.y(), 1) + " m");
  if (c.maps.poses_of_other_pieces > 0)
    console.say("poses: " + std::to_string(c.maps.poses_of_other_pieces) +
                " more lie in pieces that nothing joins with these");
}

std::string names_text(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

std::string share_text(const std::optional<double>& share) {
  return share ? fixed(100.0 * *share, 1) + " %" : std::string("-");
}

}  // namespace

void print_comparison(const Console& console,
                      const FileComparison& c,
                      bool with_value,
                      const std::filesystem::path& page) {
  console.say("sessions: in both " + names_text(c.maps.common_sessions) + "; only in A " +
              names_text(c.maps.sessions_only_a) + "; only in B " +
              names_text(c.maps.sessions_only_b));
  say_poses(console, c);
  console.say("landmarks: " + counts_text(c.maps.landmarks) + "; " +
              std::to_string(c.maps.landmarks.moved) + " of " +
              std::to_string(c.maps.landmarks.judged) + " moved");
  console.say("loops: " + counts_text(c.maps.loops));
  console.say("labels: " + counts_text(c.labels) + "; " + std::to_string(c.labels.moved.size()) +
              " of " + std::to_string(c.labels.compared) + " moved, " +
              std::to_string(c.labels.kind_changed) + " of another class");
  console.say("lanes: " + fixed(c.lanes.length_a_m, 1) + " m in A, " + share_text(c.lanes.share_a) +
              " near one of B; " + fixed(c.lanes.length_b_m, 1) + " m in B, " +
              share_text(c.lanes.share_b) + " near one of A");
  std::vector<std::string> changed;
  for (const CommonLayer& layer : c.layers.both)
    if (!layer.same) changed.push_back(layer.name);
  console.say("layers: changed " + names_text(changed) + "; only in A " +
              names_text(c.layers.only_a) + "; only in B " + names_text(c.layers.only_b));
  for (const auto& [name, map, value] :
       {std::tuple("A", &c.a, &c.value_a), std::tuple("B", &c.b, &c.value_b)})
    if (!value->empty())
      console.say("value of sessions in " + std::string(name) +
                  " (sigma of the other sessions' poses): " + value_text(*map, *value));
  auto object = comparison_json(c);
  if (with_value)
    object["value"] = {{"a", value_json(c.a, c.value_a)}, {"b", value_json(c.b, c.value_b)}};
  object["page"] = page.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(page.string());
  if (!page.empty()) console.say("page: " + page.string());
  console.result(object);
}

}  // namespace roadbook
