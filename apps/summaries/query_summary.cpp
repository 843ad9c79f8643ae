#include "apps/summaries/query_summary.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/summaries/layers_summary.hpp"
#include "base/error.hpp"
#include "base/format.hpp"
#include "base/text.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

ordered_json value_json(const SmoothValue& value) {
  return {{"value", value.value},
          {"sigma", std::sqrt(value.variance)},
          {"d_ds", value.gradient.x()},
          {"d_de", value.gradient.y()}};
}

// Returns mean and variance of the next measurement, and their change along s and e.
ordered_json property_json(const LaneQueries& known, const LanePlace& place) {
  ordered_json json = ordered_json::object();
  if (!known.friction()) return json;
  const PropertyMap& map = known.friction()->map;
  for (std::size_t k = 0; k < map.prior().properties.size(); ++k) {
    const auto at = map.moments_with_derivatives(k, {place.strip->begin_m + place.s_m, place.e_m});
    const PropertyPrior& about = map.prior().properties[k];
    if (at)
      json[about.name] = {{"unit", about.unit},
                          {"value", at->mean},
                          {"sigma", std::sqrt(at->variance)},
                          {"d_ds", at->d_mean.x()},
                          {"d_de", at->d_mean.y()},
                          {"variance_d_ds", at->d_variance.x()},
                          {"variance_d_de", at->d_variance.y()}};
    else
      json[about.name] = nullptr;
  }
  return json;
}

ordered_json ground_json(const LaneQueries& known, const PathAnswer& answer) {
  ordered_json json = ordered_json::object();
  for (std::size_t i = 0; i < answer.ground_shares.size(); ++i)
    json[known.friction()->map.prior().classes[i]] = answer.ground_shares[i];
  return json;
}

const char* to_text(SpeedLimitedBy by) {
  switch (by) {
    case SpeedLimitedBy::kLaw:
      return "limit";
    case SpeedLimitedBy::kBend:
      return "bend";
    case SpeedLimitedBy::kMotion:
      return "braking";
    case SpeedLimitedBy::kPedestrian:
      return "people";
    case SpeedLimitedBy::kGrip:
      return "grip";
    case SpeedLimitedBy::kItem:
      return "item";
  }
  return "";
}

ordered_json occupancy_json(const std::optional<OccupancyAnswer>& occupancy) {
  if (!occupancy) return nullptr;
  ordered_json json = value_json(occupancy->probability);
  json["age_s"] = std::isnan(occupancy->age_s) ? ordered_json() : ordered_json(occupancy->age_s);
  return json;
}

ordered_json labels_json(const PathAnswer& answer) {
  if (!answer.labels) return nullptr;
  ordered_json labels = ordered_json::array();
  for (const LabelNearby& near : *answer.labels) {
    const LabelledOutline& label = *near.label;
    labels.push_back(
        {{"id", label.id ? ordered_json(*label.id) : ordered_json()},
         {"class", label.kind},
         {"distance_m", near.distance.value},
         {"sigma_m", std::isnan(label.sigma_m) ? ordered_json() : ordered_json(label.sigma_m)},
         {"d_ds", near.distance.gradient.x()},
         {"d_de", near.distance.gradient.y()}});
  }
  return labels;
}

// The items that hold at the place.
ordered_json items_here(const LaneQueries& known, const PathAnswer& answer) {
  ordered_json items = ordered_json::array();
  const double half_width_m = 0.5 * known.speeds().options.vehicle_width_m;
  for (const LayerItem* item : known.effects().holding(answer.position, half_width_m))
    items.push_back(item_json(*item, known.now_ns()));
  return items;
}

PathAnswer answer_of(const LaneQueries& known, const LanePlace& place) {
  const auto answer = known.of(place.strip->lane).at(place.s_m, place.e_m);
  if (!answer)
    throw InvalidOption("--s and --e", fixed(place.s_m, 3) + "," + fixed(place.e_m, 3),
                        "a place of the lane: s to " + fixed(place.strip->length_m(), 3) +
                            ", e to " + fixed(place.strip->half_width_m, 3) + " on either side");
  return *answer;
}

ordered_json answer_json(const LaneQueries& known,
                         const LanePlace& place,
                         const PathAnswer& answer) {
  ordered_json json{{"lane", std::to_string(answer.lane)},
                    {"s_m", place.s_m},
                    {"e_m", place.e_m},
                    {"x_m", answer.position.x()},
                    {"y_m", answer.position.y()},
                    {"place", roadbook::to_text(answer.place)},
                    {"speed_mps", value_json(answer.speed)},
                    {"limited_by", to_text(answer.limited_by)},
                    {"presence", answer.presence ? value_json(*answer.presence) : ordered_json()}};
  json["properties"] = property_json(known, place);
  json["ground"] = ground_json(known, answer);
  json["occupancy"] = occupancy_json(answer.occupancy);
  json["labels"] = labels_json(answer);
  json["items"] = items_here(known, answer);
  return json;
}

void say_answer(const Console& console, const LanePlace& place, const PathAnswer& answer) {
  std::string line = "lane " + std::to_string(answer.lane) + ", s " + fixed(place.s_m, 2) +
                     " m, e " + fixed(place.e_m, 2) + " m (" + roadbook::to_text(answer.place) +
                     "): " + fixed(answer.speed.value, 2) + " m/s by " + to_text(answer.limited_by);
  if (answer.presence) line += ", presence " + fixed(answer.presence->value, 3);
  if (answer.friction)
    line += ", friction " + fixed(answer.friction->mean, 3) + " +- " +
            fixed(std::sqrt(answer.friction->variance), 3);
  if (answer.occupancy)
    line += ", occupied " + fixed(answer.occupancy->probability.value, 3) + " +- " +
            fixed(std::sqrt(answer.occupancy->probability.variance), 3);
  if (answer.labels && !answer.labels->empty()) {
    const LabelNearby& near = answer.labels->front();
    line += ", " + near.label->kind +
            (near.label->id ? " " + std::to_string(*near.label->id) : "") + " at " +
            fixed(near.distance.value, 2) + " m";
  }
  console.say(line);
}

}  // namespace

void print_answers(const Console& console,
                   const LaneQueries& known,
                   const std::vector<LanePlace>& places) {
  ordered_json answers = ordered_json::array();
  for (const LanePlace& place : places) {
    const PathAnswer answer = answer_of(known, place);
    say_answer(console, place, answer);
    answers.push_back(answer_json(known, place, answer));
  }
  say_stale_items(console, known.items(), known.now_ns());
  const auto date = [](std::int64_t t_ns) { return utc_text(t_ns); };
  console.result(
      {{"map_digest", known.stored().digest},
       {"speed_date_utc", date(known.speeds().date_ns)},
       {"speed_coverage", known.speeds().coverage()},
       {"friction_date_utc",
        known.friction() ? ordered_json(date(known.friction()->date_ns)) : ordered_json()},
       {"items", items_json(known.items(), known.now_ns())},
       {"answers", answers}});
}

}  // namespace roadbook
