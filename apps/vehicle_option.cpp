#include "apps/vehicle_option.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "drive/vehicle_yaml.hpp"

namespace roadbook {
namespace {

std::string in_words(VehicleSource source) {
  switch (source) {
    case VehicleSource::kOption:
      return "from --vehicle";
    case VehicleSource::kFile:
      return "from vehicle.yaml of the drive";
    case VehicleSource::kMeasured:
      return "measured in the images (no vehicle.yaml)";
    case VehicleSource::kNone:
      break;
  }
  return "not seen in the images (no vehicle.yaml)";
}

}  // namespace

void add_vehicle_option(Options& options, std::filesystem::path* file) {
  options.add("--vehicle", file,
              "YAML file with the vehicle's measures; replaces vehicle.yaml of the drives");
}

std::optional<VehicleMeasures> given_vehicle(const std::filesystem::path& file) {
  if (file.empty()) return std::nullopt;
  return load_vehicle(file);
}

void say_vehicle(const Console& console, const std::vector<VehicleSource>& sources) {
  std::string text;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (std::find(sources.begin(), sources.begin() + static_cast<std::ptrdiff_t>(i), sources[i]) !=
        sources.begin() + static_cast<std::ptrdiff_t>(i))
      continue;
    text += (text.empty() ? "" : "; ") + in_words(sources[i]);
  }
  if (!text.empty()) console.say("own vehicle: " + text);
}

nlohmann::ordered_json vehicle_json(const std::vector<VehicleSource>& sources) {
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  bool same = true;
  for (const VehicleSource source : sources) {
    names.push_back(vehicle_source_name(source));
    same = same && source == sources.front();
  }
  return same && !names.empty() ? names.front() : names;
}

}  // namespace roadbook
