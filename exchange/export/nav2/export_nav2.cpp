#include <algorithm>
#include <cmath>

#include "base/whole_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "exchange/export/nav2/nav2_keepout.hpp"
#include "exchange/export/nav2/nav2_speed.hpp"
#include "mapping/store/map_file.hpp"

// Masks for Nav2's costmap filters. Speed: `mode: raw`, so that pixels 1 to 100 are the values; 0
// would mean "no limit" and is never written. Keep-out: `mode: trinary`, black where no vehicle may
// be.

namespace roadbook {
namespace {

constexpr char kFree = static_cast<char>(254);
constexpr char kLethal = 0;

std::string pgm(const RasterPlace& place, const std::string& pixels) {
  return "P5\n" + std::to_string(place.columns) + " " + std::to_string(place.rows) + "\n255\n" +
         pixels;
}

// A trinary pixel is free where 1 - pixel / 255 is below `free_thresh`, occupied above
// `occupied_thresh`. 0.196 leaves grey 205, which map editors write for unknown, unknown.
std::string map_yaml(const RasterPlace& place, const std::string& image, const std::string& mode) {
  return "image: " + image + "\nmode: " + mode +
         "\nresolution: " + fixed_text(place.resolution_m, 6) + "\norigin: [" +
         fixed_text(place.west_m, 6) + ", " +
         fixed_text(place.north_m - place.rows * place.resolution_m, 6) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

std::string filter_yaml(int type, const char* name, double base = 0.0, double multiplier = 1.0) {
  return "costmap_filter_info_server:\n  ros__parameters:\n    type: " + std::to_string(type) +
         "\n    filter_info_topic: \"" + name + "_info\"\n    mask_topic: \"" + name +
         "_mask\"\n    base: " + fixed_text(base, 3) +
         "\n    multiplier: " + fixed_text(multiplier, 3) + "\n";
}

// How speeds are pixels 1 to 100: speed = base + multiplier * pixel.
struct SpeedScale {
  double base = 0.0;
  double multiplier = 0.0;

  explicit SpeedScale(const std::vector<float>& speeds) {
    const auto [least, most] = std::minmax_element(speeds.begin(), speeds.end());
    // A hundredth of a round speed; as little below the fastest as the steps are wide.
    multiplier = std::max(0.01, std::ceil(static_cast<double>(*most)) / 100.0);
    // Pixel 1 is the least speed: a limit of 0 means none to Nav2.
    const double first = std::max(0.001, std::floor(1e3 * static_cast<double>(*least)) / 1e3);
    base = std::min(0.0, first - multiplier);
  }
  // Down to a whole step: never faster than the map.
  [[nodiscard]] char pixel_of(double speed) const {
    const double step = std::floor((speed - base) / multiplier + 1e-6);
    return static_cast<char>(std::clamp(step, 1.0, 100.0));
  }
};

// The files of one mask: image, its YAML, the parameters of its filter.
class MaskFiles {
 public:
  explicit MaskFiles(const std::filesystem::path& out) : out_(out) {}

  void write(const RasterPlace& place,
             const std::string& suffix,
             const std::string& mode,
             const std::string& pixels,
             const std::string& filter) {
    const std::string stem = out_.stem().string() + suffix;
    write_one(stem + ".pgm", pgm(place, pixels));
    write_one(stem + ".yaml", map_yaml(place, stem + ".pgm", mode));
    write_one(stem + "_filter.yaml", filter);
  }
  [[nodiscard]] const Paths& written() const { return files_; }

 private:
  void write_one(const std::string& name, const std::string& text) {
    files_.push_back(out_.parent_path() / name);
    write_whole_file(files_.back(), text);
  }
  std::filesystem::path out_;
  Paths files_;
};

void write_speeds(const std::filesystem::path& map, const MaskGrid& grid, MaskFiles& files) {
  const LaneQueries queries(map);
  const std::vector<float> speeds = cell_speeds(queries, grid);
  const SpeedScale scale(speeds);
  std::string pixels;
  pixels.reserve(speeds.size());
  for (const float speed : speeds) pixels += scale.pixel_of(static_cast<double>(speed));
  files.write(grid.place(), "", "raw", pixels,
              filter_yaml(2, "speed_filter", scale.base, scale.multiplier));
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void note_what_masks_lack(const PlannerMap& planner, const KeepOutMask& mask, ExportNotes& notes) {
  const auto& spaces = planner.spaces();
  const auto& lanes = planner.stored().network.lanes;
  add_note(notes, "speed masks", planner.speeds_known() ? 0 : 1,
           "the map has no speeds; `roadbook speeds` makes them");
  add_note(notes, "overhead images", mask.overhead ? 0 : 1,
           "the map has none, so that no ground beside lanes, spaces and crossings is free; "
           "`roadbook overhead` makes one");
  add_note(notes, "ways to parking spaces", mask.cut_off.size(),
           "no free ground as wide as the vehicle leads to them from a lane: spaces " +
               listed(mask.cut_off));
  add_note(notes, "links of parking spaces to lanes",
           static_cast<std::size_t>(
               std::count_if(spaces.begin(), spaces.end(), [](const auto& s) { return !!s.link; })),
           "a mask has cells alone; table space_links of the map has them");
  add_note(notes, "directions of one-way lanes",
           static_cast<std::size_t>(std::count_if(lanes.begin(), lanes.end(),
                                                  [](const Lane& l) { return l.one_way(); })),
           "a mask has cells alone; lanelet2 and opendrive hold them");
  add_note(notes, "labels of other classes", planner.other_labels(),
           "only parking spaces and crossings say where to drive");
}

}  // namespace

Paths export_nav2(const std::filesystem::path& map,
                  const std::filesystem::path& out,
                  const ExportOptions& options,
                  ExportNotes& notes) {
  const PlannerMap planner(map);
  const Map content = load_map(map);
  const KeepOutMask mask =
      keep_out_mask(map, content, planner, options.vehicle.value_or(footprint_for(content)),
                    options.resolution_m);
  MaskFiles files(out);
  if (planner.speeds_known()) write_speeds(map, mask.grid, files);
  std::string pixels;
  pixels.reserve(mask.grid.cells().size());
  for (const std::uint8_t cell : mask.grid.cells()) pixels += cell != 0 ? kFree : kLethal;
  files.write(mask.grid.place(), "_keepout", "trinary", pixels, filter_yaml(0, "keepout_filter"));
  note_what_masks_lack(planner, mask, notes);
  return files.written();
}

}  // namespace roadbook
