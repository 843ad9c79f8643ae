#pragma once

#include "diagnosis/friction/friction_columns.hpp"
#include "diagnosis/friction/friction_noise.hpp"
#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook {

/// Friction readings at known places as a problem for the search of effects. Nuisance parameters:
/// the mean of each surface class and, if the noise has one, the spatial bias.
///
/// The problem is linear except for discs of other surfaces, which a fit moves. The noise is
/// estimated with all catalogued effects free and with as many discs as the readings support, so
/// that it absorbs neither.
class FrictionProblem final : public CauseProblem {
 public:
  explicit FrictionProblem(FrictionReadings readings, LibraryOptions library = {});

  [[nodiscard]] std::vector<ChannelName> channels() const override;
  [[nodiscard]] std::size_t rows() const override { return readings_.samples.size(); }
  [[nodiscard]] double level_of_names() const override { return 0.002; }
  /// Errors under force follow the momentary force; the poses give only its mean. Residuals are
  /// therefore correlated, and intervals use the variation between blocks.
  [[nodiscard]] bool intervals_of_blocks() const override { return true; }
  [[nodiscard]] CauseModel nominal() const override;
  [[nodiscard]] std::vector<Candidate> candidates(const CauseModel& model) const override;
  [[nodiscard]] Projection project(const CauseModel& model,
                                   std::vector<Candidate> candidates) const override;
  void fit(CauseModel& model, int iterations) const override;
  void fit_beside(CauseModel& model, int iterations, const SizePrior& others) const override;
  [[nodiscard]] std::vector<Candidate> refinements(const CauseModel& model,
                                                   const Candidate& place) const override;
  /// friction0.spatial_bias, correlation, outliers, variance(speed), variance(turn).
  [[nodiscard]] std::vector<NoiseCause> noise_causes(const CauseModel& model) const override;
  [[nodiscard]] std::string note(const Accepted& cause) const override;
  [[nodiscard]] RowCovariate covariate(const CauseModel& model,
                                       const Candidate& cause,
                                       const Innovations& innovations) const override;

 private:
  [[nodiscard]] FrictionMean mean_columns(const std::vector<Candidate>& beside) const;
  [[nodiscard]] FrictionNoise nominal_noise() const;
  [[nodiscard]] bool looks_for_surfaces() const { return library_.places && readings_.has_surface; }
  [[nodiscard]] bool left_out(const std::string& name) const;
  [[nodiscard]] FrictionNoise noise_beside(const std::vector<Candidate>& discs, bool places) const;
  [[nodiscard]] Eigen::VectorXd residuals_beside(const std::vector<Candidate>& discs,
                                                 const FrictionNoise& noise,
                                                 std::size_t without) const;
  bool add_disc(std::vector<Candidate>& discs) const;
  bool move_discs(CauseModel& model) const;

  FrictionReadings readings_;
  LibraryOptions library_;
  SurfaceClasses classes_;
  PlaceCells cells_;
  std::shared_ptr<PlaceBases> bases_;
  FrictionNoise noise_;
};

}  // namespace roadbook
