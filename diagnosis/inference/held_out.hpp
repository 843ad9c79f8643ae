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
  double embargo_s = 1.0;     ///< excluded from training on either side of a block
  double interleave_s = 0.8;  ///< length of the short blocks of local causes
};

/// Gain of a model with the columns `with` over one without `extra` of them. Columns are indices of
/// the innovations' right-hand sides; `offset` is the part of each that was subtracted from the
/// residual.
[[nodiscard]] HeldOutGain held_out_gain(const Innovations& innovations,
                                        const std::vector<std::size_t>& common,
                                        const std::vector<std::size_t>& extra,
                                        const std::vector<double>& residual_weights,
                                        bool local,
                                        const HeldOutOptions& options = {});

/// A model linearised about its own fit: right-hand side 0 is the residual, `columns` are those
/// fitted to it.
struct LinearModel {
  const Innovations& innovations;
  std::vector<std::size_t> columns;
};
/// Gain between two models, each linearised about its own fit, of the same rows and noise. For
/// effects in which the readings are so non-linear that the linearised model cannot remove them.
[[nodiscard]] HeldOutGain held_out_gain(const LinearModel& without,
                                        const LinearModel& with,
                                        bool local,
                                        const HeldOutOptions& options = {});

}  // namespace roadbook
