#include "diagnosis/logs/plain_units.hpp"

#include <array>
#include <numbers>

namespace roadbook {
namespace {

struct Entry {
  Quantity quantity;
  std::string_view name;
  Unit unit;
};

constexpr double kRadPerDegree = std::numbers::pi / 180.0;
constexpr double kKmh = 1.0 / 3.6;
using W = WheelUnit;
using Q = Quantity;

constexpr std::array kUnits{
    Entry{Q::kTime, "s", {1.0}},
    Entry{Q::kTime, "ms", {1e-3}},
    Entry{Q::kTime, "us", {1e-6}},
    Entry{Q::kTime, "ns", {1e-9}},
    Entry{Q::kLength, "m", {1.0}},
    Entry{Q::kLength, "cm", {1e-2}},
    Entry{Q::kLength, "mm", {1e-3}},
    Entry{Q::kAngle, "rad", {1.0}},
    Entry{Q::kAngle, "deg", {kRadPerDegree}},
    Entry{Q::kAngle, "ticks", {1.0, W::kTicks, false, true}},
    Entry{Q::kSpeed, "m/s", {1.0}},
    Entry{Q::kSpeed, "km/h", {kKmh}},
    Entry{Q::kTurnRate, "rad/s", {1.0}},
    Entry{Q::kTurnRate, "deg/s", {kRadPerDegree}},
    Entry{Q::kTurnRate, "rad/row", {1.0, W::kAngle, true}},
    Entry{Q::kWheel, "rad", {1.0, W::kAngle}},
    Entry{Q::kWheel, "deg", {kRadPerDegree, W::kAngle}},
    Entry{Q::kWheel, "ticks", {1.0, W::kTicks, false, true}},
    Entry{Q::kWheel, "rad/row", {1.0, W::kAnglePerRow, true}},
    Entry{Q::kWheel, "deg/row", {kRadPerDegree, W::kAnglePerRow, true}},
    Entry{Q::kWheel, "ticks/row", {1.0, W::kAnglePerRow, true, true}},
    Entry{Q::kWheel, "m", {1.0, W::kLength}},
    Entry{Q::kWheel, "m/row", {1.0, W::kLengthPerRow, true}},
    Entry{Q::kWheel, "rad/s", {1.0, W::kTurnRate}},
    Entry{Q::kWheel, "deg/s", {kRadPerDegree, W::kTurnRate}},
    Entry{Q::kWheel, "m/s", {1.0, W::kSpeed}},
    Entry{Q::kWheel, "km/h", {kKmh, W::kSpeed}},
    Entry{Q::kNumber, "1", {1.0}},
};

}  // namespace

std::optional<Unit> find_unit(Quantity quantity, std::string_view name) {
  for (const Entry& e : kUnits)
    if (e.quantity == quantity && e.name == name) return e.unit;
  return std::nullopt;
}

std::string units_of(Quantity quantity) {
  std::string names;
  for (const Entry& e : kUnits)
    if (e.quantity == quantity) names += (names.empty() ? "one of " : ", ") + std::string(e.name);
  return names;
}

}  // namespace roadbook
