#include <algorithm>
#include <map>

#include "exchange/export/picture_edge.hpp"
#include "exchange/import/coco_annotation.hpp"
#include "exchange/import/label_readers.hpp"
#include "semantics/labels/label_classes.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

// Reads the lists of a COCO file; its annotations one by one (coco_annotation.hpp).
class CocoReader {
 public:
  CocoReader(const std::string& file, const MapLayers& layers) : fields_(file), layers_(layers) {}

  LabelFile read(const Json& json) {
    if (!json.is_object()) fields_.fault("file", json.type_name(), "an object");
    if (is_good()) read_images(fields_.list(json, "images"));
    if (is_good()) read_categories(fields_.list(json, "categories"));
    if (is_good()) read_annotations(fields_.list(json, "annotations"));
    if (!is_good()) throw BadInput(fields_.problems());
    for (const auto& [image, count] : of_others_) {
      LabelsLeftOut others =
          left_out(fields_.file(), "annotations of image " + std::to_string(image),
                   std::to_string(count), "none: it is not the overhead image");
      others.count = count;
      result_.left_out.push_back(std::move(others));
    }
    return std::move(result_);
  }

 private:
  struct Image {
    std::string where;
    std::int64_t id = 0;
    int width = 0;
    int height = 0;
    std::string name;
    Json world;
  };

  [[nodiscard]] bool is_good() const { return fields_.problems().empty(); }

  std::optional<Image> image_of(const Json& json, const std::string& where) {
    const auto is_side = [](const Json& value) {
      return is_whole(value) && value.get<double>() >= 1.0 && value.get<double>() <= 1e6;
    };
    const Json id = fields_.required(json, where, "id", is_whole, "a whole number");
    const Json width = fields_.required(json, where, "width", is_side, "1 to 1000000 pixels");
    const Json height = fields_.required(json, where, "height", is_side, "1 to 1000000 pixels");
    if (!is_good()) return std::nullopt;
    const Json name = json.value("file_name", Json());
    return Image{where,
                 id.get<std::int64_t>(),
                 width.get<int>(),
                 height.get<int>(),
                 name.is_string() ? name.get<std::string>() : std::string(),
                 json.value("world", Json())};
  }

  void read_images(const Json& list) {
    if (list.empty()) return fields_.fault("images", "0", "one, the map's overhead image");
    std::vector<Image> images;
    for (std::size_t i = 0; i < list.size(); ++i)
      if (auto image = image_of(list[i], "images[" + std::to_string(i) + "]"))
        images.push_back(std::move(*image));
    if (!is_good()) return;
    for (const Image& image : images) ids_.push_back(image.id);
    if (images.size() > 1) keep_overhead(images);
    if (is_good()) read_place(images.front());
  }

  // Selects the image that can be the map's; a fault where no image or more than one image can be.
  void keep_overhead(std::vector<Image>& images) {
    std::optional<PicturePlace> own;
    if (layers_.has("overhead")) own = overhead_place(layers_);
    const auto may_be = [&](const Image& image) {
      return !image.world.is_null() ||
             (own && image.width == own->width && image.height == own->height);
    };
    const std::string got = std::to_string(images.size());
    std::erase_if(images, [&](const Image& image) { return !may_be(image); });
    if (images.size() > 1 && std::any_of(images.begin(), images.end(), is_named_overhead))
      std::erase_if(images, [](const Image& image) { return !is_named_overhead(image); });
    if (images.size() == 1) return;
    std::string names;
    for (const Image& image : images) names += (names.empty() ? "" : ", ") + image.name;
    fields_.fault("images", images.empty() ? got + ", none as large" : names,
                  "one that has the size of the map's overhead image" +
                      (own ? " (" + std::to_string(own->width) + " x " +
                                 std::to_string(own->height) + " pixels)"
                           : std::string()));
  }
  static bool is_named_overhead(const Image& image) {
    return image.name.find("overhead") != std::string::npos;
  }

