#include "mapping/optimisation/bundle_adjustment_check.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kMostProblems = 20;

// Gathers faults; a field is named "observations[17].pose".
class Faults {
 public:
  void index(const char* list, std::size_t item, const char* field, int got, std::size_t size) {
    if (got >= 0 && static_cast<std::size_t>(got) < size) return;
    add(list, item, field, std::to_string(got), "0.." + std::to_string(size) + " (exclusive)");
  }
  void optional_index(
      const char* list, std::size_t item, const char* field, int got, std::size_t n) {
    if (got >= 0) index(list, item, field, got, n);
  }
  void finite(const char* list, std::size_t item, const char* field, const auto& value) {
    if (!value.allFinite()) add(list, item, field, "not finite", "finite numbers");
  }
  void positive(const char* list, std::size_t item, const char* field, double value) {
    if (!std::isfinite(value) || value <= 0.0)
      add(list, item, field, std::to_string(value), "a positive number");
  }
  void finish() {
    if (!problems_.empty()) throw BadInput(problems_);
  }

 private:
  void add(const char* list,
           std::size_t item,
           const char* field,
           const std::string& got,
           const std::string& want) {
    if (problems_.size() >= kMostProblems) return;
    Problem problem;
    problem.field = std::string(list) + "[" + std::to_string(item) + "]." + field;
    problem.got = got;
    problem.want = want;
    problems_.push_back(problem);
  }
  std::vector<Problem> problems_;
};

void check_constraints(const BundleProblem& problem, Faults& faults) {
  for (std::size_t i = 0; i < problem.motions.size(); ++i) {
    const MotionConstraint& m = problem.motions[i];
    faults.index("motions", i, "from", m.from, problem.poses.size());
    faults.index("motions", i, "to", m.to, problem.poses.size());
    faults.optional_index("motions", i, "scale", m.scale, problem.scales.size());
    faults.finite("motions", i, "T_from_to", m.T_from_to.matrix());
    faults.finite("motions", i, "information", m.information);
  }
  for (std::size_t i = 0; i < problem.priors.size(); ++i) {
    const PosePrior& prior = problem.priors[i];
    faults.index("priors", i, "pose", prior.pose, problem.poses.size());
    faults.finite("priors", i, "T_map_vehicle", prior.T_map_vehicle.matrix());
    faults.finite("priors", i, "information", prior.information);
  }
  for (std::size_t i = 0; i < problem.scales.size(); ++i) {
    faults.positive("scales", i, "value", problem.scales[i].value);
    faults.positive("scales", i, "prior", problem.scales[i].prior);
    faults.positive("scales", i, "prior_sigma", problem.scales[i].prior_sigma);
  }
}

}  // namespace

void check_bundle(const BundleProblem& problem) {
  Faults faults;
  for (std::size_t i = 0; i < problem.poses.size(); ++i)
    faults.finite("poses", i, "T_map_vehicle", problem.poses[i].T_map_vehicle.matrix());
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    const BundlePoint& point = problem.points[i];
    faults.finite("points", i, "p_map", point.p_map);
    if (point.ground)
      faults.optional_index("points", i, "ground_pose", point.ground_pose, problem.poses.size());
  }
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    const BundleObservation& o = problem.observations[i];
    faults.index("observations", i, "pose", o.pose, problem.poses.size());
    faults.index("observations", i, "point", o.point, problem.points.size());
    faults.index("observations", i, "camera", o.camera, problem.cameras.size());
    faults.finite("observations", i, "pixel", o.pixel);
    faults.positive("observations", i, "sigma_px", o.sigma_px);
  }
  check_constraints(problem, faults);
  faults.finish();
}

}  // namespace roadbook
