#include "workflows/diagnosis/localised_drive.hpp"

#include "base/error.hpp"
#include "base/temporary_folder.hpp"
#include "mapping/pipeline/build_map.hpp"
#include "mapping/store/map_file.hpp"

namespace roadbook {

LocalisedDrive localised_drive(const Map& frozen,
                               const std::filesystem::path& file,
                               const std::filesystem::path& drive,
                               int num_threads,
                               Messages& messages) {
  const TemporaryFolder folder;
  const auto own = folder.path() / "own.gpkg";
  MapOptions options;
  options.covariances = false;
  options.num_threads = num_threads;
  (void)build_map({drive}, own, options, messages.progress());
  auto found = localise_in(frozen, load_map(own));
  if (!found)
    throw Refused("error: " + file.string() + ": " + drive.string() +
                  ": got too few landmarks of the map in the drive, want a drive of its place");
  return std::move(*found);
}

}  // namespace roadbook