  void read_place(const Image& image) {
    image_ = image.id;
    place_.width = image.width;
    place_.height = image.height;
    if (image.world.is_null()) {
      const PicturePlace own = overhead_place(layers_);
      require_size(fields_.file(), own, place_.width, place_.height);
      place_ = own;
      return;
    }
    const std::string where = image.where + ".world";
    const auto is_corner = [](const Json& value) { return is_numbers(value) && value.size() == 2; };
    const auto is_size = [](const Json& v) { return v.is_number() && v.get<double>() > 0.0; };
    const Json corner = fields_.required(image.world, where, "corner_m", is_corner,
                                         "x and y of the north-west corner");
    const Json resolution =
        fields_.required(image.world, where, "resolution_m", is_size, "metres a pixel");
    if (!is_good()) return;
    place_.corner = {corner[0].get<double>(), corner[1].get<double>()};
    place_.resolution_m = resolution.get<double>();
  }

  void read_categories(const Json& categories) {
    for (std::size_t i = 0; i < categories.size(); ++i) {
      const std::string where = "categories[" + std::to_string(i) + "]";
      const Json id = fields_.required(categories[i], where, "id", is_whole, "a whole number");
      const Json name = fields_.required(categories[i], where, "name", is_text, "text");
      if (id.is_null() || name.is_null()) continue;
      if (const auto wrong = wrong_name(name)) fields_.fault(where + ".name", *wrong, kNameWanted);
      if (!kinds_.emplace(id.get<std::int64_t>(), name).second)
        fields_.fault(where + ".id", id.dump(), "one that no other category has");
    }
  }

  void read_annotations(const Json& annotations) {
    for (std::size_t i = 0; i < annotations.size(); ++i) {
      const std::string where = "annotations[" + std::to_string(i) + "]";
      const Json& a = annotations[i];
      const Json image = fields_.required(a, where, "image_id", is_whole, "a whole number");
      const Json category = fields_.required(a, where, "category_id", is_whole, "a whole number");
      if (image.is_null() || category.is_null()) continue;
      if (const auto id = image.get<std::int64_t>(); id != image_) {
        if (std::find(ids_.begin(), ids_.end(), id) != ids_.end())
          ++of_others_[id];
        else
          fields_.fault(
              where + ".image_id", image.dump(),
              ids_.size() == 1 ? std::to_string(image_) + ", the only image" : "an id of `images`");
      } else if (const auto kind = kinds_.find(category.get<std::int64_t>());
                 kind == kinds_.end()) {
        fields_.fault(where + ".category_id", category.dump(), "an id of `categories`");
      } else {
        read_annotation(a, where, kind->second);
      }
    }
  }

  void read_annotation(const Json& a, const std::string& where, const std::string& kind) {
    auto outline = read_coco_annotation(a, where, place_, fields_, result_);
    if (!outline) return;
    outline->kind = kind;
    const auto wrong = outline_problems(fields_.file(), *outline);
    fields_.add(wrong);
    if (!wrong.empty()) return;
    const Eigen::Vector2d first = place_.pixel_of(outline->corners.front());
    if (parts_in_picture(place_, outline->corners).empty())
      return fields_.fault(outline->where,
                           std::to_string(first.x()) + ", " + std::to_string(first.y()) +
                               " and no part in the image",
                           "an outline that lies in the image, or partly");
    result_.outlines.push_back(std::move(*outline));
  }

  JsonFields fields_;
  const MapLayers& layers_;
  PicturePlace place_;
  std::int64_t image_ = 0;
  std::vector<std::int64_t> ids_;
  std::map<std::int64_t, std::string> kinds_;
  std::map<std::int64_t, std::size_t> of_others_;  // annotations by image
  LabelFile result_;
};

}  // namespace

LabelFile read_coco(const std::filesystem::path& file, const MapLayers& layers) {
  return CocoReader(file.string(), layers).read(read_json_file(file));
}

}  // namespace roadbook
