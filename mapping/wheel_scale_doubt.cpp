#include "mapping/wheel_scale_doubt.hpp"

#include <cmath>

#include "base/format.hpp"

namespace roadbook {

std::optional<Problem> doubt_of_wheel_scale(const Session& session,
                                            double prior_sigma,
                                            const std::filesystem::path& drive) {
  constexpr double kLeast = 0.01;
  constexpr double kStandardErrors = 4.0;
  const double sigma = session.wheel_scale_sigma;
  if (session.scale_source != ScaleSource::kWheels || !(sigma > 0.0) || !(sigma < prior_sigma))
    return std::nullopt;
  // The estimate is the mean of the data and of the prior, weighed by their information.
  const double share_of_data = 1.0 - sigma * sigma / (prior_sigma * prior_sigma);
  const double error = (session.wheel_scale - 1.0) / share_of_data;
  const double standard_error = sigma / std::sqrt(share_of_data);
  if (std::abs(error) < kLeast || std::abs(error) < kStandardErrors * standard_error)
    return std::nullopt;
  return Problem{Severity::kWarning,
                 (drive / "wheels0").string(),
                 0,
                 "radius",
                 "wheels that look " + fixed(100.0 * std::abs(error), 1) + " % too " +
                     (error > 0.0 ? "small" : "large") + " (+- " +
                     fixed(100.0 * standard_error, 1) + " %)",
                 "the radii of its sensor.yaml; `roadbook calibrate` measures them"};
}

}  // namespace roadbook
