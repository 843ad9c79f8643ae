#include <map>

#include "exchange/label_readers.hpp"
#include "exchange/picture_edge.hpp"
#include "semantics/label_classes.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

// Reads the fields of a file and gathers what is wrong with them.
class CocoReader {
 public:
  CocoReader(std::string file, const MapLayers& layers) : file_(std::move(file)), layers_(layers) {}

  Outlines read(const Json& json) {
    if (!json.is_object()) fault("file", json.type_name(), "an object");
    if (problems_.empty()) read_image(list(json, "images"));
    if (problems_.empty()) read_categories(list(json, "categories"));
    if (problems_.empty()) read_annotations(list(json, "annotations"));
    if (!problems_.empty()) throw BadInput(problems_);
    return std::move(outlines_);
  }

 private:
  void fault(const std::string& field, const std::string& got, const std::string& want) {
    problems_.push_back({Severity::kError, file_, 0, field, got, want});
  }
  Json list(const Json& json, const char* name) {
    const auto found = json.find(name);
    if (found != json.end() && found->is_array()) return *found;
    fault(name, found == json.end() ? "nothing" : found->type_name(), "a list");
    return Json::array();
  }
  // The field where it is of its kind, else null and a fault.
  Json field(const Json& object,
             const std::string& where,
             const char* name,
             bool (*is)(const Json&),
             const char* want) {
    const auto found = object.is_object() ? object.find(name) : object.end();
    if (object.is_object() && found != object.end() && is(*found)) return *found;
    const bool missing = !object.is_object() || found == object.end();
    fault(where + "." + name, missing ? "nothing" : shown(*found), want);
    return nullptr;
  }
  static std::string shown(const Json& value) { return value.dump().substr(0, 60); }
  static bool is_whole(const Json& value) { return value.is_number_integer(); }
  static bool is_side(const Json& value) {
    return is_whole(value) && value >= 1 && value <= 1'000'000;
  }
  static bool is_share(const Json& value) {
    return value.is_number() && value >= 0.0 && value <= 1.0;
  }
  static bool is_text(const Json& value) { return value.is_string(); }
  static bool is_numbers(const Json& value) {
    if (!value.is_array()) return false;
    for (const Json& number : value)
      if (!number.is_number()) return false;
    return true;
  }

  void read_image(const Json& images) {
    if (images.size() != 1)
      return fault("images", std::to_string(images.size()), "one, the map's overhead image");
    const Json& image = images[0];
    const Json id = field(image, "images[0]", "id", is_whole, "a whole number");
    const Json width = field(image, "images[0]", "width", is_side, "1 to 1000000 pixels");
    const Json height = field(image, "images[0]", "height", is_side, "1 to 1000000 pixels");
    if (!problems_.empty()) return;
    image_ = id.get<std::int64_t>();
    place_.width = width.get<int>();
    place_.height = height.get<int>();
    if (!image.contains("world")) {
      const PicturePlace own = overhead_place(layers_);
      require_size(file_, own, place_.width, place_.height);
      place_ = own;
      return;
    }
    const Json& world = image["world"];
    const auto is_corner = [](const Json& value) { return is_numbers(value) && value.size() == 2; };
    const auto is_size = [](const Json& v) { return v.is_number() && v.get<double>() > 0.0; };
    const Json corner =
        field(world, "images[0].world", "corner_m", is_corner, "x and y of the north-west corner");
    const Json resolution =
        field(world, "images[0].world", "resolution_m", is_size, "metres a pixel");
    if (!problems_.empty()) return;
    place_.corner = {corner[0].get<double>(), corner[1].get<double>()};
    place_.resolution_m = resolution.get<double>();
  }

  void read_categories(const Json& categories) {
    for (std::size_t i = 0; i < categories.size(); ++i) {
      const std::string where = "categories[" + std::to_string(i) + "]";
      const Json id = field(categories[i], where, "id", is_whole, "a whole number");
      const Json name = field(categories[i], where, "name", is_text, "text");
      if (id.is_null() || name.is_null()) continue;
      if (const auto wrong = wrong_name(name)) fault(where + ".name", *wrong, kNameWanted);
      if (!kinds_.emplace(id.get<std::int64_t>(), name).second)
        fault(where + ".id", id.dump(), "one that no other category has");
    }
  }

  void read_annotations(const Json& annotations) {
    for (std::size_t i = 0; i < annotations.size(); ++i) {
      const std::string where = "annotations[" + std::to_string(i) + "]";
      const Json& a = annotations[i];
      const Json image = field(a, where, "image_id", is_whole, "a whole number");
      const Json category = field(a, where, "category_id", is_whole, "a whole number");
      if (image.is_null() || category.is_null()) continue;
      if (image != image_) {
        fault(where + ".image_id", image.dump(), std::to_string(image_) + ", the only image");
      } else if (const auto kind = kinds_.find(category.get<std::int64_t>());
                 kind == kinds_.end()) {
        fault(where + ".category_id", category.dump(), "an id of `categories`");
      } else {
        read_outline(a, where, kind->second);
      }
    }
  }

