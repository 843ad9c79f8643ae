#pragma once

#include <string>
#include <vector>

#include "diagnosis/detector/detector_grammar.hpp"
#include "diagnosis/detector/person_filter.hpp"
#include "diagnosis/detector/person_tracks.hpp"
#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook {

/// Ground positions of a pedestrian detector, along and across each line of sight, as a problem for
/// the search of effects.
///
/// No ground truth is needed: detections of one pedestrian from several vehicle positions must
/// agree. The path of each pedestrian is the nuisance parameter. A Kalman filter of position and
/// velocity projects it out; all columns pass through the same filter. Standing pedestrians
/// contribute most, because a walker's velocity can hide a bias that changes as the car approaches.
/// Each pedestrian stands or walks, whichever is more likely.
class FootPositionProblem final : public CauseProblem {
 public:
  FootPositionProblem(const SightingReadings& readings,
                      const std::vector<PersonTrack>& tracks,
                      LibraryOptions library = {});

  /// True if enough pedestrians were tracked long enough; else `message` says what is missing.
  [[nodiscard]] bool usable() const { return message_.empty(); }
  [[nodiscard]] const std::string& message() const { return message_; }

  [[nodiscard]] std::vector<ChannelName> channels() const override;
  [[nodiscard]] std::size_t rows() const override { return 2 * places_.size(); }
  [[nodiscard]] CauseModel nominal() const override;
  [[nodiscard]] std::vector<Candidate> candidates(const CauseModel& model) const override;
  [[nodiscard]] Projection project(const CauseModel& model,
                                   std::vector<Candidate> candidates) const override;
  void fit(CauseModel& model, int iterations) const override;
  void fit_beside(CauseModel& model, int iterations, const SizePrior& others) const override;
  [[nodiscard]] std::string note(const Accepted& cause) const override;
  [[nodiscard]] RowCovariate covariate(const CauseModel& model,
                                       const Candidate& cause,
                                       const Innovations& innovations) const override;

 private:
  // One detection of a tracked pedestrian.
  struct Place {
    Eigen::Vector2d foot, along;       // detected position; unit vector of the line of sight
    double sigma_along, sigma_across;  // stated
    Eigen::Vector2d by_time;           // derivative of the position by the detector's latency
    Eigen::Vector2d eye;               // position of the camera
  };
  struct Person {
    std::size_t first = 0, count = 0;  // of places_
    bool stands = false;
  };
  struct Noise {
    double along = 1.0, across = 1.0;  // factors on the stated standard deviations
    double memory_s = 5.0;             // correlation time of a walker's velocity
    double shift = 0.03;               // random walk of the ground position [m after 1 s]
  };
  static constexpr double kWalking =
      1.0;  // standard deviation of a walker's velocity, each axis [m/s]
  static constexpr const char* kName = "detector.foot_point";
  void aim();
  void estimate_noise();
  [[nodiscard]] double over_dispersion(const Eigen::Vector2d& sizes) const;
  [[nodiscard]] double log_likelihood(const Noise& noise, Eigen::Vector2d* sizes) const;
  void classify_standing(const Eigen::Vector2d& sizes);
  [[nodiscard]] Eigen::MatrixXd columns(const Candidate& candidate) const;
  [[nodiscard]] Eigen::VectorXd readings() const;
  // Whitens the rows of one pedestrian in place, two a detection; the first detection has no
  // information.
  double whiten(const Person& person,
                const Noise& noise,
                Eigen::MatrixXd& sides,
                std::vector<double>* variances) const;
  [[nodiscard]] Innovations whitened(Eigen::MatrixXd sides) const;

  LibraryOptions library_;
  std::string message_;
  std::vector<Place> places_;
  std::vector<DetectionContext> moments_;  ///< of each place
  std::vector<Person> people_;
  Noise noise_;
  double dispersion_ = 1.0;  ///< variance between pedestrians over that of the model
};

}  // namespace roadbook
