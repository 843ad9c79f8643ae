#include "mapping/pieces.hpp"

#include <algorithm>
#include <string>

#include "base/error.hpp"
#include "mapping/store/map_file.hpp"

namespace roadbook {

int piece_count(const Map& map) {
  int count = 1;
  for (const Keyframe& keyframe : map.keyframes) count = std::max(count, keyframe.piece + 1);
  return count;
}

void require_one_piece(const std::filesystem::path& file) {
  const auto values = load_meta(file).values;
  const auto pieces = values.find(kPiecesKey);
  if (pieces == values.end() || pieces->second == "1") return;
  throw Refused(
      to_line({Severity::kError, file.string(), 0, "pieces", pieces->second + " that nothing joins",
               "one (a map of the drives of one place, made without --apart)"}));
}

Map load_joined_map(const std::filesystem::path& file) {
  require_one_piece(file);
  return load_map(file);
}

}  // namespace roadbook