  void read_outline(const Json& a, const std::string& where, const std::string& kind) {
    LabelOutline outline;
    outline.kind = kind;
    outline.where = where + ".segmentation";
    const std::vector<double> values = ring_of(a, where);
    if (values.empty()) return;
    for (std::size_t k = 0; k + 1 < values.size(); k += 2)
      outline.corners.push_back(place_.place_of({values[k], values[k + 1]}));
    if (a.contains("score") && !a["score"].is_null()) {
      const Json score = field(a, where, "score", is_share, "0 to 1");
      if (score.is_null()) return;
      outline.score = score;
    }
    if (!read_attributes(a.value("attributes", Json()), where + ".attributes", outline)) return;
    const auto wrong = outline_problems(file_, outline);
    problems_.insert(problems_.end(), wrong.begin(), wrong.end());
    if (!wrong.empty()) return;
    if (parts_in_picture(place_, outline.corners).empty())
      return fault(outline.where,
                   std::to_string(values[0]) + ", " + std::to_string(values[1]) + " and no part" +
                       " in the image",
                   "an outline that lies in the image, or partly");
    outlines_.push_back(std::move(outline));
  }

  // Fields that other programs leave out or empty; false where one is of another kind.
  bool read_attributes(const Json& more, const std::string& where, LabelOutline& outline) {
    if (more.is_null()) return true;
    if (!more.is_object()) {
      fault(where, shown(more), "an object");
      return false;
    }
    const std::size_t before = problems_.size();
    const auto given = [&](const char* name, bool (*is)(const Json&), const char* want) {
      const bool there = more.contains(name) && !more[name].is_null();
      return there ? field(more, where, name, is, want) : Json();
    };
    const auto is_shape = [](const Json& value) { return value == "box" || value == "polygon"; };
    const auto is_number = [](const Json& value) { return value.is_number(); };
    const Json shape = given("shape", is_shape, "box or polygon");
    const Json heading = given("heading_rad", is_number, "a number of radians");
    const Json sigma_m = given("sigma_m", is_number, "a number of metres");
    const Json note = given("note", is_text, "text");
    if (!shape.is_null()) outline.shape = shape == "box" ? LabelShape::kBox : LabelShape::kPolygon;
    if (!heading.is_null()) outline.heading_rad = heading.get<double>();
    if (!sigma_m.is_null()) outline.sigma_m = sigma_m.get<double>();
    if (!note.is_null()) outline.note = note;
    return problems_.size() == before;
  }

  // x, y of the corners in pixels; empty where they are wrong.
  std::vector<double> ring_of(const Json& a, const std::string& where) {
    const Json segmentation = a.value("segmentation", Json());
    if (segmentation.is_object()) {
      fault(where + ".segmentation", "a run-length mask", "a polygon");
      return {};
    }
    if (segmentation.is_null() || segmentation == Json::array()) return ring_of_bbox(a, where);
    if (!segmentation.is_array()) {
      fault(where + ".segmentation", shown(segmentation), "a polygon");
      return {};
    }
    if (segmentation.size() != 1 || !is_numbers(segmentation[0])) {
      fault(
          where + ".segmentation",
          segmentation.size() == 1 ? "no numbers" : std::to_string(segmentation.size()) + " parts",
          "one list of numbers");
      return {};
    }
    const auto values = segmentation[0].get<std::vector<double>>();
    if (values.size() % 2 == 0 && !values.empty()) return values;
    fault(where + ".segmentation", std::to_string(values.size()) + " numbers", "pairs x, y");
    return {};
  }
  std::vector<double> ring_of_bbox(const Json& a, const std::string& where) {
    const auto is_box = [](const Json& value) {
      return is_numbers(value) && value.size() == 4 && value[2] > 0.0 && value[3] > 0.0;
    };
    const Json box = field(a, where, "bbox", is_box, "x, y, width, height, or a segmentation");
    if (box.is_null()) return {};
    const double x = box[0];
    const double y = box[1];
    const double w = box[2];
    const double h = box[3];
    return {x + w, y + h, x + w, y, x, y, x, y + h};
  }

  std::string file_;
  const MapLayers& layers_;
  PicturePlace place_;
  std::int64_t image_ = 0;
  std::map<std::int64_t, std::string> kinds_;
  std::vector<Problem> problems_;
  Outlines outlines_;
};

}  // namespace

Outlines read_coco(const std::filesystem::path& file, const MapLayers& layers) {
  return CocoReader(file.string(), layers).read(read_json_file(file));
}

}  // namespace roadbook
