#include "workflows/overhead_of_map.hpp"

#include <algorithm>

#include "drive/vehicle_yaml.hpp"
#include "exchange/layers/layer_ages.hpp"
#include "mapping/pieces.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/overhead/overhead_layers.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {

OverheadResult overhead_of_map(const OverheadRequest& request, Messages& messages) {
  OverheadOptions options = request.options;
  if (!request.vehicle.empty()) options.vehicle = load_vehicle(request.vehicle);
  OverheadResult result;
  MapUpdate update(request.map);  // locks the map between reading and writing
  result.map = load_joined_map(request.map);
  const auto drives = open_session_drives(request.map, result.map, request.drives, messages);
  std::vector<const Drive*> pointers;
  for (const auto& drive : drives) pointers.push_back(drive ? &*drive : nullptr);
  if (std::all_of(pointers.begin(), pointers.end(), [](const Drive* d) { return d == nullptr; }))
    throw BadInput({Severity::kError, request.map.string(), 0, "drives",
                    "none of " + std::to_string(pointers.size()),
                    "at least one recorded drive (--drive FOLDER)"});
  const std::filesystem::path folder =
      request.output.empty() ? std::filesystem::path(request.map).replace_extension() += "_overhead"
                             : request.output;
  result.summary = make_overhead(result.map, pointers, folder, options, messages.progress());
  store_overhead(result.map, result.summary, &update);
  std::int64_t newest_ns = 0;
  for (std::size_t s = 0; s < result.map.sessions.size(); ++s)
    if (drives[s]) newest_ns = std::max(newest_ns, result.map.sessions[s].t_end_ns);
  write_raster_age(update, MapLayers(request.map), {"overhead", newest_ns, kOverheadHalfLife_s},
                   newest_ns);
  update.commit();
  for (std::size_t s = 0; s < result.summary.vehicles.size(); ++s)
    if (drives[s]) result.vehicles.push_back(result.summary.vehicles[s].source);
  return result;
}

}  // namespace roadbook
