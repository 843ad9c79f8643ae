#pragma once

#include <cmath>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/exchange/import/foreign_files.hpp"

namespace roadbook::test {

/// Exports labels, changes the file as other programs do, and imports it into the same map.
class KnownLabels : public ForeignFiles {
 protected:
  using Json = nlohmann::ordered_json;

  KnownLabels() {
    LabelStore store(map_);
    std::vector<Label> drawn;
    for (OrientedBox box : spaces_of(lot_)) {
      box.heading += 0.1234567;
      box.width_m = 2.3;  // neighbours do not overlap
      const auto c = box.corners();
      const std::vector<Eigen::Vector2d> corners(c.begin(), c.end());
      drawn.push_back(label_of_box(store.map(), *anchor_for(store.map(), corners), box));
      drawn.back().kind = kSpace;
    }
    const std::vector<Eigen::Vector2d> corners{{2, -1}, {4, -1}, {4.123, 1.5}, {3, 0.5}, {2, 1}};
    drawn.push_back(label_of_polygon(store.map(), *anchor_for(store.map(), corners), corners));
    drawn.back().kind = "crossing";
    store.create_all(drawn, "ann");
  }
  Json written(const std::string& format) const {
    ExportOptions options;
    options.origin = origin_;
    options.layers = {};
    export_map(map_, format, file_, options);
    std::ifstream in(file_);
    Json json = Json::parse(in);
    if (format == "geojson") keep_labels(json["features"]);
    return json;
  }
  static void keep_labels(Json& features) {
    Json kept = Json::array();
    for (const Json& one : features)
      if (one["properties"].contains("class")) kept.push_back(one);
    features = kept;
  }
  // Calls `change(number)` for each coordinate of a file.
  static void for_each_number(Json& file, const std::function<void(Json&)>& change) {
    const std::function<void(Json&)> all = [&](Json& value) {
      if (value.is_array())
        for (Json& one : value) all(one);
      else
        change(value);
    };
    if (file.contains("annotations"))
      for (Json& a : file["annotations"]) all(a["segmentation"]);
    else
      for (Json& f : file["features"]) all(f["geometry"]["coordinates"]);
  }
  static void round_all(Json& file, double scale) {
    for_each_number(file, [&](Json& v) { v = std::round(v.get<double>() * scale) / scale; });
  }
  void expect_all_known(const LabelImport& made) const {
    EXPECT_EQ(made.stored, 0U);
    EXPECT_EQ(made.changed, 0U);
    EXPECT_EQ(made.already, 7U);
    EXPECT_EQ(made.count_left_out(), 0U);
    EXPECT_EQ(labels().size(), 7U);
    for (const Label& label : labels()) EXPECT_EQ(label.version, 1);
  }
  // Leaves only geometry and class, as a program does that knows no other fields.
  static void strip(Json& file) {
    if (file.contains("annotations")) {
      for (Json& a : file["annotations"]) a.erase("attributes");
      for (Json& image : file["images"]) image.erase("world");
    } else {
      for (Json& f : file["features"]) f["properties"] = {{"class", f["properties"]["class"]}};
    }
  }
  Eigen::Vector2d middle_of_label(std::int64_t id) const {
    for (const Label& label : labels())
      if (label.id == id) return seen_in_map(load_map(map_), label)->middle;
    return {NAN, NAN};
  }
  Json& of_label(Json& file, std::int64_t id) const {
    for (Json& f : file["features"])
      if (f["properties"]["space"] == id) return f;
    throw std::runtime_error("no such label");
  }
  // Moves a label of a GeoJSON file to the east.
  void move(Json& feature, double metres) const {
    const double per_degree = 111.3e3 * std::cos(origin_->latitude_deg * M_PI / 180.0);
    for (Json& point : feature["geometry"]["coordinates"][0])
      point[0] = point[0].get<double>() + metres / per_degree;
  }
};

}  // namespace roadbook::test
