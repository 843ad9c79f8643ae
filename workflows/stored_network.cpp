#include "workflows/stored_network.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {

std::optional<RoadNetwork> stored_network(const MapLayers& layers) {
  if (!layers.has("lanes")) return std::nullopt;
  return read_network_layers(layers);
}

NetworkSource source_of(const Map& map) {
  NetworkSource source;
  std::int64_t newest_ns = 0;
  for (const Session& session : map.sessions) {
    source.sessions += (source.sessions.empty() ? "" : ",") + session.name;
    newest_ns = std::max(newest_ns, session.t_end_ns);
  }
  source.date_utc = utc_text(newest_ns);
  // One unknown covariance makes the mean of all unknown (NaN).
  double variance = 0.0;
  for (const Keyframe& keyframe : map.keyframes)
    variance += (keyframe.covariance(0, 0) + keyframe.covariance(1, 1)) / 2.0;
  if (!map.keyframes.empty())
    source.sigma_m = std::sqrt(variance / static_cast<double>(map.keyframes.size()));
  return source;
}

}  // namespace roadbook
