#include "apps/friction_config.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/yaml.hpp"

namespace roadbook {

void FrictionConfig::check() const {
  const std::size_t K = classes.size();
  const auto same = [&](std::size_t size, const char* field) {
    if (size != K) throw InvalidOption(field, std::to_string(size), std::to_string(K));
  };
  same(image_values.size(), "image_values");
  same(friction_mean.size(), "friction_mean");
  same(friction_sigma.size(), "friction_sigma");
  for (const double mean : friction_mean)
    if (!(mean >= 0.0 && mean <= 1.5))
      throw InvalidOption("friction_mean", std::to_string(mean), "0 to 1.5");
  for (std::size_t i = 0; i < K; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (classes[i] == classes[j])
        throw InvalidOption("classes", classes[i] + " twice", "each once");
  std::vector<bool> taken(256, false);
  for (const auto& values : image_values) {
    if (values.empty())
      throw InvalidOption("image_values", "an empty list", "a value for each class");
    for (const std::uint8_t value : values) {
      if (taken[value])
        throw InvalidOption("image_values", std::to_string(value) + " twice", "each value once");
      taken[value] = true;
    }
  }
  for (const double sigma : friction_sigma)
    if (!(sigma > 0.0)) throw InvalidOption("friction_sigma", std::to_string(sigma), "above 0");
  prior().check();
  map.check(K);
}

PropertyMapPrior FrictionConfig::prior() const {
  PropertyMapPrior result;
  result.classes = classes;
  result.counts = prior_counts;
  PropertyPrior friction;
  for (std::size_t i = 0; i < classes.size(); ++i)
    // Worth two measurements of the class; alpha = 2 leaves its width open.
    friction.classes.push_back({friction_mean[i], 2.0, 2.0, friction_sigma[i] * friction_sigma[i]});
  result.properties.push_back(std::move(friction));
  return result;
}

std::vector<std::uint8_t> FrictionConfig::class_of_value() const {
  std::vector<std::uint8_t> result(256, static_cast<std::uint8_t>(classes.size()));
  for (std::size_t c = 0; c < image_values.size(); ++c)
    for (const std::uint8_t value : image_values[c]) result[value] = static_cast<std::uint8_t>(c);
  return result;
}

FrictionConfig FrictionConfig::load(const std::filesystem::path& file) {
  FrictionConfig config;
  YamlMap yaml = YamlMap::load(file);
  yaml.read("classes", config.classes);
  std::vector<std::vector<double>> values;
  if (yaml.read("image_values", values)) {
    config.image_values.clear();
    for (const auto& list : values) {
      config.image_values.emplace_back();
      for (const double value : list) {
        if (!(value >= 0.0 && value <= 255.0 && value == std::floor(value)))
          yaml.report("image_values", std::to_string(value), "whole numbers from 0 to 255");
        else
          config.image_values.back().push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  yaml.read("prior_counts", config.prior_counts);
  yaml.read("friction_mean", config.friction_mean);
  yaml.read("friction_sigma", config.friction_sigma);
  yaml.read("spacing_m", config.spacing_m, Range{0.05, 100.0});
  yaml.read("kernel_width_m", config.kernel_width_m, Range{0.05, 200.0});
  yaml.read("range_m", config.range_m, Range{1.0, 500.0});
  yaml.read("labels_per_m2", config.labels_per_m2, Range{1e-6, 1e6});
  yaml.read("confusion", config.map.confusion);
  yaml.read("outlier_weight", config.map.outlier_weight, Range{0.0, 0.5});
  yaml.read("gate_counts", config.map.gate_counts, Range{0.0, 1e6});
  yaml.read("half_life_s", config.map.half_life_s, Range{0.0, 1e12});
  yaml.read("knot_half_life_s", config.map.knot_half_life_s, Range{0.0, 1e12});
  yaml.finish();
  config.check();
  return config;
}

}  // namespace roadbook
