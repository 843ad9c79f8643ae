#include "speedmap/property_map/property_mapper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.hpp"

namespace roadbook {

void RefreshOptions::check() const {
  classes.check();
  const auto positive = [](double x, const char* field) {
    if (!(std::isfinite(x) && x > 0.0))
      throw InvalidOption(field, std::to_string(x), "a number above 0");
  };
  positive(early_every_m, "early_every_m");
  positive(every_m, "every_m");
  if (!(drop_nat >= 0.0)) throw InvalidOption("drop_nat", std::to_string(drop_nat), "0 or more");
  if (drop_values < 1) throw InvalidOption("drop_values", std::to_string(drop_values), "1 or more");
  if (log_size < 1) throw InvalidOption("log_size", "0", "1 or more");
}

PropertyMapper::PropertyMapper(PropertyMap map, RefreshOptions options)
    : map_(std::move(map)),
      options_(options),
      logs_(map_.prior().properties.size()),
      next_m_(options.early_every_m) {
  options_.check();
}

PropertyUpdateResult PropertyMapper::add_value(std::size_t property,
                                               const PathPlace& v,
                                               double y,
                                               double sigma) {
  const PropertyUpdateResult result = map_.add_value(property, v, y, sigma);
  if (result.status == PropertyUpdate::kUncovered) return result;
  Log& log = logs_[property];
  // A quarter at once, so that dropping costs little per measurement.
  if (log.entries.size() >= options_.log_size)
    log.entries.erase(log.entries.begin(),
                      log.entries.begin() + static_cast<std::ptrdiff_t>(
                                                std::max<std::size_t>(1, options_.log_size / 4)));
  log.entries.push_back({v, y, sigma});
  if (result.status == PropertyUpdate::kDone) watch(log, result.log_evidence);
  return result;
}

void PropertyMapper::watch(Log& log, double log_evidence) {
  log.recent += log_evidence;
  if (++log.recent_count < options_.drop_values) return;
  const double mean = log.recent / log.recent_count;
  log.recent = 0.0;
  log.recent_count = 0;
  if (log.has_best && options_.drop_nat > 0.0 && mean < log.best - options_.drop_nat) due_ = true;
  log.best = log.has_best ? std::max(log.best, mean) : mean;
  log.has_best = true;
}

bool PropertyMapper::travelled(double distance_m) {
  if (!options_.enabled) return false;
  if (distance_m < next_m_ && !due_) return false;
  while (next_m_ <= distance_m)
    next_m_ += next_m_ < options_.early_until_m ? options_.early_every_m : options_.every_m;
  refresh();
  return true;
}

void PropertyMapper::refresh() {
  for (std::size_t property = 0; property < logs_.size(); ++property) refresh(property);
  due_ = false;
  ++refreshes_;
}

void PropertyMapper::refresh(std::size_t property) {
  Log& log = logs_[property];
  std::vector<double> values;
  std::vector<double> sigmas;
  std::vector<double> weights;
  std::array<double, kMaxPropertyClasses> shares;
  const std::span<double> u(shares.data(), map_.classes());
  for (const Entry& entry : log.entries) {
    if (map_.evidence(entry.v) < map_.options().gate_counts) continue;
    if (!map_.class_shares(entry.v, u)) continue;
    values.push_back(entry.y);
    sigmas.push_back(entry.sigma);
    weights.insert(weights.end(), u.begin(), u.end());
  }
  log.has_best = false;
  if (values.empty()) return;
  const PropertyPrior& prior = map_.prior().properties[property];
  ClassRefreshOptions options = options_.classes;
  options.outlier_weight = map_.options().outlier_weight;
  options.outlier_density = 1.0 / (prior.max - prior.min);
  map_.set_property(property, refresh_classes(values, weights, prior.classes, options, sigmas));
}

}  // namespace roadbook
