#include "speedmap/property_map/class_refresh.hpp"
#include "speedmap/property_map/ipm.hpp"
#include "tests/speedmap/golden.hpp"

namespace roadbook {
namespace {

using nlohmann::json;
using test::expect_close;

Eigen::Vector3d vector_of(const json& v) {
  return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}

TEST(Golden, GroundPointsOfPinholesAndFisheyes) {
  ROADBOOK_REQUIRE_GOLDEN(data, "ipm");
  for (const json& c : data["cases"]) {
    Camera camera;
    const bool pinhole = c["model"] == "pinhole";
    camera.model = pinhole ? CameraModel::kPinholeRadtan : CameraModel::kKannalaBrandt;
    camera.parameters = {c["fx"], c["fy"], c["cx"], c["cy"]};
    if (!pinhole)
      for (std::size_t i = 0; i < 4; ++i) camera.parameters[4 + i] = c["kb"][i];
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 3; ++i) T.linear().row(i) = vector_of(c["R"][static_cast<std::size_t>(i)]);
    T.translation() = vector_of(c["t"]);
    const GroundPlane plane{vector_of(c["n"]), vector_of(c["r"])};
    const Eigen::Vector2d pixel(c["uv"][0].get<double>(), c["uv"][1].get<double>());

    const RayHit hit = hit_plane(vector_of(c["ray_camera"]), T, plane);
    expect_close(hit.lambda, c["lam"], 1e-10);
    EXPECT_EQ(hit.valid(), c["valid"].get<bool>());
    // lambda is long where the ray is nearly flat: the point is as good as its distance.
    const double scale = 1e-10 * (1.0 + hit.point.norm());
    EXPECT_LT((hit.point - vector_of(c["x"])).norm(), scale);

    const auto point = ground_point(camera, T, plane, pixel);
    ASSERT_EQ(point.has_value(), c["valid"].get<bool>());
    if (point) {
      EXPECT_LT((*point - vector_of(c["x"])).norm(), scale);
    }
  }
}

TEST(Golden, BatchRefreshOfTheClasses) {
  ROADBOOK_REQUIRE_GOLDEN(data, "vb_refresh");
  const auto values = data["y"].get<std::vector<double>>();
  std::vector<double> weights;
  for (const json& row : data["class_weights"])
    for (const double w : row) weights.push_back(w);
  const auto classes_of = [](const json& ng) {
    std::vector<NormalGamma> classes;
    for (std::size_t i = 0; i < 3; ++i)
      classes.push_back({ng["mu"][i], ng["lam"][i], ng["alpha"][i], ng["beta"][i]});
    return classes;
  };
  ClassRefreshOptions options;
  options.sweeps = data["sweeps"];
  options.start_sharpness = data["start_sharpness"];
  const auto got = refresh_classes(values, weights, classes_of(data["prior"]), options);
  const auto want = classes_of(data["result"]);
  for (std::size_t i = 0; i < 3; ++i) {
    expect_close(got[i].mu, want[i].mu, 1e-9);
    expect_close(got[i].lambda, want[i].lambda, 1e-9);
    expect_close(got[i].alpha, want[i].alpha, 1e-9);
    expect_close(got[i].beta, want[i].beta, 1e-9);
  }
}

}  // namespace
}  // namespace roadbook
