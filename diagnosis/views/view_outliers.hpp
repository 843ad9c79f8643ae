#pragma once

#include <cstdint>
#include <vector>

#include "diagnosis/views/view_prediction.hpp"

namespace roadbook {

// Which views count, and how much.

/// The data with the observations marked (1: good), in order.
[[nodiscard]] ViewData kept_views(const ViewData& data, const std::vector<std::uint8_t>& good);

/// Distance of every observation from where the point predicts it [px]; negative where it cannot.
[[nodiscard]] std::vector<double> view_errors_px(const ViewData& data,
                                                 const ViewBasis& basis,
                                                 const ViewPoint& point,
                                                 int num_threads);

/// Marks the observations whose error is below `gate` standard deviations of their camera.
[[nodiscard]] std::vector<std::uint8_t> views_within(const std::vector<double>& errors,
                                                     const ViewData& data,
                                                     double gate,
                                                     const std::vector<double>& sigma_px);

/// Gives every view its weight by Student's noise of its camera; marks those that count: within the
/// gate, of landmarks that hold together.
[[nodiscard]] std::vector<std::uint8_t> weigh_views(const std::vector<double>& errors,
                                                    const std::vector<double>& sigma_px,
                                                    const std::vector<double>& freedom,
                                                    ViewData& all);

}  // namespace roadbook
