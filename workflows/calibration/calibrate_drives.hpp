#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/messages.hpp"
#include "mapping/calibration/calibrate.hpp"
#include "mapping/pipeline/map_options.hpp"

namespace roadbook {

/// The arguments of `calibrate_drives`.
struct CalibrateRequest {
  std::vector<std::filesystem::path> drives;  ///< of one vehicle
  std::filesystem::path map;  ///< of the drives, from which the first estimate starts; empty: none
  std::filesystem::path model;    ///< YAML of known effects, from which the estimate starts
  std::vector<std::string> held;  ///< columns that keep their stated or known value
  MapOptions options;             ///< for mapping the drives
};

/// One parameter of the calibration as files state it, and as estimated.
struct CalibratedValue {
  CalibratedColumn column;
  std::string unit;     ///< of the next three: "deg", "px", "ms", "m", "%"
  double before = 0.0;  ///< turns: beyond the stated mounting
  double after = 0.0;
  double half_width = 0.0;  ///< of the 95 % interval of `after`
};

struct CalibrateResult {
  EstimatedCalibration calibration;
  std::vector<CalibratedValue> values;  ///< in the order of the columns
  EffectSizes model;  ///< the known effects with the estimated ones, for `map --model`
  std::vector<Problem> warnings;
  std::optional<Refused> refusal;  ///< the drives do not tell columns that a calibration needs
};

/// Maps the drives, takes a first step of the calibration from the map, maps the drives once more
/// with it, and calibrates from there: the tracks of the first map had to agree with the old
/// calibration. `map` replaces the first mapping.
///
/// Throws the exceptions of `build_map`; BadInput for drives that do not have the same cameras and
/// wheels, and for a drive that is not in the map.
[[nodiscard]] CalibrateResult calibrate_drives(const CalibrateRequest& request, Messages& messages);

/// The refusal of a calibration that lacks columns it needs: a line with these columns, their
/// intervals and how to drive so that they are observable. `drive`: for the line. Empty
/// if all are observable or held.
[[nodiscard]] std::optional<Refused> refusal_of(const std::vector<CalibratedColumn>& columns,
                                                const std::filesystem::path& drive);

/// The text of a model file: the effects, each with the interval of its column as a comment.
[[nodiscard]] std::string calibrated_model_text(const CalibrateResult& result);

}  // namespace roadbook
