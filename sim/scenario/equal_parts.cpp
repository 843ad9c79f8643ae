#include "sim/scenario/equal_parts.hpp"

#include <cmath>
#include <string>

namespace roadbook {
namespace {

// Adds the further bays' copies of what has its middle in the first bay.
template <typename Item, typename Middle, typename Move>
void copy_into_bays(const BaySpec& bays,
                    const Middle& middle,
                    const Move& move,
                    std::vector<Item>& items) {
  const std::size_t own = items.size();
  for (int bay = 1; bay < bays.count; ++bay)
    for (std::size_t i = 0; i < own; ++i) {
      if (bays.bay_of(middle(items[i])) != 0) continue;
      Item copy = items[i];
      copy.copy_of = static_cast<int>(i);
      move(copy, bay, Eigen::Vector2d(bay * bays.step_m(), 0.0));
      items.push_back(std::move(copy));
    }
}

}  // namespace

StoreySpec read_storeys(const YamlReader& in) {
  in.only({"count", "height", "ramp_from", "ramp_to", "ramp_width"});
  StoreySpec s;
  s.count = in.integer("count", s.count, 2, 9);
  s.height_m = in.number("height", s.height_m, 2.2, 20.0);
  s.ramp_from = in.at("ramp_from").point();
  s.ramp_to = in.at("ramp_to").point();
  s.ramp_width_m = in.number("ramp_width", s.ramp_width_m, 2.0, 20.0);
  const Eigen::Vector2d along = (s.ramp_to - s.ramp_from).cwiseAbs();
  if (along.minCoeff() > 0.0) in.at("ramp_to").fail("a slanting ramp", "a ramp along x or y");
  if (along.maxCoeff() < 3.0 * s.height_m)
    in.at("ramp_to").fail("a ramp steeper than 1 in 3", "a longer ramp");
  return s;
}

void require_ceiling(const YamlReader& in, const Scenario& scenario) {
  const bool fits = scenario.ceiling && scenario.ground.storeys &&
                    scenario.ceiling->height_m < scenario.ground.storeys->height_m;
  if (!fits) in.fail("no ceiling below the next floor", "'ceiling' with a height below 'height'");
}

BaySpec read_bays(const YamlReader& in, const GroundSpec& ground) {
  in.only({"low", "high", "count"});
  BaySpec bays;
  bays.low = in.at("low").point();
  bays.high = in.at("high").point();
  bays.count = in.integer("count", bays.count, 2, 1000);
  if ((bays.high - bays.low).minCoeff() < 1.0)
    in.at("high").fail("a bay without area", "a corner at least 1 m beyond 'low'");
  const double texels = bays.step_m() / ground.texel_m;
  if (std::abs(texels - std::round(texels)) > 1e-6)
    in.at("high").fail(std::to_string(texels) + " texels of the ground along x", "a whole number");
  return bays;
}

void fill_bays(Scenario& scenario) {
  const auto between = [](const auto& item) {
    return Eigen::Vector2d(0.5 * (item.from + item.to));
  };
  const auto move = [](auto& item, int, const Eigen::Vector2d& by) {
    item.from += by;
    item.to += by;
  };
  copy_into_bays(
      *scenario.bays, between,
      [&](SpaceRowSpec& row, int bay, const Eigen::Vector2d& by) {
        row.name += "." + std::to_string(bay + 1);
        move(row, bay, by);
      },
      scenario.rows);
  copy_into_bays(*scenario.bays, between, move, scenario.walls);
  copy_into_bays(
      *scenario.bays, [](const BlockSpec& block) { return block.at; },
      [](BlockSpec& block, int, const Eigen::Vector2d& by) { block.at += by; }, scenario.blocks);
}

}  // namespace roadbook
