#pragma once

#include <filesystem>
#include <functional>

#include "drive/problem_list.hpp"
#include "drive/readings.hpp"
#include "drive/stamps.hpp"
#include "drive/stream_summary.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// The data.csv files of a drive, streamed row by row. Every function checks the whole table, adds
// its faults to `problems`, and calls `visit` for each good row, in order. An empty table is an
// error.

template <typename Row>
using RowVisitor = std::function<void(const Row&)>;

/// Cumulative angles, speeds or ticks of the rear wheels, whatever the header names; speeds are
/// integrated (trapezoids), ticks divided by the model's ticks a turn.
StreamSummary read_wheel_table(const std::filesystem::path& file,
                               const WheelModel& model,
                               const StampLimits& limits,
                               ProblemList& problems,
                               const RowVisitor<WheelReading>& visit);

/// EuRoC's state_groundtruth_estimate0: by position, 8 or 17 columns, quaternion w first.
StreamSummary read_truth_table(const std::filesystem::path& file,
                               ProblemList& problems,
                               const RowVisitor<TimedPose>& visit);

StreamSummary read_imu_table(const std::filesystem::path& file,
                             const StampLimits& limits,
                             ProblemList& problems,
                             const RowVisitor<ImuReading>& visit);

StreamSummary read_friction_table(const std::filesystem::path& file,
                                  const StampLimits& limits,
                                  ProblemList& problems,
                                  const RowVisitor<FrictionReading>& visit);

/// Rows of one instant share their stamp, beams ascending.
StreamSummary read_range_table(const std::filesystem::path& file,
                               const StampLimits& limits,
                               ProblemList& problems,
                               const RowVisitor<RangeReading>& visit);

}  // namespace roadbook
