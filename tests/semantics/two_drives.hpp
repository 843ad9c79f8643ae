#pragma once

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "semantics/labels/label_evidence.hpp"
#include "tests/semantics/overhead_scene.hpp"

// Two drives through a car park with fisheyes. Between the drives, a part of a row is painted again
// at another place, and cars come and go.

namespace roadbook::test {

constexpr int kSpaces = 14;  // on each side
constexpr double kWide = 2.5;
constexpr double kNear = 3.0;  // from the aisle's middle
constexpr double kDeep = 5.0;
constexpr int kKeyframes = 2 * kSpaces + 8;  // in each session

struct CarPark {
  std::set<int> repainted;     ///< spaces on the left with lines that moved by half a space
  std::map<int, double> cars;  ///< grey value of the car on a space; negative numbers: right side
  double grain = 6.0;

  double grey(double x, double y) const {
    const double side = y > 0.0 ? 1.0 : -1.0;
    const double across = std::abs(y) - kNear;
    const auto hash = static_cast<std::uint32_t>(std::floor(x * 13.0)) * 2654435761U ^
                      static_cast<std::uint32_t>(std::floor(y * 11.0)) * 40503U;
    const double ground = 95.0 + grain * (static_cast<double>(hash % 1000U) / 500.0 - 1.0);
    if (across < -0.06 || across > kDeep + 0.06 || x < -0.06 || x > kSpaces * kWide + 0.06)
      return ground;
    const int space = static_cast<int>(x / kWide);
    const auto car = cars.find(side > 0.0 ? space : -1 - space);
    const double in_space = x - space * kWide;
    if (car != cars.end() && in_space > 0.3 && in_space < 2.2 && across > 0.4 && across < 4.7)
      return car->second;
    const double offset = side > 0.0 && repainted.contains(space) ? 0.5 * kWide : 0.0;
    const double beside = std::abs(std::remainder(x - offset, kWide));
    return beside < 0.06 || across > kDeep - 0.06 ? 190.0 : ground;
  }
};

struct TwoDrives {
  Map map;
  CarPark first;
  CarPark second;
  mutable std::map<std::pair<int, int>, cv::Mat> rendered;

  TwoDrives() {
    for (int s = 0; s < 2; ++s) {
      Session session;
      session.name = "drive" + std::to_string(s);
      session.rig = four_fisheyes(400, 300);
      session.t_begin_ns = (1 + s) * std::int64_t{1'000'000'000'000};
      map.sessions.push_back(session);
      for (int i = 0; i < kKeyframes; ++i) {
        Keyframe k;
        k.session = s;
        k.t_ns = session.t_begin_ns + i * std::int64_t{100'000'000};
        map.sessions.back().t_end_ns = k.t_ns;
        k.map_frame = static_cast<int>(map.keyframes.size());
        k.covariance.setZero();
        k.covariance.diagonal().setConstant(1e-4);
        const double way = -4.0 + 0.5 * kWide * i + 0.3 * s;
        map.map_frames.push_back({pose_from_planar(way, 0.2 - 0.5 * s, 0.02 * s)});
        map.keyframes.push_back(k);
      }
    }
  }
  std::vector<Label> spaces() const {
    std::vector<Label> labels;
    for (int i = 0; i < 2 * kSpaces; ++i) {
      const double side = i < kSpaces ? 1.0 : -1.0;
      const OrientedBox box{{(i % kSpaces + 0.5) * kWide, side * (kNear + 0.5 * kDeep)},
                            side * 0.5 * M_PI,
                            kDeep,
                            kWide};
      const auto corners = box.corners();
      const auto views = central_views(map, {corners.begin(), corners.end()}, 0);
      EXPECT_FALSE(views.empty());
      labels.push_back(label_of_box(map, views.at(0), box));
      labels.back().id = i;
      labels.back().kind = "parking_space";
    }
    return labels;
  }
  // The images that the vehicle saw from its true poses `T_true`.
  KeyframeImages images(const std::vector<Eigen::Isometry3d>& T_true) const {
    return [this, T_true](int keyframe, int camera) {
      cv::Mat& image = rendered[{keyframe, camera}];
      const auto k = static_cast<std::size_t>(keyframe);
      const CarPark& park = map.keyframes[k].session == 0 ? first : second;
      if (image.empty())
        image = render(map.sessions[0].rig.cameras[static_cast<std::size_t>(camera)], T_true[k],
                       {.grey = [&](double x, double y) { return park.grey(x, y); }});
      return image;
    };
  }
  std::vector<Eigen::Isometry3d> poses() const {
    std::vector<Eigen::Isometry3d> poses;
    for (std::size_t k = 0; k < map.keyframes.size(); ++k)
      poses.push_back(map.T_map_vehicle(static_cast<int>(k)));
    return poses;
  }
};

}  // namespace roadbook::test
