#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/inference/diagnosis_result.hpp"
#include "sensors/rig.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// A diagnosis in the words of those who keep the car: what is wrong, by how much, how sure that is,
// what to do, and what it gains. The evidence behind it stays in the `Diagnosis`.

/// The text with a capital letter in front.
[[nodiscard]] std::string capitalised(std::string text);

/// The vehicle as the files of the drive state it.
struct StatedVehicle {
  WheelModel wheels;
  bool of_log = false;  ///< stated in the description of a plain log, whose keys have other names
  Rig rig{};            ///< empty: new values of cameras are not said
};

struct Advice {
  std::string effect;  ///< its name in the catalogue
  std::string fault;   ///< "Both rear wheels are larger than stated", with the drive if it is one
  std::string size;    ///< "1.87 % (1.66 to 2.08 %)", in the units of a workshop
  std::string certainty;  ///< "sure", "likely", or the names that explain the drive as well
  std::string action;     ///< "Set ...", or the drive that decides; empty: nothing is known to help
  std::string gain;       ///< what this correction gains in dead reckoning; empty: not measured
  bool of_place = false;  ///< a feature of the place, not a fault of a sensor
};

/// Of each cause of `d`, in its order. New values of the vehicle are only said where `stated` is
/// given; they hold with all faults corrected together.
[[nodiscard]] std::vector<Advice> advice_of(const Diagnosis& d,
                                            const std::optional<StatedVehicle>& stated);

/// "After 5 s, dead reckoning is off by 34 cm and 1.2 deg; with all corrections, by 2.0 cm and 0.10
/// deg (root mean square of 120 pieces of the drive)"; empty if it was not measured.
[[nodiscard]] std::string reckoning_text(const Diagnosis& d);

/// Nouns of the effects that were looked for, that this drive shows, and that it does not have.
[[nodiscard]] std::vector<std::string> checked_and_fine(
    const Diagnosis& d, const std::optional<StatedVehicle>& stated = {});

/// Effects that this drive does not show, by the drive that would show them.
struct BlindSpot {
  std::string drive;               ///< "drive the same street at 5 and at 20 m/s"
  std::vector<std::string> nouns;  ///< "growth of the tyres with speed"
};
[[nodiscard]] std::vector<BlindSpot> blind_spots(const Diagnosis& d,
                                                 const std::optional<StatedVehicle>& stated = {});

/// The advice as lines of text: two or three for each cause, and one for the gain.
[[nodiscard]] std::vector<std::string> advice_lines(const Diagnosis& d,
                                                    const std::optional<StatedVehicle>& stated);

}  // namespace roadbook
