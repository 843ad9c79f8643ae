#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/inference/checks.hpp"
#include "diagnosis/inference/evidence.hpp"
#include "diagnosis/inference/held_out.hpp"
#include "diagnosis/numerics/sample_difference.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

// The result of a diagnosis: effects with sizes, and what the data do not explain or do not show.

/// A place in the map where an effect shows (removed landmarks).
struct FoundPlace {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< [m], map frame
  double reach_m = 0.0;                              ///< distance of the farthest landmark [m]
  std::size_t landmarks = 0;                         ///< landmarks that should be visible there
  double expected = 0.0;                             ///< number of them expected to be found again
  std::size_t found = 0;
  double expected_sightings = 0.0;
  std::size_t sightings = 0;
  double p = 1.0;  ///< corrected for the number of places
};

/// How far dead reckoning by wheels, gyro and steering is off the reference after a few seconds.
struct ReckoningError {
  double over_s = 5.0;       ///< length of each piece of the drive
  std::size_t pieces = 0;    ///< pieces compared; one begins each second
  double position_m = 0.0;   ///< root mean square over the pieces
  double heading_rad = 0.0;  ///< root mean square over the pieces
};

struct FoundCause {
  std::string effect;
  double size = 0.0;
  std::string unit;
  double low = 0.0;  ///< 95 % interval
  double high = 0.0;
  double p = 1.0;  ///< corrected for the number of candidates
  double evidence = 0.0;
  HeldOutGain gain;
  std::vector<std::string> inseparable;
  EffectSizes instead;     ///< size that each member of `inseparable` would have
  std::string separating;  ///< a drive that would separate it from them, as a sentence
  EvidencePlot plot;
  bool noise = false;     ///< an effect on the noise of a stream, not on its readings
  std::string note;       ///< "within 3 m of x = ..." of a place
  std::string session{};  ///< drive of the effect, with several drives; empty: all
  std::vector<FoundPlace> places{};
  bool in_place = false;  ///< acts in one place, or from one moment on
  bool at_known =
      false;  ///< the model knows an effect at this place; this is the difference from it
  /// Of the model with all effects found but this one (effects of motion).
  std::optional<ReckoningError> reckoned_without{};
};

/// A generic effect that no catalogued effect explains: "stream.hook depends on ...".
struct UnknownCause {
  std::string stream;
  std::string hook;
  std::string depends_on;
  std::vector<double> terms;             ///< coefficients of the estimated smooth function
  std::vector<std::string> inseparable;  ///< other covariates that explain this drive as well
  std::string unit;
  double p = 1.0;
  HeldOutGain gain;
  EvidencePlot plot;
};

/// One quantity of a recorded drive, against simulations of the same drive: its readings less what
/// the reference predicts with the stated calibration, or the error of dead reckoning.
struct StreamComparison {
  std::string stream;   ///< "imu0"; "dead reckoning"
  std::string channel;  ///< "yaw_rate"
  std::string unit;     ///< "deg/s"
  std::size_t rows = 0;
  Moments recorded;                          ///< of the recorded drive, in `unit`
  SampleDifference stated;                   ///< simulated as the files state the car
  std::optional<SampleDifference> extended;  ///< with the effects found; empty: none was found
};

struct Diagnosis {
  std::vector<FoundCause> causes;  ///< strongest first
  std::vector<UnknownCause> unknown;
  std::vector<std::string> not_observable;
  std::vector<std::string>
      unexplained;                 ///< lack of fit without a known cause: "autocorrelation in ..."
  std::vector<std::string> notes;  ///< data that could not be used, and why
  std::vector<ChannelCheck> before;
  std::vector<ChannelCheck> after;
  /// The model with all effects found; with several drives, with those common to all.
  EffectSizes extended;
  std::vector<std::string> looked_for;  ///< catalogued effects that were candidates
  double fit_gain = 0.0;  ///< [nats] log likelihood of the extended model beyond the nominal one's
  std::size_t samples = 0;
  double length_m = 0.0;
  std::optional<ReckoningError> reckoned_before;  ///< of the nominal model
  std::optional<ReckoningError> reckoned_after;   ///< of the extended model
  std::vector<StreamComparison> simulated;        ///< `DiagnosisOptions::compare`; else empty
};

/// Sorts by evidence, largest first; effects on noise come last.
void sort_causes(std::vector<FoundCause>& causes);

/// True if the effect was a candidate and the data can show it.
[[nodiscard]] bool shows(const Diagnosis& d, const std::string& effect);

/// Appends the lists of `more` to those of `all`: unknown, unexplained, notes, checks.
void add_lists(const Diagnosis& more, Diagnosis& all);

/// Adds the findings of other streams of the same drive, or of another drive, and sorts the effects
/// (`sort_causes`). An effect is not observable if no diagnosis that considered it can show it.
void add_findings(const Diagnosis& more, Diagnosis& all);

}  // namespace roadbook
