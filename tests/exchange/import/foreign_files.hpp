#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exchange/export/geo_origin.hpp"
#include "exchange/import/import_labels.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook::test {

/// A car park of three spaces a side, and files of labels for it as other programs write them.
class ForeignFiles : public ::testing::Test {
 protected:
  using Json = nlohmann::ordered_json;

  ForeignFiles() {
    lot_.spaces_a_side = 3;
    space_ = spaces_of(lot_).back();
    write_lot(map_, lot_);
  }

  /// The same map without a label.
  void clear_map() const {
    std::filesystem::remove(map_);
    write_lot(map_, lot_);
  }

  /// Pixels of the overhead image, as COCO counts them, of a place of the map.
  [[nodiscard]] Eigen::Vector2d pixel(double x, double y) const {
    const RasterPlace place = LotPicture(lot_).place();
    return {(x - place.west_m) / place.resolution_m, (place.north_m - y) / place.resolution_m};
  }
  [[nodiscard]] Json ring_px(const std::vector<Eigen::Vector2d>& corners) const {
    Json ring = Json::array();
    for (const Eigen::Vector2d& c : corners)
      for (const double v : {pixel(c.x(), c.y()).x(), pixel(c.x(), c.y()).y()}) ring.push_back(v);
    return ring;
  }
  [[nodiscard]] Json bbox_px(const OrientedBox& upright) const {
    const Eigen::Vector2d low = pixel(upright.centre.x() - 0.5 * upright.width_m,
                                      upright.centre.y() + 0.5 * upright.length_m);
    return {low.x(), low.y(), upright.width_m / lot_.resolution_m,
            upright.length_m / lot_.resolution_m};
  }
  /// A COCO file of these annotations, of the classes given (ids from 1); ids and image are added.
  [[nodiscard]] Json coco(const std::vector<Json>& annotations,
                          const std::vector<std::string>& classes = {kSpace}) const {
    const RasterPlace place = LotPicture(lot_).place();
    Json file = {{"images",
                  {{{"id", 7},
                    {"width", place.columns},
                    {"height", place.rows},
                    {"file_name", "overhead.png"}}}},
                 {"categories", Json::array()},
                 {"annotations", Json::array()}};
    for (std::size_t i = 0; i < classes.size(); ++i)
      file["categories"].push_back({{"id", i + 1}, {"name", classes[i]}});
    for (std::size_t i = 0; i < annotations.size(); ++i) {
      Json one = {{"id", 100 + i}, {"image_id", 7}, {"category_id", 1}};
      one.update(annotations[i]);
      file["annotations"].push_back(one);
    }
    return file;
  }
  [[nodiscard]] Json degrees(const std::vector<Eigen::Vector2d>& corners) const {
    const ToDegrees to_degrees(*origin_);
    Json ring = Json::array();
    for (const Eigen::Vector2d& c : corners) ring.push_back({to_degrees(c).x(), to_degrees(c).y()});
    ring.push_back(ring.front());
    return ring;
  }
  static Json feature(const Json& properties, const std::string& type, const Json& coordinates) {
    return {{"type", "Feature"},
            {"properties", properties},
            {"geometry", {{"type", type}, {"coordinates", coordinates}}}};
  }
  static Json collection(const std::vector<Json>& features) {
    return {{"type", "FeatureCollection"}, {"features", features}};
  }

  LabelImport take(const std::string& format,
                   const std::string& text,
                   const std::string& class_field = {}) const {
    std::ofstream(file_) << text;
    return import_labels(map_, format, file_, "ann", origin_, class_field);
  }
  LabelImport take(const std::string& format, const Json& json) const {
    return take(format, json.dump());
  }
  /// The error of a file that is refused; "taken" where it is not.
  std::string refusal(const std::string& format, const std::string& text) const {
    try {
      take(format, text);
    } catch (const BadInput& fault) {
      return fault.what();
    }
    return "taken";
  }
  /// A folder with data.yaml and rows in labels/overhead.txt.
  [[nodiscard]] std::filesystem::path yolo(const std::string& names,
                                           const std::string& rows) const {
    const auto folder = folder_ / "yolo";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder / "labels");
    if (!names.empty()) std::ofstream(folder / "data.yaml") << names;
    if (!rows.empty()) std::ofstream(folder / "labels" / "overhead.txt") << rows;
    return folder;
  }
  std::string refusal_of_yolo(const std::filesystem::path& folder) const {
    try {
      import_labels(map_, "yolo", folder, "ann");
    } catch (const BadInput& fault) {
      return fault.what();
    }
    return "taken";
  }
  [[nodiscard]] std::vector<Label> labels() const { return read_labels(map_); }
  /// The only label, which must be a box.
  [[nodiscard]] OrientedBox only_box() const {
    const auto all = labels();
    EXPECT_EQ(all.size(), 1U);
    if (all.size() != 1 || all[0].shape != LabelShape::kBox) {
      ADD_FAILURE() << "no box";
      return {};
    }
    return *box_in_map(load_map(map_), all[0]);
  }
  static std::size_t total(const LabelImport& made) {
    return made.stored + made.already + made.changed + made.count_left_out();
  }

  Folder folder_;
  Lot lot_;
  std::filesystem::path map_ = folder_ / "lot.gpkg";
  std::filesystem::path file_ = folder_ / "labels.json";
  std::optional<GeoOrigin> origin_ = GeoOrigin{47.3769, 8.5417, 0.0};
  /// A space of the lot: 2.5 m along x, 5 m along y.
  OrientedBox space_;
};

#define EXPECT_TELLS(text, words) \
  EXPECT_NE((text).find(words), std::string::npos) << (text) << "\nwant " << (words)

}  // namespace roadbook::test
