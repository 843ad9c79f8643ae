#include "workflows/property_table.hpp"

#include <algorithm>
#include <string>

#include "base/error.hpp"
#include "drive/csv.hpp"
#include "drive/sensor_yaml.hpp"

namespace roadbook {
namespace {

bool plausible(const MeasuredProperty& property,
               double value,
               double sigma,
               const CsvReader& csv,
               ProblemList& problems) {
  const Range& range = property.range;
  const bool good = value >= range.min && value <= range.max;
  if (!good)
    problems.error(csv.file(), csv.line(), property.column, std::to_string(value),
                   std::to_string(range.min) + " to " + std::to_string(range.max));
  if (!(sigma >= 0.0))
    problems.error(csv.file(), csv.line(), property.sigma_column, std::to_string(sigma),
                   "0 or more");
  return good && sigma >= 0.0;
}

// Returns the offset [ns] to add to the stamps of a table.
std::int64_t stated_offset_ns(const std::filesystem::path& table, ProblemList& problems) {
  const auto yaml = table.parent_path() / "sensor.yaml";
  if (!std::filesystem::exists(yaml)) return 0;
  const auto stated = read_stream_yaml(yaml, problems);
  return stated ? offset_ns(stated->time_offset_s) : 0;
}

void read_table(const std::filesystem::path& file,
                const MeasuredProperty& property,
                std::size_t index,
                ProblemList& problems,
                std::vector<PropertyReading>& readings) {
  CsvReader csv(file, CsvHeader::kRequired, problems);
  if (!csv.good()) return;
  const auto t_column = csv.require("timestamp", "ns|");
  const std::string units = property.unit == "-" ? "-|" : property.unit;
  const auto value_column = csv.require(property.column, units);
  const auto sigma_column =
      property.sigma_column.empty() ? std::nullopt : csv.require(property.sigma_column, units);
  if (!t_column || !value_column || (!property.sigma_column.empty() && !sigma_column)) return;
  const std::int64_t added_ns = stated_offset_ns(file, problems);
  while (csv.next()) {
    const auto t = csv.stamp(*t_column);
    const auto value = csv.number(*value_column);
    const auto sigma =
        sigma_column ? csv.number(*sigma_column) : std::optional(property.sensor_sigma);
    if (t && value && sigma && plausible(property, *value, *sigma, csv, problems))
      readings.push_back({*t + added_ns, index, *value, *sigma});
  }
}

}  // namespace

std::filesystem::path property_file(const std::filesystem::path& drive,
                                    const MeasuredProperty& property) {
  const auto level = drive / "mav0";
  return (std::filesystem::is_directory(level) ? level : drive) / property.table;
}

std::vector<PropertyReading> read_properties(const std::filesystem::path& drive,
                                             const std::vector<MeasuredProperty>& properties) {
  ProblemList problems;
  std::vector<PropertyReading> readings;
  for (std::size_t i = 0; i < properties.size(); ++i) {
    const auto file = property_file(drive, properties[i]);
    if (std::filesystem::exists(file)) read_table(file, properties[i], i, problems, readings);
  }
  if (problems.has_errors()) throw BadInput(problems.problems());
  std::stable_sort(readings.begin(), readings.end(),
                   [](const auto& a, const auto& b) { return a.t_ns < b.t_ns; });
  return readings;
}

}  // namespace roadbook
