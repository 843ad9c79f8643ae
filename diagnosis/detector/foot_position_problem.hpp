#pragma once

#include <string>
#include <vector>

#include "diagnosis/detector/detector_grammar.hpp"
#include "diagnosis/detector/person_filter.hpp"
#include "diagnosis/detector/person_tracks.hpp"
#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook {

/// Where a detector places people's feet: along and across each line of sight, by person followed.
///
/// No truth is needed: the sightings of one person from several places must agree. What is unknown
/// beside the causes is each person's way; it is projected out by a Kalman filter of the person's
/// place and velocity, through which all columns run. Who stands tells most: a person's own
/// velocity can hide an error that changes as a car at constant speed comes nearer. Each person
/// stands or walks, whichever explains the sightings better.
class FootProblem final : public CauseProblem {
 public:
  FootProblem(const SightingReadings& readings,
              const std::vector<PersonTrack>& tracks,
              LibraryOptions library = {});

  /// Enough people are followed far enough; else `message` says what is missing.
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
  // One sighting of somebody who is followed.
  struct Place {
    Eigen::Vector2d foot, along;       // as read, and the unit vector of the line of sight
    double sigma_along, sigma_across;  // stated
    Eigen::Vector2d by_time;           // change of the foot if it was seen a second earlier
    Eigen::Vector2d eye;               // of the camera
  };
  struct Person {
    std::size_t first = 0, count = 0;  // of places_
    bool stands = false;
  };
  struct Noise {
    double along = 1.0, across = 1.0;  // of the stated standard deviations
    double memory_s = 5.0;             // of a walker's velocity
    double shift = 0.03;               // of anybody's feet
  };
  static constexpr double kWalking = 1.0;  // deviation of a walker's velocity, each axis [m/s]
  static constexpr const char* kName = "detector.foot_point";
  void aim();
  void estimate_noise();
  [[nodiscard]] double over_dispersion(const Eigen::Vector2d& sizes) const;
  [[nodiscard]] double log_likelihood(const Noise& noise, Eigen::Vector2d* sizes) const;
  void tell_who_stands(const Eigen::Vector2d& sizes);
  [[nodiscard]] Eigen::MatrixXd columns(const Candidate& candidate) const;
  [[nodiscard]] Eigen::VectorXd readings() const;
  // One person's rows, two a sighting, whitened in place; those of the first sighting tell nothing.
  double whiten(const Person& person,
                const Noise& noise,
                Eigen::MatrixXd& sides,
                std::vector<double>* variances) const;
  [[nodiscard]] Innovations whitened(Eigen::MatrixXd sides) const;

  LibraryOptions library_;
  std::string message_;
  std::vector<Place> places_;
  std::vector<SightMoment> moments_;  ///< of each place
  std::vector<Person> people_;
  Noise noise_;
  double dispersion_ = 1.0;  ///< variance over that of the model, from the scatter between people
};

}  // namespace roadbook
