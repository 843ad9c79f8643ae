#include <algorithm>
#include <cctype>

#include "base/error.hpp"
#include "base/whole_file.hpp"
#include "exchange/export/commonroad/commonroad_scenario.hpp"
#include "exchange/export/export_formats.hpp"
#include "exchange/export/geo_origin.hpp"
#include "mapping/layers/map_layers_gdal.hpp"

// CommonRoad scenarios, XML format 2020a (schema XML_commonRoad_XSD.xsd of commonroad-io). Speed
// limits are traffic signs that a lanelet refers to. The schema wants a planning problem: over the
// longest way that a vehicle can go.

namespace roadbook {
namespace {

// The sign of a speed limit by country, as far as the schema knows it.
const std::vector<std::pair<std::string, std::string>>& speed_signs() {
  static const std::vector<std::pair<std::string, std::string>> signs{
      {"ZAM", "274"},  {"DEU", "274"},  {"CHN", "274"}, {"ITA", "274"},
      {"USA", "R2-1"}, {"PRI", "R2-1"}, {"ESP", "r301"}};
  return signs;
}

// Letters and digits of the map's name, as the benchmark id wants them.
std::string benchmark_name(const std::filesystem::path& map) {
  std::string name;
  for (const char c : map.stem().string())
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  if (name.empty()) return "Map";
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

std::string location(const std::optional<GeoOrigin>& origin, const ToDegrees* to_degrees) {
  // CommonRoad's own numbers for a place that is not known.
  if (!origin)
    return xml_element("location", xml_element("geoNameId", "-999") +
                                       xml_element("gpsLatitude", "999") +
                                       xml_element("gpsLongitude", "999"));
  return xml_element(
      "location",
      xml_element("geoNameId", "-999") +
          xml_element("gpsLatitude", fixed_text(origin->latitude_deg, 9)) +
          xml_element("gpsLongitude", fixed_text(origin->longitude_deg, 9)) +
          xml_element("geoTransformation", xml_element("geoReference", to_degrees->projection()) +
                                               xml_element("additionalTransformation",
                                                           xml_element("xTranslation", "0.0") +
                                                               xml_element("yTranslation", "0.0") +
                                                               xml_element("zRotation", "0.0") +
                                                               xml_element("scaling", "1.0"))));
}

}  // namespace

const std::vector<std::string>& commonroad_countries() {
  static const std::vector<std::string> countries = [] {
    std::vector<std::string> names;
    for (const auto& [country, sign] : speed_signs()) names.push_back(country);
    return names;
  }();
  return countries;
}

Paths export_commonroad(const std::filesystem::path& map,
                        const std::filesystem::path& out,
                        const ExportOptions& options,
                        ExportNotes& notes) {
  const PlannerMap planner(map);
  const auto origin = find_origin(map, options);
  const GdalScope scope;
  std::optional<ToDegrees> to_degrees;
  if (origin) to_degrees.emplace(*origin);
  const ToDegrees* const turned = to_degrees ? &*to_degrees : nullptr;
  const auto sign = std::find_if(speed_signs().begin(), speed_signs().end(),
                                 [&](const auto& s) { return s.first == options.country; });
  CommonRoadScenario scenario(planner, turned, sign->second);
  if (scenario.empty())
    throw BadInput(
        Problem{Severity::kError, map.string(), 0, "lanes", "none with a path", "one and more"});
  scenario.add_roads();
  scenario.add_crossings(notes);
  scenario.add_parking(notes);
  scenario.add_intersections();
  scenario.add_problem();
  scenario.count_heights(notes);
  add_note(notes, "labels of other classes", planner.other_labels(),
           "CommonRoad has no place for them; --format gpkg has");
  const std::string date = planner.stored().source.date_utc.substr(0, 10);
  write_whole_file(
      out,
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<commonRoad commonRoadVersion=\"2020a\" "
      "benchmarkID=\"" +
          options.country + "_" + benchmark_name(map) + "-1_1\" date=\"" +
          (date.size() == 10 ? date : "1970-01-01") +
          "\" author=\"roadbook\" affiliation=\"none\" source=\"roadbook map " +
          planner.stored().digest + "\" timeStepSize=\"0.1\">\n  " + location(origin, turned) +
          "\n  <scenarioTags><urban/><speed_limit/>" +
          (scenario.has_turns() ? "<intersection/>" : "") + "</scenarioTags>\n" + scenario.text() +
          "</commonRoad>\n");
  return {out};
}

}  // namespace roadbook
