#include "workflows/people/people_truth.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "drive/csv.hpp"
#include "drive/true_poses.hpp"
#include "workflows/people/seen_share.hpp"
#include "workflows/people/truth_scene.hpp"

namespace roadbook {

PeopleTruth::PeopleTruth(const Drive& drive)
    : poses_(true_poses(drive)), blockers_(read_world_blockers(drive.folder())) {
  const auto folder = drive.folder() / "truth";
  const auto world = nlohmann::json::parse(
      read_regular_file(folder / "world.json", "the truth of a simulated drive"), nullptr, false);
  const auto raster = world.value("/ground/raster"_json_pointer, nlohmann::json::object());
  if (raster.contains("height")) {
    heights_ = raster.at("height").get<std::vector<std::vector<double>>>();
    low_ = {raster.at("low").at(0).get<double>(), raster.at("low").at(1).get<double>()};
    step_m_ = raster.at("step").get<double>();
  }
  ProblemList problems;
  CsvReader csv(folder / "pedestrians.csv", CsvHeader::kRequired, problems);
  const auto height_column = csv.good() ? csv.find("height") : std::nullopt;
  while (csv.good() && csv.next()) {
    const auto t = csv.stamp(0);
    const auto id = csv.number(1);
    const auto x = csv.number(2);
    const auto y = csv.number(3);
    Row row;
    const auto height = height_column ? csv.number(*height_column) : std::optional(row.height_m);
    if (!t || !id || !x || !y || !height) continue;
    rows_.push_back({*t, static_cast<int>(*id), {*x, *y}, *height});
  }
  if (problems.has_errors()) throw BadInput(problems.problems());
}

double PeopleTruth::ground_at(const Eigen::Vector2d& place, double otherwise) const {
  if (heights_.size() < 2 || heights_.front().size() < 2) return otherwise;
  const Eigen::Vector2d at = (place - low_) / step_m_;
  const auto clamped = [](double v, std::size_t count) {
    return std::clamp(v, 0.0, static_cast<double>(count) - 1.001);
  };
  const double u = clamped(at.x(), heights_.front().size());
  const double v = clamped(at.y(), heights_.size());
  const auto i = static_cast<std::size_t>(u);
  const auto j = static_cast<std::size_t>(v);
  const double a = u - static_cast<double>(i);
  const double b = v - static_cast<double>(j);
  return (1 - b) * ((1 - a) * heights_[j][i] + a * heights_[j][i + 1]) +
         b * ((1 - a) * heights_[j + 1][i] + a * heights_[j + 1][i + 1]);
}

// Rows are 0.1 s apart. The function interpolates linearly between two rows.
Eigen::Vector2d PeopleTruth::place_at(std::vector<Row>::const_iterator row,
                                      std::int64_t t_ns) const {
  constexpr std::int64_t kLongest_ns = 150'000'000;
  for (auto before = row; before != rows_.begin();) {
    --before;
    if (before->t_ns < t_ns - kLongest_ns) break;
    if (before->id != row->id || before->t_ns >= t_ns) continue;
    const double part =
        static_cast<double>(t_ns - before->t_ns) / static_cast<double>(row->t_ns - before->t_ns);
    return before->place + part * (row->place - before->place);
  }
  return row->place;
}

std::vector<PeopleTruth::Standing> PeopleTruth::standing_at(std::int64_t t_ns,
                                                            const Eigen::Isometry3d& T) const {
  std::vector<Standing> standing;
  const auto after = std::lower_bound(rows_.begin(), rows_.end(), t_ns,
                                      [](const Row& row, std::int64_t t) { return row.t_ns < t; });
  for (auto row = after; row != rows_.end() && row->t_ns == after->t_ns; ++row) {
    const Eigen::Vector2d place = place_at(row, t_ns);
    const double z = ground_at(place, T.translation().z());
    standing.push_back({T.inverse() * Eigen::Vector3d(place.x(), place.y(), z), row->height_m});
  }
  return standing;
}

PeopleTruth::Instant PeopleTruth::at(std::int64_t t_ns,
                                     const std::vector<PersonCamera>& cameras,
                                     double min_range_m,
                                     double max_range_m) const {
  Instant instant;
  const auto pose = std::lower_bound(poses_.begin(), poses_.end(), t_ns,
                                     [](const TimedPose& p, std::int64_t t) { return p.t_ns < t; });
  if (pose == poses_.end() || pose->t_ns != t_ns) return instant;
  const Eigen::Isometry3d& T = pose->T_world_vehicle;
  const std::vector<Standing> standing = standing_at(t_ns, T);
  std::vector<std::vector<PersonInView>> views(cameras.size());
  for (std::size_t c = 0; c < cameras.size(); ++c)
    for (const Standing& one : standing)
      views[c].push_back(
          person_in_view(static_cast<int>(c), cameras[c].mounted(), one.foot, one.height_m));
  for (std::size_t i = 0; i < standing.size(); ++i) {
    instant.feet.emplace_back(standing[i].foot.head<2>());
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const auto& [box, far_m] = views[c][i];
      if (far_m > kListedRange * max_range_m || !cameras[c].sees(box.azimuth, box.foot_slope) ||
          !cameras[c].sees(box.azimuth, box.foot_slope + box.size))
        continue;
      const bool clear =
          far_m >= min_range_m && far_m <= max_range_m &&
          seen_share(views[c][i], views[c], cameras[c].mounted(), T, blockers_) >= kReasonableShare;
      instant.people.push_back({box, clear});
      instant.who.push_back(static_cast<int>(i));
    }
  }
  return instant;
}

}  // namespace roadbook
