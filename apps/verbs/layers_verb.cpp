#include <memory>

#include "apps/now_option.hpp"
#include "apps/summaries/layers_summary.hpp"
#include "apps/verb.hpp"
#include "base/wall_clock.hpp"

namespace roadbook {

namespace {

struct OriginOptions {
  std::optional<double> latitude;
  std::optional<double> longitude;
  double x_axis = 0.0;

  [[nodiscard]] std::optional<GeoOrigin> origin() const {
    if (latitude.has_value() != longitude.has_value())
      throw InvalidOption("--latitude-deg and --longitude-deg", "one of them", "both");
    if (!latitude) return std::nullopt;
    return GeoOrigin{*latitude, *longitude, x_axis};
  }
};

}  // namespace

Verb layers_verb() {
  auto command = std::make_shared<ItemsRequest>();
  auto origin = std::make_shared<OriginOptions>();
  auto now = std::make_shared<std::string>();
  return {"layers", "puts road works, queues, vehicles and weather into a map and lists their ages",
          [=](Options& options) {
            options.add("--map,-m", &command->map, "map file").required = true;
            options.add("--put", &command->put, "GeoJSON file of items to add");
            options.add("--map-coordinates", &command->map_coordinates,
                        "the file has x, y in metres of the map frame, not degrees");
            options.add("--latitude-deg", &origin->latitude,
                        "place of the map's origin, WGS84; default: as the map knows it");
            options.add("--longitude-deg", &origin->longitude, "place of the map's origin, WGS84");
            options.add("--x-axis-deg", &origin->x_axis,
                        "direction of the map's x axis, counter-clockwise from east");
            options.add("--now", now.get(),
                        "time for which ages count (UTC); without: the clock of this machine");
            options.add("--expire", &command->expire, "mark stale items as no longer used");
          },
          [=](Console& console, const CommonOptions&) {
            command->origin = origin->origin();
            command->now_ns = now_option(*now).value_or(wall_clock_ns());
            print_items(console, map_items(*command), command->now_ns);
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
