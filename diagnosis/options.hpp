#pragma once

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/motion/motion_problem.hpp"

namespace roadbook {

/// Options of a diagnosis, whatever it is made from.
struct DiagnosisOptions {
  SearchOptions search;
  LibraryOptions library;
  ObservationOptions observation;
  double min_length_m = 10.0;  ///< driven; less says nothing about wheels
  double min_duration_s = 5.0;
  EffectSizes known;  ///< already part of the model (`--model`): not zero but this
  /// Threads of a diagnosis through a map; 0: all cores. The result is the same for any number.
  int num_threads = 1;
};

}  // namespace roadbook
