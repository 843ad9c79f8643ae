#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "drive/drive.hpp"
#include "semantics/detector/gp_laplace.hpp"
#include "semantics/overhead/ground_model.hpp"
#include "semantics/overhead/visible_ground.hpp"
#include "semantics/people/person_oracle.hpp"
#include "semantics/people/person_place.hpp"
#include "workflows/people/detections.hpp"
#include "workflows/people/people_truth.hpp"

namespace roadbook {

struct PeopleDetectOptions {
  double every_s = 0.4;  ///< time between two searched instants
  /// The least probability of a sighting that counts. Empty: the probability at which a window is
  /// as likely to be a person as not, given the share of people among the examples (0.5 before the
  /// prior of searches is known).
  std::optional<double> min_probability;
  std::size_t batch = 6;                   ///< instants of a round of learning
  std::optional<VehicleMeasures> vehicle;  ///< overrides the measures stored in the map
  PersonLearnerOptions learner;
  PersonOracleOptions oracle;
  PersonPlaceOptions place;
  VisibleGroundOptions visible;

  PeopleDetectOptions();
  [[nodiscard]] double least_probability(const GpClassifier& classifier) const {
    return min_probability.value_or(logistic(classifier.shift()));
  }
};

/// Comparison of detections with the truth of a simulated drive, for people within range and in
/// sight.
struct PeopleScore {
  std::size_t people = 0;
  std::size_t right = 0;
  std::size_t wrong = 0;
  std::vector<double> foot_error_m;  ///< of the correct detections
  std::vector<double> mahalanobis2;  ///< of their feet, 2 degrees of freedom
  /// For each detection: the probability of the classifier, and whether a person was there.
  std::vector<std::pair<double, bool>> said;
  [[nodiscard]] double precision() const;  ///< NaN if nothing was found: null in JSON
  [[nodiscard]] double recall() const;     ///< NaN if no person was there
  [[nodiscard]] double median_error_m() const;
  /// Expected calibration error over ten bins of probability.
  [[nodiscard]] double calibration_error() const;
  void add(const PeopleScore& other);
};

/// Compares the detections at one instant (`people`, merged) with the true people.
[[nodiscard]] PeopleScore score_instant(const std::vector<PlacedPerson>& people,
                                        const PeopleTruth::Instant& truth,
                                        double same_overlap);

/// One session of the map with its drive, for learning and detecting people in its images.
class PeopleSession {
 public:
  PeopleSession(const Map& map,
                int session,
                const Drive& drive,
                const GroundModel& ground,
                const PeopleDetectOptions& options);

  [[nodiscard]] const std::vector<PersonCamera>& cameras() const { return cameras_; }
  /// Runs rounds of learning over the session's instants, with the truth as labeller.
  std::vector<PersonRound> play(const PeopleTruth& truth,
                                PersonLearner& learner,
                                PersonRound total,
                                const Progress& progress) const;
  /// Detects people. Fills `score` if `truth` is not null.
  [[nodiscard]] SessionSightings find(const PersonLearner& learner,
                                      const PeopleTruth* truth,
                                      PeopleScore* score,
                                      const Progress& progress) const;

 private:
  struct Instant {
    std::size_t frame = 0;
    std::int64_t t_ns = 0;
    Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  };
  [[nodiscard]] PeopleFrame read(const Instant& instant) const;

  const Map& map_;
  int session_;
  const Drive& drive_;
  const GroundModel& ground_;
  PeopleDetectOptions options_;
  std::vector<PersonCamera> cameras_;
  std::vector<Instant> instants_;
};

}  // namespace roadbook
