#pragma once

#include <cstdint>
#include <vector>

#include "diagnosis/views/view_prediction.hpp"

namespace roadbook {

// Outlier rejection and weights of views.

/// The data with only those observations that are marked 1 in `good`; their order stays.
[[nodiscard]] ViewData kept_views(const ViewData& data, const std::vector<std::uint8_t>& good);

/// Distance of every observation from its prediction at `point` [px]; negative if the landmark
/// cannot be projected.
[[nodiscard]] std::vector<double> view_errors_px(const ViewData& data,
                                                 const ViewBasis& basis,
                                                 const ViewPoint& point,
                                                 int num_threads);

/// Marks (1) the observations whose error is below `gate` standard deviations of their camera.
[[nodiscard]] std::vector<std::uint8_t> views_within(const std::vector<double>& errors,
                                                     const ViewData& data,
                                                     double gate,
                                                     const std::vector<double>& sigma_px);

/// Sets the weight of every view by the Student t noise model of its camera. Marks (1) the views
/// that are used: those within the gate, on consistent landmarks.
[[nodiscard]] std::vector<std::uint8_t> weigh_views(const std::vector<double>& errors,
                                                    const std::vector<double>& sigma_px,
                                                    const std::vector<double>& freedom,
                                                    ViewData& all);

}  // namespace roadbook
