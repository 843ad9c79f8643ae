#include "exchange/layers/stored_paths.hpp"

#include <array>
#include <cstdio>

#include "base/error.hpp"
#include "mapping/store/map_file.hpp"

namespace roadbook {

void require_paths(const MapLayers& layers) {
  for (const char* name : {"lanes", "lane_paths"})
    if (!layers.has(name))
      throw BadInput(Problem{Severity::kError, layers.file().string(), 0, name, "none",
                             "lanes with paths: run `roadbook roads` on the map"});
}

StoredPaths load_paths(const std::filesystem::path& map) { return load_paths(MapLayers(map)); }

StoredPaths load_paths(const MapLayers& layers) {
  require_paths(layers);
  StoredPaths stored;
  stored.network = read_network_layers(layers);
  stored.paths = read_path_layers(layers);
  stored.digest = load_meta(layers.file()).digest;
  const VectorLayer lines = layers.read_layer("lane_paths");
  if (!lines.features.empty()) {
    const auto& values = lines.features.front().values;
    const auto text = [&](const char* name) {
      const auto at = lines.field(name);
      return at && std::holds_alternative<std::string>(values[*at])
                 ? std::get<std::string>(values[*at])
                 : std::string();
    };
    stored.source.date_utc = text("date_utc");
    stored.source.sessions = text("sessions");
    const auto sigma = lines.field("sigma_m");
    if (sigma && std::holds_alternative<double>(values[*sigma]))
      stored.source.sigma_m = std::get<double>(values[*sigma]);
  }
  return stored;
}

std::string fixed_text(double value, int decimals) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  std::string result = text.data();
  if (result[0] == '-' && result.find_first_not_of("-0.") == std::string::npos) result.erase(0, 1);
  return result;
}

}  // namespace roadbook
