#include "apps/summaries/value_summary.hpp"

#include "base/format.hpp"

namespace roadbook {
namespace {

const std::string& name_of_session(const Map& map, const SessionValue& value) {
  return map.sessions[static_cast<std::size_t>(value.session)].name;
}

nlohmann::ordered_json change_json(const SigmaChange& change) {
  if (change.count == 0) return nullptr;
  return {{"count", change.count},
          {"with_m", change.with_m},
          {"without_m", change.without_m},
          {"gain_m", change.gain_m()}};
}

}  // namespace

nlohmann::ordered_json value_json(const Map& map, const std::vector<SessionValue>& values) {
  auto list = nlohmann::ordered_json::array();
  for (const SessionValue& value : values)
    list.push_back({{"session", name_of_session(map, value)},
                    {"poses", change_json(value.poses)},
                    {"labels", change_json(value.points)},
                    {"landmarks", change_json(value.landmarks)},
                    {"pieces_more", value.pieces_more}});
  return list;
}

std::string value_text(const Map& map, const std::vector<SessionValue>& values) {
  std::string text;
  for (const SessionValue& value : values)
    text += (text.empty() ? "" : ", ") + name_of_session(map, value) + " " +
            (value.poses.count > 0 ? fixed(1e3 * value.poses.gain_m(), 1) + " mm" : "unknown");
  return text;
}

std::string change_mm_text(const SigmaChange& change) {
  if (change.count == 0) return "-";
  return fixed(1e3 * change.without_m, 1) + " -> " + fixed(1e3 * change.with_m, 1);
}

}  // namespace roadbook
