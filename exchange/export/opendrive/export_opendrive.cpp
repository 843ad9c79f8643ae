#include "base/whole_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "exchange/export/opendrive/opendrive_text.hpp"
#include "mapping/layers/map_layers_gdal.hpp"

// OpenDRIVE 1.6 as SUMO's netconvert reads it: a road for each lane and direction, a junction for
// each intersection, a connecting road for each turn. Parking spaces and crossings are objects of
// roads.

namespace roadbook {
namespace {

// Notes on contents of the map that the file lacks or changes.
void note_losses(const PlannerMap& planner,
                 const DriveRoads& roads,
                 const DriveObjects& objects,
                 ExportNotes& notes) {
  const auto add = [&](const char* what, std::size_t count, const char* why) {
    if (count > 0) notes.push_back({what, count, why});
  };
  const std::size_t pieces = planner.layout().pieces.size();
  if (!planner.speeds_known())
    add("speed profiles", pieces,
        "the map has none; limits follow from bends and the default limit until `roadbook speeds` "
        "is run");
  add("lanes", planner.stored().network.lanes.size() - pieces, "they have no path");
  add("full widths of lanes", roads.narrowed, "bends leave no room for them");
  add("narrow widths of lanes", roads.widened,
      "SUMO closes lanes below 1.8 m for cars; they are written 1.81 m wide");
  std::size_t unlinked = 0;
  for (const PlannerSpace& space : planner.spaces()) unlinked += space.link ? 0U : 1U;
  add("lanes of parking spaces", unlinked, "no lane passes their open side; the spaces are in it");
  add("outlines as SUMO reads them", objects.not_rectangles,
      "they are no rectangles; SUMO reads the rectangle about them and not the outline beside it");
  add("places as SUMO reads them", objects.displaced,
      "they lie beside no road; SUMO shows them elsewhere, and only the outline is exact");
  add("labels of other classes", planner.other_labels(),
      "no object of OpenDRIVE is written for them");
}

}  // namespace

Paths export_opendrive(const std::filesystem::path& map,
                       const std::filesystem::path& out,
                       const ExportOptions& options,
                       ExportNotes& notes) {
  const PlannerMap planner(map);
  const GdalScope scope;
  const auto to_degrees = find_to_degrees(map, options);
  const DriveRoads roads = drive_roads(planner);
  const DriveObjects objects = drive_objects(planner, roads);
  write_whole_file(out, opendrive_text(planner, roads, objects, to_degrees.get()));
  note_losses(planner, roads, objects, notes);
  return {out};
}

}  // namespace roadbook
