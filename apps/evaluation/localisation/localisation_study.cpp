#include "apps/evaluation/localisation/localisation_study.hpp"

#include "base/format.hpp"
#include "base/messages.hpp"
#include "mapping/pieces.hpp"
#include "sim/simulate.hpp"
#include "vo/own_car_mask.hpp"
#include "workflows/localisation/localise_in_map.hpp"
#include "workflows/localisation/world_in_map.hpp"
#include "workflows/map_drives.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// Names hold the options: a folder may serve several studies.
std::string name_of_place(const std::string& place, const LocalisationStudyOptions& options) {
  return place + "_" + options.size + "_" + fixed(options.image_scale, 2) + "_seed" +
         std::to_string(options.seed);
}

fs::path drive_of(const fs::path& folder,
                  const std::string& place,
                  int visit,
                  const LocalisationStudyOptions& options) {
  return folder / (name_of_place(place, options) + "_visit" + std::to_string(visit));
}

fs::path map_of(const fs::path& folder,
                const std::string& place,
                const LocalisationStudyOptions& options) {
  return folder / (name_of_place(place, options) + ".gpkg");
}

void make_drive(const fs::path& drive,
                const std::string& place,
                int visit,
                const LocalisationStudyOptions& options,
                const Progress& progress) {
  if (fs::exists(drive)) return;
  const Scenario scenario = load_scenario(
      place, {.size = options.size, .visit = visit, .image_scale = options.image_scale});
  SimulateOptions simulated;
  simulated.seed = options.seed;
  simulated.num_threads = options.num_threads;
  // A drive that was interrupted half-way must not be taken for a whole one.
  const fs::path part = drive.parent_path() / (drive.filename().string() + ".part");
  fs::remove_all(part);
  simulate(scenario, part, simulated, progress);
  fs::rename(part, drive);
}

void make_map(const fs::path& map, const fs::path& drive, const LocalisationStudyOptions& options) {
  MapRequest request;
  request.drives = {drive};
  request.map = map;
  request.options.num_threads = options.num_threads;
  NoMessages messages;
  (void)map_drives(request, messages);
}

StartTally starts_of(const fs::path& drive_folder,
                     const fs::path& map_file,
                     const LandmarkIndex& index,
                     const LocalisationStudyOptions& options,
                     const Progress& progress) {
  const Drive drive = Drive::open(drive_folder);
  const OwnCar car = find_own_car(drive, std::nullopt, options.num_threads);
  return random_starts(drive, car.masks, index, world_in_map(map_file, index.map(), drive),
                       options.starts, options.seed, options.num_threads, progress);
}

}  // namespace

LocalisationStudy localisation_study(const fs::path& folder,
                                     const LocalisationStudyOptions& options,
                                     const Progress& progress) {
  LocalisationStudy study;
  for (const std::string& place : options.places) {
    for (int visit = 0; visit <= options.visits; ++visit)
      make_drive(drive_of(folder, place, visit, options), place, visit, options, progress);
    make_map(map_of(folder, place, options), drive_of(folder, place, 0, options), options);
  }
  for (const std::string& place : options.places) {
    const fs::path file = map_of(folder, place, options);
    const Map map = load_joined_map(file);
    const LandmarkIndex index(map);
    for (int visit = 1; visit <= options.visits; ++visit) {
      LocaliseRequest request;
      request.drive = drive_of(folder, place, visit, options);
      request.map = file;
      request.frames = request.drive.string() + ".csv";
      request.options.tracking.num_threads = options.num_threads;
      NoMessages messages;
      VisitFigures figures{place, visit, localise_in_map(request, messages).figures, {}};
      figures.starts = starts_of(request.drive, file, index, options, progress);
      study.visits.push_back(std::move(figures));
    }
    for (const std::string& other : options.places)
      if (other != place)
        study.foreign.push_back(
            {other, place,
             starts_of(drive_of(folder, other, 1, options), file, index, options, progress)});
  }
  return study;
}

}  // namespace roadbook
