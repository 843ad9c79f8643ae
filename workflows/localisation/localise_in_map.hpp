#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/messages.hpp"
#include "mapping/localisation/localise_drive.hpp"
#include "workflows/localisation/localisation_figures.hpp"

namespace roadbook {

/// The arguments of `localise_in_map`.
struct LocaliseRequest {
  std::filesystem::path drive;
  std::filesystem::path map;
  std::filesystem::path poses;    ///< TUM trajectory to write; empty: none
  std::filesystem::path frames;   ///< CSV table to write; empty: none
  std::filesystem::path model;    ///< YAML of known effects; empty: none
  std::filesystem::path vehicle;  ///< YAML with measures of the vehicle; empty: those of the drive
  std::vector<std::string> sessions;  ///< of the map, whose views count; empty: all
  bool with_predicted = false;        ///< the trajectory holds predicted poses too
  std::optional<double> want;         ///< share of frames that must be localised
  LocaliseDriveOptions options;
};

struct LocaliseResult {
  std::vector<TimedFrame> frames;
  LocalisationFigures figures;
  std::vector<double> off_m;  ///< true error of each frame; NaN: unknown; empty without truth
  std::vector<Eigen::Vector2d> map_places;  ///< of the map's poses [m]
  std::string map_digest;
  std::vector<std::string> sessions_used;
  std::vector<Problem> warnings;
  std::optional<Refused> refusal;  ///< fewer frames were localised than wanted
};

/// Localises a drive in a map, which is only read, and writes the files. Truth is compared if the
/// drive is simulated and the drive of a session of the same place is available. Throws BadInput
/// (the drive or the map cannot be read, the map has no landmarks), InvalidOption (a start outside
/// the map, a session that it does not have), StorageError, Interrupted.
[[nodiscard]] LocaliseResult localise_in_map(const LocaliseRequest& request, Messages& messages);

}  // namespace roadbook
