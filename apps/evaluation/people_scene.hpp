#pragma once

#include <memory>
#include <string>
#include <vector>

#include "semantics/overhead/ground_model.hpp"
#include "semantics/people/person_oracle.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/world/moving.hpp"
#include "speedmap/presence/visit_evidence.hpp"
#include "workflows/people/people_truth.hpp"

namespace roadbook {

/// A visit to a simulated place, instant by instant, with all people. It allows an evaluation of
/// the detector of people without rendering and mapping a whole drive.
class PeopleScene {
 public:
  /// `place`: a built-in scenario; `seed`: for people, driver and noise.
  PeopleScene(const std::string& place,
              const ScenarioOptions& options,
              std::uint64_t seed,
              int num_threads);
  ~PeopleScene();

  struct Instant {
    PeopleFrame frame;
    PeopleTruth::Instant there;
    Eigen::Isometry3d T_world_vehicle = Eigen::Isometry3d::Identity();
  };

  [[nodiscard]] double duration_s() const;
  [[nodiscard]] const std::vector<PersonCamera>& cameras() const;
  [[nodiscard]] GroundModel ground() const;
  /// Returns all people within `kListedRange` times `range_m` of a camera, as each camera sees
  /// them. A person is clear if the distance is at most `range_m` and three quarters of the body
  /// are in the picture.
  [[nodiscard]] Instant at(double t_s, double range_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbook
