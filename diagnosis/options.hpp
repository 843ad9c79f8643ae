#pragma once

#include "diagnosis/inference/candidate.hpp"
#include "diagnosis/inference/search_result.hpp"
#include "diagnosis/streams/observe.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// Options of a diagnosis, whatever it is made from.
struct DiagnosisOptions {
  SearchOptions search;
  LibraryOptions library;
  ObservationOptions observation;
  double min_length_m = 10.0;   ///< shortest driven length that is diagnosed
  double min_duration_s = 5.0;  ///< shortest duration that is diagnosed
  EffectSizes known;            ///< effects of the nominal model (`--model`); empty: none
  bool compare = false;         ///< simulate the drive again, and compare (`Diagnosis::simulated`)
  /// Threads of a diagnosis through a map; 0: all cores. The result is the same for any number.
  int num_threads = 1;
};

}  // namespace roadbook
