#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sensors/wheels.hpp"
#include "vo/keyframe_track.hpp"
#include "vo/wheels/time_span.hpp"

namespace roadbook {

// Comparison of the wheels with odometry of the cameras alone: where they are wrong and by how
// much.

/// A time in which the wheels contradict the cameras by more than four standard deviations.
struct WheelDoubt {
  TimeSpan span;
  double turn_rad = 0.0;  ///< wheels less cameras
  double way_m = 0.0;     ///< wheels less cameras, in the wheels' lengths
};

struct WheelComparison {
  std::vector<WheelDoubt> doubts;  ///< ascending, apart from each other
  double compared_m = 0.0;         ///< way over which the cameras know the motion
  double doubted_m = 0.0;          ///< of it
  double compared_rad = 0.0;       ///< turn over which the cameras know the motion
  double doubted_rad = 0.0;        ///< of it
  /// Median of the turns by the wheels over the turns by the cameras. Empty without turns.
  std::optional<double> turn_factor;
  /// Median of the ways by the wheels over the ways by the cameras, in the cameras' lengths.
  std::optional<double> way_ratio;
  /// Way by the wheels over the way by the cameras, whose scale is their height over the ground.
  /// Empty without enough ground.
  std::optional<double> way_factor;

  /// The wheels are wrong in most of the drive, so that the rest is left out too.
  [[nodiscard]] bool doubts_all() const;
  /// Enough way and turn lies outside the doubts to say that the wheels are right there.
  [[nodiscard]] bool rest_is_useful() const;
};

/// Share of the time in which the vehicle moves over which `sight`, an odometry of the cameras
/// alone, knows the motion. The vehicle moves where the wheels roll or the cameras know a motion.
/// `frames_ns`: stamps of the drive's frames. 1 if it never moves.
[[nodiscard]] double known_share(const VoResult& sight,
                                 const WheelOdometry& wheels,
                                 const std::vector<std::int64_t>& frames_ns);

/// Compares the wheels with the motions of `sight`, an odometry of the cameras alone, over windows
/// of 1, 4 and 16 keyframes. Wheels may be off by what is usual: their noise, 4 % of the turn (1
/// sigma: radii and track) and 5 % of the way. `sight` knows lengths up to a factor that changes
/// slowly: only changes of the ratio over some metres are seen in a window. `ground`: ground_factor
/// of `sight`.
[[nodiscard]] WheelComparison compare_wheels(const VoResult& sight,
                                             const WheelOdometry& wheels,
                                             std::optional<double> ground);

/// Judgement on the wheels in a time in which an odometry did not use them.
struct SpanVerdict {
  TimeSpan span;
  bool is_known = false;    ///< the cameras know the motions in four fifths of it
  bool is_doubted = false;  ///< the wheels differ from them by more than four standard deviations
};

/// Judges times in which `odometry` did not use the wheels, but used them before and after.
/// `recorded`: the wheels without any distrust.
[[nodiscard]] std::vector<SpanVerdict> judge_spans(const std::vector<TimeSpan>& spans,
                                                   const VoResult& odometry,
                                                   const WheelOdometry& recorded);

/// Sizes of the doubts in such times.
[[nodiscard]] WheelComparison compare_wheels_in(const std::vector<TimeSpan>& spans,
                                                const VoResult& odometry,
                                                const WheelOdometry& recorded);

/// Factor on the lengths of `odometry` that puts the ground at the cameras' height below them.
/// Empty if too little ground is seen.
[[nodiscard]] std::optional<double> ground_factor(const VoResult& odometry, double camera_height_m);

}  // namespace roadbook
