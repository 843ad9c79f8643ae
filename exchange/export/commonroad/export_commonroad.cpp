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

void append_location(pugi::xml_node root, const ToDegrees* to_degrees) {
  const auto location = append_line(root, "location");
  // CommonRoad's own numbers for a place that is not known.
  append_text(location, "geoNameId", "-999");
  if (to_degrees == nullptr) {
    append_text(location, "gpsLatitude", "999");
    append_text(location, "gpsLongitude", "999");
    return;
  }
  append_text(location, "gpsLatitude", fixed_text(to_degrees->origin().latitude_deg, 9));
  append_text(location, "gpsLongitude", fixed_text(to_degrees->origin().longitude_deg, 9));
  const auto transformation = append_element(location, "geoTransformation");
  append_text(transformation, "geoReference", to_degrees->projection());
  const auto additional = append_element(transformation, "additionalTransformation");
  append_text(additional, "xTranslation", "0.0");
  append_text(additional, "yTranslation", "0.0");
  append_text(additional, "zRotation", "0.0");
  append_text(additional, "scaling", "1.0");
}

// The top-level element with the parts that say where and when.
pugi::xml_node append_header(pugi::xml_document& document,
                             const std::filesystem::path& map,
                             const PlannerMap& planner,
                             const std::string& country,
                             const ToDegrees* to_degrees) {
  const std::string date = planner.stored().source.date_utc.substr(0, 10);
  const auto root = append_element(document, "commonRoad",
                                   {{"commonRoadVersion", "2020a"},
                                    {"benchmarkID", country + "_" + benchmark_name(map) + "-1_1"},
                                    {"date", date.size() == 10 ? date : "1970-01-01"},
                                    {"author", "roadbook"},
                                    {"affiliation", "none"},
                                    {"source", "roadbook map " + planner.stored().digest},
                                    {"timeStepSize", "0.1"}});
  append_location(root, to_degrees);
  const auto tags = append_line(root, "scenarioTags");
  append_element(tags, "urban");
  append_element(tags, "speed_limit");
  if (!planner.layout().connectors.empty()) append_element(tags, "intersection");
  return root;
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
  const GdalScope scope;
  const auto to_degrees = find_to_degrees(map, options);
  const auto sign = std::find_if(speed_signs().begin(), speed_signs().end(),
                                 [&](const auto& s) { return s.first == options.country; });
  pugi::xml_document document;
  CommonRoadScenario scenario(
      append_header(document, map, planner, options.country, to_degrees.get()), planner,
      to_degrees.get(), sign->second);
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
  write_whole_file(out, xml_text(document));
  return {out};
}

}  // namespace roadbook
