#include "diagnosis/views/corner_errors.hpp"

#include <cmath>

#include "base/index.hpp"

namespace roadbook {
namespace {

constexpr double kCornersErr = 0.12;  // [px], root mean square

}  // namespace

CornerErrors::CornerErrors(const ViewData& data, const ViewNoise& noise)
    : of_camera_(data.bundle.cameras.size(), 0.0) {
  for (const BundleObservation& o : data.bundle.observations)
    of_camera_[at(o.camera)] +=
        2.0 * std::pow(kCornersErr / (noise.pixel[at(o.camera)] * o.sigma_px), 2);
}

double CornerErrors::hide_of_rig() const {
  // The size of a rig effect is the mean of the cameras' sizes, weighted by their share of all
  // views.
  double sum = 0.0;
  double squares = 0.0;
  for (const double h : of_camera_) {
    sum += h;
    squares += h * h;
  }
  return sum > 0.0 ? squares / sum : 0.0;
}

double CornerErrors::hide(const ViewCause& cause, const ViewBasis& basis) const {
  const std::size_t column = cause.columns.front();
  if (column >= basis.wheels()) return 0.0;
  if (cause.columns.size() == 1) return hide(column / basis.per_camera());
  // Wheels and ground determine where the rig as a whole is, how it is turned, and its latency.
  const bool as_one_body = cause.name == "cam.position" || cause.name == "cam.lateral" ||
                           cause.name == "cam.height" || cause.name == "cam.latency" ||
                           cause.name.starts_with("rig.");
  return as_one_body ? 0.0 : hide_of_rig();
}

}  // namespace roadbook
