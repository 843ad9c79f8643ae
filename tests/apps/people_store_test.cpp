#include "workflows/people/people_store.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/random.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/semantics/label_map.hpp"

namespace roadbook {
namespace {

/// Layer `people` of one detection at keyframe 4 of a map whose poses are known to 3 cm and 0.2
/// degrees.
class PeopleLayer : public ::testing::Test {
 protected:
  struct Told {
    Eigen::Vector3d feet;
    double sigma_m = 0.0;
    Eigen::Matrix2d covariance;
  };
  [[nodiscard]] Told layer_of(Detection detection, const GroundModel& ground) const {
    const Map map = test::label_map(10);
    detection.t_ns = map.keyframes[4].t_ns;
    const auto file = folder_ / "place.gpkg";
    MapFileBuilder(file, "key").finish(map, {});
    MapUpdate update(file);
    write_people_layer(update, map, ground, {{"drive", {detection}, {}}});
    update.commit();
    const VectorLayer layer = MapLayers(file).read_layer("people");
    EXPECT_EQ(layer.features.size(), 1U);
    const Feature& feature = layer.features.front();
    const auto value = [&](const std::string& name) {
      for (std::size_t i = 0; i < layer.fields.size(); ++i)
        if (layer.fields[i].name == name) return std::get<double>(feature.values[i]);
      ADD_FAILURE() << name;
      return 0.0;
    };
    Told told{feature.points.front().head<3>(), value("sigma_m"), {}};
    told.covariance << value("xx_m2"), value("xy_m2"), value("xy_m2"), value("yy_m2");
    return told;
  }

  const test::Folder folder_;
  const Eigen::Isometry3d T_ = test::label_map(10).T_map_vehicle(4);
};

TEST_F(PeopleLayer, FeetStandOnTheMapsGroundStraightBelowTheVehiclesPlane) {
  const GroundModel ground = GroundModel::plane(-0.4, {0.02, -0.01});
  Detection d;
  d.x_m = 6.0;
  d.y_m = -2.0;
  const Told told = layer_of(d, ground);
  EXPECT_NEAR(told.feet.z(), *ground.height(told.feet.x(), told.feet.y()), 1e-4);
  const Eigen::Vector3d in_vehicle = T_.inverse() * told.feet;
  EXPECT_NEAR(in_vehicle.x(), 6.0, 1e-9);
  EXPECT_NEAR(in_vehicle.y(), -2.0, 1e-9);
}

// Draws random errors of the sighting and of the vehicle's pose, and compares their covariance.
TEST_F(PeopleLayer, TheCovarianceIsThatOfTheSightingAndOfThePose) {
  Detection stated;
  stated.x_m = 6.0;
  stated.y_m = -2.0;
  stated.sigma_m = 0.25;
  Detection correlated = stated;
  correlated.covariance = {0.04, 0.015, 0.01};
  const Matrix6d of_pose = test::label_map(10).keyframes[4].covariance;
  for (const Detection& d : {stated, correlated}) {
    const Eigen::Matrix2d of_sighting =
        d.covariance[0] > 0.0 ? (Eigen::Matrix2d() << 0.04, 0.015, 0.015, 0.01).finished()
                              : Eigen::Matrix2d(0.0625 * Eigen::Matrix2d::Identity());
    const Eigen::Matrix2d root = of_sighting.llt().matrixL();
    Random random(1, "feet");
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    constexpr int kDrawn = 20000;
    const Eigen::Vector2d middle = (T_ * Eigen::Vector3d(d.x_m, d.y_m, 0.0)).head<2>();
    for (int i = 0; i < kDrawn; ++i) {
      Vector6d xi;
      for (int k = 0; k < 6; ++k) xi[k] = std::sqrt(of_pose(k, k)) * random.normal();
      const Eigen::Vector2d off = root * Eigen::Vector2d(random.normal(), random.normal());
      const Eigen::Vector3d p =
          T_ * se3_exp(xi) * Eigen::Vector3d(d.x_m + off.x(), d.y_m + off.y(), 0.0);
      sum += (p.head<2>() - middle) * (p.head<2>() - middle).transpose() / kDrawn;
    }
    const Told told = layer_of(d, GroundModel::plane());
    EXPECT_LT((told.covariance - sum).norm(), 0.05 * sum.norm()) << told.covariance << '\n' << sum;
    EXPECT_NEAR(told.sigma_m * told.sigma_m,
                Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(told.covariance).eigenvalues()[1],
                1e-9);
  }
}

}  // namespace
}  // namespace roadbook
