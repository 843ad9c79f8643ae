#include "speedmap/property_map/carry_over.hpp"

#include "base/error.hpp"

namespace roadbook {

CarriedMap carry_over(const PropertyMap& map,
                      const PlaceMove& move,
                      std::optional<double> period_m) {
  std::vector<PathPlace> places;
  std::vector<std::size_t> knots;
  for (std::size_t l = 0; l < map.knots().size(); ++l)
    if (const auto place = move(map.knots().places()[l])) {
      places.push_back(*place);
      knots.push_back(l);
    }
  if (knots.empty()) throw Refused("error: knots: got none on the new path, want some");
  CarriedMap carried{PropertyMap(Knots(std::move(places), map.knots().width(), period_m),
                                 map.prior(), map.options()),
                     map.knots().size() - knots.size()};
  for (std::size_t i = 0; i < knots.size(); ++i)
    carried.map.set_belief(i, map.belief(knots[i]), map.knot_evidence(knots[i]));
  for (std::size_t property = 0; property < map.prior().properties.size(); ++property)
    carried.map.set_property(property, map.property(property));
  return carried;
}

}  // namespace roadbook
