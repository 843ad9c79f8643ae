#include "workflows/labels/label_place.hpp"

#include <cmath>
#include <opencv2/core.hpp>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "mapping/layers/map_layers.hpp"
#include "workflows/labels/learning_record.hpp"
#include "workflows/people/people_store.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

GroundImage read_overhead(const MapLayers& layers) {
  if (!layers.has("overhead")) return {};
  const RasterInfo info = layers.raster_info("overhead");
  const cv::Mat pixels = layers.read_raster("overhead", {0, 0, info.width, info.height});
  GroundImage image;
  cv::extractChannel(pixels, image.grey, 0);
  if (image.grey.depth() != CV_8U)
    throw BadInput({Severity::kError, layers.file().string(), 0, "layer overhead",
                    "pixels of another type", "8 bit"});
  image.seen = image.grey > 0;
  image.corner = info.corner;
  image.resolution_m = info.resolution_m;
  return image;
}

}  // namespace

Problem no_overhead_image(const std::filesystem::path& map) {
  return {Severity::kError, map.string(), 0,
          "layer overhead", "none",       "an overhead image (roadbook overhead -m MAP makes it)"};
}

LabelPlace read_label_place(const std::filesystem::path& map) {
  const MapLayers layers(map);
  LabelPlace place;
  place.name = map.stem().string();
  place.image = read_overhead(layers);
  place.classes = read_label_classes(layers);
  const StoredLearning learnt = read_stored_learning(layers);
  place.learnt_picture = learnt.picture;
  place.learnt_record = learnt.record;
  place.sightings = read_label_sightings(layers);
  place.people = read_person_examples(layers);
  place.people_record = read_people_record(layers);
  if (layers.has("lanes"))
    for (const Feature& lane : layers.read_layer("lanes").features) {
      Json line = Json::array();
      for (const auto& p : lane.points) line.push_back({p.x(), p.y()});
      place.lanes.push_back(line);
    }
  return place;
}

std::string map_version(const Map& map) {
  Sha256 digest;
  for (const Session& session : map.sessions) digest.update(session.drive_digest + "\n");
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Eigen::Matrix4d pose = map.T_map_vehicle(static_cast<int>(k)).matrix();
    digest.update(std::int64_t{map.keyframes[k].session}).update(map.keyframes[k].t_ns);
    for (const double number : pose.reshaped()) digest.update(number);
  }
  return digest.hex().substr(0, 16);
}

std::string place_version(const Map& map) {
  Sha256 digest;
  if (!map.sessions.empty()) digest.update(map.sessions.front().drive_digest);
  return digest.hex().substr(0, 16);
}

std::string picture_version(const GroundImage& image) {
  if (image.grey.empty()) return {};
  Sha256 digest;
  for (int row = 0; row < image.grey.rows; ++row)
    digest.update(
        std::string_view(image.grey.ptr<char>(row), static_cast<std::size_t>(image.grey.cols)));
  return digest.hex().substr(0, 16);
}

Json poses_json(const Map& map) {
  std::vector<Json> lines(map.sessions.size(), Json::array());
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Eigen::Isometry3d pose = map.T_map_vehicle(static_cast<int>(k));
    lines[static_cast<std::size_t>(map.keyframes[k].session)].push_back(
        {pose.translation().x(), pose.translation().y(),
         std::atan2(pose.linear()(1, 0), pose.linear()(0, 0)),
         std::to_string(map.keyframes[k].t_ns)});
  }
  return lines;
}

}  // namespace roadbook
