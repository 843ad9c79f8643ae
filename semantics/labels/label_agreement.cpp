#include "semantics/labels/label_agreement.hpp"

#include <algorithm>
#include <cmath>

#include "base/median.hpp"

namespace roadbook {
LabelAgreement agreement_of(const Map& map, const std::vector<Label>& labels) {
  LabelAgreement result;
  std::vector<double> sigmas;
  std::vector<double> metres;
  for (const Label& label : labels) {
    const auto own = seen_in_map(map, label);
    if (!own || !is_known(own->covariance) || label.state != LabelState::kActive) continue;
    for (const LabelSighting& sighting : label.sightings) {
      // The sighting as a separate label, anchored to the other image.
      Label other;
      other.anchor = sighting.anchor;
      other.sigma_m = sighting.sigma_m;
      other.T_vehicle_label.translation() = sighting.middle_vehicle;
      const auto place = seen_in_map(map, other);
      if (!place || !is_known(place->covariance)) continue;
      LabelDisagreement found{label.id, sighting.anchor, place->middle - own->middle, 0.0};
      const Eigen::Matrix2d covariance = own->covariance + place->covariance;
      found.sigmas =
          std::sqrt(std::max(0.0, found.apart.dot(covariance.ldlt().solve(found.apart))));
      sigmas.push_back(found.sigmas);
      metres.push_back(found.apart.norm());
      result.sightings.push_back(found);
    }
  }
  if (sigmas.empty()) return result;
  result.median_sigmas = median(sigmas);
  result.median_m = median(metres);
  result.chance = std::exp(-0.5 * result.median_sigmas * result.median_sigmas);
  return result;
}

}  // namespace roadbook
