#include "speedmap/property_map/ground_table.hpp"

#include <array>
#include <cmath>
#include <map>
#include <string>

#include "base/cell_grid.hpp"
#include "base/error.hpp"
#include "base/require_option.hpp"

namespace roadbook {

void GroundTableOptions::check() const {
  require_option(std::isfinite(cell_m) && cell_m >= 0.01, "cell_m", cell_m, "0.01 or more");
  require_option(std::isfinite(ahead_min_m), "ahead_min_m", ahead_min_m, "a finite number");
  require_option(ahead_max_m > ahead_min_m && ahead_max_m < 1e4, "ahead_max_m", ahead_max_m,
                 "more than ahead_min_m");
  require_option(aside_max_m > 0.0 && aside_max_m < 1e4, "aside_max_m", aside_max_m, "more than 0");
  require_option(pixel_step >= 1, "pixel_step", pixel_step, "1 or more");
  require_option(labels_per_m2 > 0.0 && std::isfinite(labels_per_m2), "labels_per_m2",
                 labels_per_m2, "more than 0");
}

GroundTable::GroundTable(const MountedCamera& mounted, const GroundTableOptions& options)
    : options_(options), width_(mounted.camera.width), height_(mounted.camera.height) {
  options_.check();
  std::map<GridCell<2>, std::uint32_t> cells;  // numbered in the order of the image
  std::vector<double> pixels_in;
  for (int v = 0; v < height_; v += options_.pixel_step)
    for (int u = 0; u < width_; u += options_.pixel_step) {
      const auto p = ground_point(mounted.camera, mounted.T_vehicle_camera, options_.plane,
                                  {static_cast<double>(u), static_cast<double>(v)});
      if (!p || p->x() < options_.ahead_min_m || p->x() > options_.ahead_max_m ||
          std::abs(p->y()) > options_.aside_max_m)
        continue;
      const GridCell<2> cell = cell_at<2>(p->head<2>(), options_.cell_m);
      const auto number =
          cells.emplace(cell, static_cast<std::uint32_t>(cells.size())).first->second;
      if (number == centres_.size()) {
        centres_.emplace_back(0.0, 0.0);
        pixels_in.push_back(0.0);
      }
      centres_[number] += p->head<2>();
      pixels_in[number] += 1.0;
      pixel_.push_back(static_cast<std::uint32_t>(v) * static_cast<std::uint32_t>(width_) +
                       static_cast<std::uint32_t>(u));
      cell_of_.push_back(number);
    }
  for (std::size_t i = 0; i < centres_.size(); ++i) centres_[i] /= pixels_in[i];
}

std::size_t GroundTable::count(const std::uint8_t* classes,
                               std::size_t row_bytes,
                               std::size_t num_classes,
                               std::vector<std::uint32_t>& counts) const {
  counts.assign(centres_.size() * num_classes, 0);
  std::size_t left_out = 0;
  const auto width = static_cast<std::uint32_t>(width_);
  for (std::size_t i = 0; i < pixel_.size(); ++i) {
    const std::uint32_t row = pixel_[i] / width;
    const std::uint8_t c = classes[row * row_bytes + (pixel_[i] - row * width)];
    if (c < num_classes)
      ++counts[cell_of_[i] * num_classes + c];
    else
      ++left_out;
  }
  return left_out;
}

std::size_t add_frame(PropertyMap& map,
                      const GroundTable& table,
                      std::span<const std::uint32_t> counts,
                      const GroundToPath& to_path,
                      double travelled_m) {
  const std::size_t K = map.classes();
  ROADBOOK_ASSERT(counts.size() == table.centres().size() * K);
  const double cell = table.options().cell_m;
  const double worth = table.options().labels_per_m2 * cell * cell * travelled_m;
  std::array<double, kMaxPropertyClasses> weights{};
  std::size_t used = 0;
  for (std::size_t i = 0; i < table.centres().size(); ++i) {
    double total = 0.0;
    for (std::size_t c = 0; c < K; ++c) total += counts[i * K + c];
    if (total == 0.0) continue;
    const auto place = to_path(table.centres()[i]);
    if (!place) continue;
    for (std::size_t c = 0; c < K; ++c) weights[c] = worth * counts[i * K + c] / total;
    used += map.add_labels(*place, {weights.data(), K}) ? 1 : 0;
  }
  return used;
}

}  // namespace roadbook
