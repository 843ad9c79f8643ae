#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/inference/innovations.hpp"
#include "diagnosis/motion/columns.hpp"
#include "diagnosis/motion/elimination.hpp"
#include "diagnosis/streams/motion_effects.hpp"
#include "diagnosis/streams/noise.hpp"
#include "diagnosis/streams/observations.hpp"
#include "diagnosis/streams/trajectory.hpp"

namespace roadbook {

// One pass of elimination over a drive, linearised about a trajectory and effects.

/// The point about which a pass is linearised.
struct MotionPoint {
  Trajectory trajectory;
  MotionEffects effects;
  std::vector<double> residual;  ///< read less predicted, further terms subtracted
};

struct PassOptions {
  bool keep = false;       ///< for back substitution
  std::size_t probes = 0;  ///< random signs that ride along, after the columns
  const std::vector<double>* inflation = nullptr;  ///< of each row's sigma (outliers), or null
};

/// Innovations of wheels: that of reading k is in row k - 1.
struct Pass {
  Innovations innovations;
  Elimination elimination;
  std::size_t wheel_channels = 2;  ///< of distance alone, or of heading as well
};
[[nodiscard]] Pass run_pass(const Observations& obs,
                            const MotionPoint& point,
                            const MotionNoise& noise,
                            const Columns& columns,
                            const PassOptions& options = {});

/// Motion along lines fitted to the poses over 0.6 to 1.5 s; in their gaps dead reckoning from side
/// to side. The poses show the motion `late_s` earlier than their stamps say; the trajectory covers
/// their stamps as well.
[[nodiscard]] Trajectory trajectory_of_lines(const Observations& obs, double late_s = 0.0);

/// First guess: `trajectory_of_lines`; where the poses are too rough for it, the way that wheels
/// and gyro reckon, laid on the poses. That way shows no error of wheels or gyro.
[[nodiscard]] Trajectory trajectory_of_poses(const Observations& obs, double late_s = 0.0);

/// Adds the solution of a pass (its right-hand sides weighted) to the trajectory.
void apply_solution(const Elimination::Solution& solution, Trajectory& trajectory);

/// Noise that explains the innovations of a pass, each kind with its own redundancy. Streams that
/// are read directly use their innovations; random walks use smoothed residuals over the share that
/// the probes leave. Creep stays. `weights` of the right-hand sides give the residual; `fitted[c]`
/// parameters were fitted to the rows of channel c. The pass must have been kept, with probes.
[[nodiscard]] MotionNoise renewed_noise(const MotionNoise& noise,
                                        const Pass& pass,
                                        const std::vector<double>& weights,
                                        std::size_t probes,
                                        const std::array<double, kChannels>& fitted);

}  // namespace roadbook
