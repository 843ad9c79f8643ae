#pragma once

#include <string>
#include <vector>

#include "diagnosis/checks.hpp"
#include "diagnosis/evidence.hpp"
#include "diagnosis/search.hpp"
#include "diagnosis/streams.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

// What the simulation gets wrong in a drive: the whole of it, from plain streams.

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
  EvidencePlot plot;
  std::string note;  ///< "at x = ..., y = ..., radius ..." of a place
};

/// What no name explains: "stream.hook depends on ...".
struct UnknownCause {
  std::string stream;
  std::string hook;
  std::string depends_on;
  std::vector<double> terms;  ///< of the smooth function found
  std::string unit;
  double p = 1.0;
  HeldOutGain gain;
  EvidencePlot plot;
};

struct Diagnosis {
  std::vector<FoundCause> causes;  ///< strongest first
  std::vector<UnknownCause> unknown;
  std::vector<std::string> not_observable;
  std::vector<std::string> unexplained;  ///< "autocorrelation in ...": flagged, not understood
  std::vector<std::string> notes;        ///< what could not be looked at, and why
  std::vector<ChannelCheck> before;
  std::vector<ChannelCheck> after;
  EffectSizes extended;  ///< the model with everything found
  std::size_t samples = 0;
  double length_m = 0.0;
};

struct DiagnosisOptions {
  SearchOptions search;
  ObservationOptions observation;
  double min_length_m = 10.0;  ///< driven; less says nothing about wheels
  double min_duration_s = 5.0;
  EffectSizes known;  ///< already part of the model (`--model`): not zero but this
};

/// Everything about one drive. Throws BadInput where the streams cannot be diagnosed: `name` stands
/// for the drive in messages.
[[nodiscard]] Diagnosis diagnose(const MotionStreams& streams,
                                 const std::string& name,
                                 const DiagnosisOptions& options = {});

}  // namespace roadbook
