#include "mapping/sessions/remove_session.hpp"

#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "mapping/pieces.hpp"
#include "mapping/sessions/map_part.hpp"

namespace roadbook {

int session_named(const Map& map, const std::string& name, const char* option) {
  std::string known;
  for (std::size_t s = 0; s < map.sessions.size(); ++s) {
    if (map.sessions[s].name == name) return static_cast<int>(s);
    known += (known.empty() ? "" : ", ") + map.sessions[s].name;
  }
  throw InvalidOption(option, name, known);
}

RemovedSession without_session(const Map& map, int session) {
  if (map.sessions.size() < 2)
    throw Refused("error: session " + map.sessions[at(session)].name +
                  ": got the only session of the map, want a map with another one");
  RemovedSession removed;
  removed.pieces_before = piece_count(map);
  std::vector<char> keeps;
  for (const Keyframe& keyframe : map.keyframes) keeps.push_back(keyframe.session != session);
  removed.map = part_of_map(map, keeps);
  removed.landmarks_lost = map.landmarks.size() - removed.map.landmarks.size();
  removed.pieces = piece_count(removed.map);
  return removed;
}

}  // namespace roadbook
