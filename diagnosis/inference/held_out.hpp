#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/inference/innovations.hpp"

namespace roadbook {

/// Gain in log predictive density on blocks that the sizes were not fitted to.
struct HeldOutGain {
  double total = 0.0;       ///< [nats] over the drive
  double per_sample = 0.0;  ///< over the number of innovations
  double low = 0.0;         ///< 95 % interval of the total
  double high = 0.0;
  double positive_blocks = 0.0;  ///< share
  bool interleaved = false;      ///< causes of one place cannot be predicted from other places
};

struct HeldOutOptions {
  std::size_t blocks = 10;    ///< of each drive; the k-th ones of all drives are held out together
  double embargo_s = 1.0;     ///< on either side of a block, in nobody's training set
  double interleave_s = 0.8;  ///< length of the short blocks of local causes
};

/// Of a model with the columns `with` against one without `extra` of them. Columns count among the
/// innovations' sides; `offset` is what the residual lacks of each (sizes put back).
[[nodiscard]] HeldOutGain held_out_gain(const Innovations& innovations,
                                        const std::vector<std::size_t>& common,
                                        const std::vector<std::size_t>& extra,
                                        const std::vector<double>& residual_weights,
                                        bool local,
                                        const HeldOutOptions& options = {});

/// Linear about its own fit: side 0 is the residual, `columns` the sides of what is fitted to it.
struct LinearModel {
  const Innovations& innovations;
  std::vector<std::size_t> columns;
};
/// Of two models, each linear about its own fit, of the same rows and noise: for causes that bend
/// the readings so much that the model without one is not on the straight line from that with it.
[[nodiscard]] HeldOutGain held_out_gain(const LinearModel& without,
                                        const LinearModel& with,
                                        bool local,
                                        const HeldOutOptions& options = {});

}  // namespace roadbook
