#pragma once

#include <cstdint>
#include <vector>

#include "diagnosis/logs/plain_streams.hpp"
#include "tests/diagnosis/planar_car.hpp"

namespace roadbook::test {

// A receiver of satellites: positions with decimetres to metres of noise, `every` tenth of a
// second, and no heading.
inline MotionStreams with_rough_positions(std::uint64_t seed, double noise_m, std::size_t every) {
  PlanarCarOptions options;
  options.position_m = noise_m;
  MotionStreams streams = PlanarCar(seed).record(options);
  std::vector<PoseSample> kept;
  for (std::size_t i = 0; i < streams.poses.size(); i += every) kept.push_back(streams.poses[i]);
  streams.poses = kept;
  derive_course(streams.poses, 1.0);
  streams.poses_have_heading = false;
  return streams;
}

}  // namespace roadbook::test
