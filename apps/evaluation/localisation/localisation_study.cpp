#include "apps/evaluation/localisation/localisation_study.hpp"

#include "apps/evaluation/simulated_visits.hpp"
#include "base/messages.hpp"
#include "mapping/pieces.hpp"
#include "vo/own_car_mask.hpp"
#include "workflows/localisation/localise_in_map.hpp"
#include "workflows/localisation/world_in_map.hpp"
#include "workflows/map_drives.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

SimulatedVisits visits_of(const fs::path& folder, const LocalisationStudyOptions& options) {
  return {folder, options.size, options.image_scale, options.seed, options.num_threads};
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
  const SimulatedVisits visits = visits_of(folder, options);
  for (const std::string& place : options.places) {
    for (int visit = 0; visit <= options.visits; ++visit)
      (void)visits.drive(place, visit, progress);
    make_map(visits.file(place, ".gpkg"), visits.drive(place, 0), options);
  }
  for (const std::string& place : options.places) {
    const fs::path file = visits.file(place, ".gpkg");
    const Map map = load_joined_map(file);
    const LandmarkIndex index(map);
    for (int visit = 1; visit <= options.visits; ++visit) {
      LocaliseRequest request;
      request.drive = visits.drive(place, visit);
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
            {other, place, starts_of(visits.drive(other, 1), file, index, options, progress)});
  }
  return study;
}

}  // namespace roadbook
