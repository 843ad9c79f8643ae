#include <algorithm>

#include "base/error.hpp"
#include "mapping/session_car.hpp"
#include "semantics/overhead/overhead.hpp"

namespace roadbook {

OverheadInput overhead_input(const Map& map,
                             const std::vector<const Drive*>& drives,
                             const OverheadOptions& options) {
  ROADBOOK_ASSERT(drives.size() == map.sessions.size());
  OverheadInput input;
  GroundModelOptions ground = options.ground;
  for (std::size_t s = 0; s < map.sessions.size(); ++s) {
    input.rigs.push_back(map.sessions[s].rig);
    const OwnCar car = drives[s] != nullptr ? own_car_of(map.sessions[s], *drives[s],
                                                         options.vehicle, options.num_threads)
                                            : OwnCar{};
    VehicleUse use{car.source, {}};
    for (std::size_t c = 0; c < car.masks.size(); ++c)
      use.masked_share.push_back(car.masked_share(c));
    input.masks.push_back(car.masks);
    input.bodies.push_back(body_or_outline(car.vehicle, map.sessions[s].rig));
    input.vehicles.push_back(std::move(use));
  }
  // The surface must reach as far as any camera sees. Cameras may be up to 5 m from the origin.
  const double range = options.max_range_m.value_or(range_of_rigs(input.rigs));
  ground.reach_m = std::max(ground.reach_m, range + 5.0);
  input.ground = estimate_ground(map, ground);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Keyframe& keyframe = map.keyframes[k];
    const Drive* const drive = drives[static_cast<std::size_t>(keyframe.session)];
    if (drive == nullptr) continue;
    OverheadView view;
    view.T_map_vehicle = map.T_map_vehicle(static_cast<int>(k));
    view.rig = keyframe.session;
    view.session = keyframe.session;
    view.keyframe = static_cast<int>(k);
    view.t_ns = keyframe.t_ns;
    const auto frame = static_cast<std::size_t>(keyframe.drive_frame);
    const std::size_t cameras = input.rigs[static_cast<std::size_t>(view.rig)].cameras.size();
    for (std::size_t camera = 0; camera < cameras; ++camera)
      view.images.emplace_back([drive, frame, camera] { return drive->read_image(frame, camera); });
    input.views.push_back(std::move(view));
  }
  return input;
}

OverheadSummary make_overhead(const Map& map,
                              const std::vector<const Drive*>& drives,
                              const std::filesystem::path& out,
                              const OverheadOptions& options,
                              const Progress& progress) {
  return make_overhead(overhead_input(map, drives, options), out, options, progress);
}

}  // namespace roadbook
