#include "base/error.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/stored_paths.hpp"
#include "speedmap/property_map/slice.hpp"

namespace roadbook {

PropertySlice lane_slice(const FrictionMap& friction,
                         const LaneStrips::Strip& strip,
                         double from_m,
                         double to_m,
                         const std::string& map_name,
                         std::size_t property) {
  PropertySlice slice =
      make_slice(friction.map, property, strip.begin_m + from_m, strip.begin_m + to_m,
                 {map_name + " lane " + std::to_string(strip.lane), friction.date_ns});
  // The lane's own s.
  slice.s_begin_m -= strip.begin_m;
  slice.s_end_m -= strip.begin_m;
  for (SliceKnot& knot : slice.knots) knot.s_m -= strip.begin_m;
  return slice;
}

Paths export_spm(const std::filesystem::path& map,
                 const std::filesystem::path& out,
                 const ExportOptions& options) {
  const StoredPaths stored = load_paths(map);
  const auto friction = read_friction_layers(MapLayers(map), stored.paths);
  if (!friction)
    throw BadInput(Problem{Severity::kError, map.string(), 0, "friction", "none",
                           "a friction map: run `roadbook friction` on the map"});
  const std::size_t property = property_of(friction->map, options.property, "--property");
  std::vector<const LaneStrips::Strip*> lanes;
  for (const LaneStrips::Strip& strip : friction->strips.strips())
    if (options.lane.empty() || std::to_string(strip.lane) == options.lane) lanes.push_back(&strip);
  if (lanes.empty()) throw InvalidOption("--lane", options.lane, "the id of a lane with a path");
  const bool header = out.extension() == ".h" || out.extension() == ".hpp";
  Paths files;
  for (const LaneStrips::Strip* strip : lanes) {
    const PropertySlice slice =
        lane_slice(*friction, *strip, 0.0, strip->length_m(), stored.digest, property);
    files.push_back(lanes.size() == 1 ? out : with_suffix(out, std::to_string(strip->lane)));
    write_whole_file(files.back(),
                     header ? slice_header(slice, options.property) : slice_json(slice));
  }
  return files;
}

}  // namespace roadbook
