#include "workflows/settings/friction_config.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {
namespace {

[[noreturn]] void fail(const std::string& field, double got, const std::string& want) {
  throw InvalidOption(field, std::to_string(got), want);
}

// Requires one number for each class.
void require_size(std::size_t size, std::size_t classes, const std::string& field) {
  if (size != classes)
    throw InvalidOption(field,
                        std::to_string(size) + " for " + std::to_string(classes) + " classes",
                        "one for each class");
}

void check_classes(const std::vector<std::string>& classes) {
  if (classes.empty() || classes.size() > kMaxPropertyClasses)
    throw InvalidOption("classes", std::to_string(classes.size()) + " names", "1 to 32");
  for (std::size_t i = 0; i < classes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (classes[i] == classes[j])
        throw InvalidOption("classes", classes[i] + " twice", "each once");
}

void check_image_values(const std::vector<std::vector<std::uint8_t>>& image_values) {
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
}

// `mean_field` and `spread_field` are the names of the property's fields in the input.
void check_property(const MeasuredProperty& property,
                    std::size_t classes,
                    const std::string& mean_field,
                    const std::string& spread_field) {
  require_size(property.mean.size(), classes, mean_field);
  require_size(property.spread.size(), classes, spread_field);
  for (const double mean : property.mean)
    if (!(mean >= property.range.min && mean <= property.range.max))
      fail(mean_field, mean,
           std::to_string(property.range.min) + " to " + std::to_string(property.range.max));
  for (const double spread : property.spread)
    if (!(spread > 0.0)) fail(spread_field, spread, "above 0");
}

// Names that a property must not have: other columns of the path tables, and rasters of the speed
// map that have `_sigma` and `_colours` rasters.
constexpr std::array kTakenNames{"lane",        "closed",      "one_way",
                                 "length_m",    "deviation_m", "max_curvature_radpm",
                                 "tube_m",      "s_m",         "x_m",
                                 "y_m",         "z_m",         "psi_rad",
                                 "kappa_radpm", "width_m",     "speed_limit_mps",
                                 "speed_mps",   "speed"};

// Column and raster names must be unique. A property has NAME, NAME_mean, NAME_sigma, NAME_colours.
void check_taken(const std::vector<MeasuredProperty>& all, const std::string& name) {
  if (std::find(kTakenNames.begin(), kTakenNames.end(), name) != kTakenNames.end())
    throw InvalidOption("properties", name,
                        "another name: paths or the speed map have something so called");
  for (const MeasuredProperty& other : all)
    if (name == other.name + "_sigma")
      throw InvalidOption("properties", name,
                          "another name: so the sigma of " + other.name + " is called");
}

bool is_name(const std::string& text) {
  return !text.empty() && text.front() >= 'a' && text.front() <= 'z' &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
         });
}

}  // namespace

void FrictionConfig::check() const {
  const std::size_t K = classes.size();
  check_classes(classes);
  require_size(image_values.size(), K, "image_values");
  check_image_values(image_values);
  require_size(prior_counts.size(), K, "prior_counts");
  for (const double count : prior_counts)
    if (!(std::isfinite(count) && count > 0.0)) fail("prior_counts", count, "numbers above 0");
  if (!(kernel_width_m > std::sqrt(0.5) * spacing_m))
    fail("kernel_width_m", kernel_width_m, "more than 0.7072 spacing_m: no hole between the knots");
  const auto all = properties();
  check_property(all.front(), K, "friction_mean", "friction_sigma");
  for (std::size_t i = 1; i < all.size(); ++i) {
    const std::string& name = all[i].name;
    if (!is_name(name) || name == "friction")
      throw InvalidOption("properties", name, "names of a-z, 0-9 and _, other than friction");
    check_taken(all, name);
    if (!(std::isfinite(all[i].range.min) && std::isfinite(all[i].range.max) &&
          all[i].range.min < all[i].range.max))
      throw InvalidOption("properties." + name + ".range", "no interval", "[least, most]");
    check_property(all[i], K, "properties." + name + ".mean", "properties." + name + ".spread");
  }
  map.check(K);
  refresh.check();
  prior().check();
}

std::vector<MeasuredProperty> FrictionConfig::properties() const {
  const PropertyPrior friction;
  std::vector<MeasuredProperty> all{{friction.name,
                                     friction.unit,
                                     "friction0/data.csv",
                                     "friction",
                                     "sigma",
                                     0.0,
                                     {friction.min, friction.max},
                                     friction_mean,
                                     friction_sigma}};
  all.insert(all.end(), further.begin(), further.end());
  return all;
}

PropertyMapPrior FrictionConfig::prior() const {
  PropertyMapPrior result;
  result.classes = classes;
  result.counts = prior_counts;
  for (const MeasuredProperty& property : properties()) {
    PropertyPrior prior{property.name, property.unit, property.range.min, property.range.max, {}};
    for (std::size_t i = 0; i < classes.size(); ++i)
      // The prior counts as two measurements of the class; alpha = 2 leaves its variance open.
      prior.classes.push_back(
          {property.mean[i], 2.0, 2.0, property.spread[i] * property.spread[i]});
    result.properties.push_back(std::move(prior));
  }
  return result;
}

std::vector<std::uint8_t> FrictionConfig::class_of_value() const {
  std::vector<std::uint8_t> result(256, static_cast<std::uint8_t>(classes.size()));
  for (std::size_t c = 0; c < image_values.size(); ++c)
    for (const std::uint8_t value : image_values[c]) result[value] = static_cast<std::uint8_t>(c);
  return result;
}

}  // namespace roadbook
