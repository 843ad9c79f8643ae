#include "apps/evaluation/simulated_visits.hpp"

#include "base/format.hpp"
#include "sim/simulate.hpp"

namespace roadbook {

std::filesystem::path SimulatedVisits::file(const std::string& place,
                                            const std::string& end) const {
  return folder /
         (place + "_" + size + "_" + fixed(image_scale, 2) + "_seed" + std::to_string(seed) + end);
}

std::filesystem::path SimulatedVisits::drive(const std::string& place,
                                             int visit,
                                             const Progress& progress) const {
  const std::filesystem::path drive = file(place, "_visit" + std::to_string(visit));
  if (std::filesystem::exists(drive)) return drive;
  const Scenario scenario =
      load_scenario(place, {.size = size, .visit = visit, .image_scale = image_scale});
  SimulateOptions simulated;
  simulated.seed = seed;
  simulated.num_threads = num_threads;
  // A drive that was interrupted half-way must not be taken for a whole one.
  const std::filesystem::path part = drive.string() + ".part";
  std::filesystem::remove_all(part);
  simulate(scenario, part, simulated, progress);
  std::filesystem::rename(part, drive);
  return drive;
}

}  // namespace roadbook
