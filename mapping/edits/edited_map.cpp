#include "mapping/edits/edited_map.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "base/index.hpp"
#include "mapping/edits/edit_graph.hpp"
#include "mapping/joined_parts.hpp"
#include "mapping/pipeline/map_stages.hpp"
#include "mapping/sessions/extended_map.hpp"
#include "mapping/sessions/stored_input.hpp"

namespace roadbook {
namespace {

LoopEdge edge_of(const RelativePose& motion) {
  LoopEdge edge;
  edge.from = motion.from;
  edge.to = motion.to;
  edge.T_from_to = motion.T_from_to;
  edge.information = motion.information;
  edge.accepted = true;
  edge.weight = 1.0;
  edge.reason = "edited by hand";
  return edge;
}

// Landmarks join the images of places that are apart no more: each side keeps its own.
void split_apart(const Map& map,
                 const EditTerms& terms,
                 std::vector<TrackMatch>& same,
                 const VoResult& odometry) {
  if (terms.apart.empty()) return;
  std::erase_if(same, [&](const TrackMatch& match) {
    return std::any_of(odometry.tracks[at(match.track)].observations.begin(),
                       odometry.tracks[at(match.track)].observations.end(), [&](const auto& o) {
                         return are_apart(map, terms, o.keyframe, match.view.keyframe);
                       });
  });
}

// Parts that an edit has joined become one piece.
void join_pieces(Map& map) {
  const std::vector<int> parts = joined_parts(map);
  std::map<int, int> number;
  for (std::size_t k = 0; k < parts.size(); ++k)
    map.keyframes[k].piece =
        number.try_emplace(parts[k], static_cast<int>(number.size())).first->second;
}

}  // namespace

Map edited_map(const Map& map,
               const std::vector<MapEdit>& edits,
               const MapOptions& options,
               const Progress& progress) {
  if (edits.empty()) return map;
  const EditTerms terms = terms_of_edits(map, edits);
  Relaxed relaxed;
  relaxed.T_map_vehicle = relaxed_with_edits(map, edits, terms, options.graph, progress);

  Map base = map;
  std::erase_if(base.loops,
                [&](const LoopEdge& loop) { return are_apart(map, terms, loop.from, loop.to); });
  for (const RelativePose& motion : terms.motions) base.loops.push_back(edge_of(motion));
  join_pieces(base);
  for (const Keyframe& keyframe : base.keyframes) relaxed.component.push_back(keyframe.piece);

  StoredInput stored = stored_input(base);
  AdjustTerms with;
  with.same = std::move(stored.same);
  split_apart(map, terms, with.same, stored.input.odometry);
  with.priors = terms.anchors;
  for (const RelativePose& motion : terms.motions)
    with.motions.push_back({motion.from, motion.to, motion.T_from_to, motion.information});
  if (!terms.apart.empty())
    with.may_join = [&](int a, int b) { return !are_apart(map, terms, a, b); };
  Adjusted adjusted = adjust(stored.input, {}, relaxed, options, progress, with);
  adjusted.stage.problem.priors.clear();  // the gauge of covariances is the first keyframe
  add_covariances(stored.input, relaxed, {}, options, adjusted);

  JoinedSession joined;
  joined.first_keyframe = base.keyframes.size();
  joined.input = std::move(stored.input);
  for (std::size_t k = 0; k < base.keyframes.size(); ++k) {
    joined.T_map_vehicle.push_back(base.T_map_vehicle(static_cast<int>(k)));
    joined.piece.push_back(base.keyframes[k].piece);
  }
  joined.tracks = adjusted.tracks;
  Map edited = adjusted_map(base, joined, adjusted, options);
  for (std::size_t s = 0; s < edited.sessions.size(); ++s) {
    const int scale = adjusted.stage.scale_of_session[s];
    if (scale >= 0) edited.sessions[s].wheel_scale = adjusted.stage.problem.scales[at(scale)].value;
  }
  return edited;
}

}  // namespace roadbook
