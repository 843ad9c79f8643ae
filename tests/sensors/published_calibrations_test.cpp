#include <algorithm>
#include <iostream>
#include <numbers>
#include <vector>

#include "tests/sensors/calibration_files.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook::test {
namespace {

namespace fs = std::filesystem;

TEST(PublishedCalibrations, KalibrChainsAreRead) {
  ROADBOOK_REQUIRE_DATA(data, "fisheye_calib_yaml");
  const std::vector<std::string> files = {"4seasons/camchain.yaml",
                                          "open_vins_rpng_ironsides/kalibr_imucam_chain.yaml",
                                          "open_vins_rs_t265/kalibr_imucam_chain.yaml",
                                          "open_vins_tum_vi/kalibr_imucam_chain.yaml",
                                          "open_vins_uzhfpv_indoor/kalibr_imucam_chain.yaml",
                                          "open_vins_uzhfpv_indoor_45/kalibr_imucam_chain.yaml",
                                          "open_vins_uzhfpv_outdoor/kalibr_imucam_chain.yaml"};
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const Calibration chain = read_calibration(data / file);
    EXPECT_EQ(chain.frame, CalibrationFrame::kBody);
    ASSERT_EQ(chain.rig.cameras.size(), 2u);
    for (const auto& camera : chain.rig.cameras)
      EXPECT_EQ(camera.camera.model, CameraModel::kKannalaBrandt);
    // All are hand-held or head-sized rigs: 5 to 31 cm from eye to eye.
    const double baseline = (chain.rig.cameras[0].T_vehicle_camera.translation() -
                             chain.rig.cameras[1].T_vehicle_camera.translation())
                                .norm();
    EXPECT_GT(baseline, 0.05);
    EXPECT_LT(baseline, 0.31);
  }
}

TEST(PublishedCalibrations, BasaltsAreReadButForTheModelThatRoadbookLacks) {
  ROADBOOK_REQUIRE_DATA(data, "fisheye_calib_yaml");
  for (const char* const name : {"euroc_ds", "tumvi_512_ds", "t265_kb4"}) {
    const Calibration calibration = read_calibration(data / (std::string(name) + "_calib.json"));
    EXPECT_EQ(calibration.rig.cameras.size(), 2u) << name;
  }
  for (const char* const name : {"euroc_eucm", "tumvi_512_eucm"}) {
    try {
      (void)read_calibration(data / (std::string(name) + "_calib.json"));
      ADD_FAILURE() << name;
    } catch (const BadInput& bad) {
      EXPECT_EQ(bad.problems().size(), 2u);
      EXPECT_EQ(bad.problems().front().got, "eucm");
      EXPECT_GT(bad.problems().front().line, 1);
    }
  }
}

TEST(PublishedCalibrations, OpenCvFilesOfTwoSurroundRigsAreRead) {
  ROADBOOK_REQUIRE_DATA(oecs, "oecs_surround");
  ROADBOOK_REQUIRE_DATA(neozhao, "surround4_neozhao");
  for (const char* const side : {"front", "left", "back", "right"}) {
    const std::string file = std::string(side) + ".yaml";
    const Camera a = read_calibration(oecs / file).rig.cameras.at(0).camera;
    EXPECT_EQ(a.model, CameraModel::kKannalaBrandt);
    EXPECT_EQ(a.width, 0);  // the file does not say
    const Camera b = read_calibration(neozhao / "yaml" / file).rig.cameras.at(0).camera;
    EXPECT_EQ(b.model, CameraModel::kKannalaBrandt);
    EXPECT_EQ(b.width, 960);
    EXPECT_EQ(b.height, 640);
  }
}

// Every pixel of every published fisheye that has a ray leads back to itself.
TEST(PublishedCalibrations, RaysLeadBackToTheirPixels) {
  ROADBOOK_REQUIRE_DATA(data, "fisheye_calib_yaml");
  for (const auto& entry : fs::recursive_directory_iterator(data)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".yaml" && !name.ends_with("ds_calib.json") &&
        !name.ends_with("kb4_calib.json"))
      continue;
    for (const auto& mounted : read_calibration(entry.path()).rig.cameras) {
      const Camera& camera = mounted.camera;
      int seen = 0;
      for (int y = 0; y < camera.height; y += 7)
        for (int x = 0; x < camera.width; x += 7) {
          const auto ray = camera.bearing({x, y});
          if (!ray) continue;
          ++seen;
          const auto pixel = camera.project(*ray);
          ASSERT_TRUE(pixel) << entry.path() << " " << x << " " << y;
          EXPECT_LT((*pixel - Eigen::Vector2d(x, y)).norm(), 1e-8);
        }
      EXPECT_GT(seen, 0.6 * camera.width * camera.height / 49) << entry.path();
    }
  }
}

// One lens calibrated by two programs, from other recordings, in two models: within 80 degrees they
// differ by less than a pixel spans (1 / 190 rad = 0.3 degrees).
TEST(PublishedCalibrations, KannalaBrandtAndDoubleSphereOfTumViSeeTheSameRays) {
  ROADBOOK_REQUIRE_DATA(data, "fisheye_calib_yaml");
  const auto kb = read_calibration(data / "open_vins_tum_vi/kalibr_imucam_chain.yaml").rig;
  const auto ds = read_calibration(data / "tumvi_512_ds_calib.json").rig;
  for (std::size_t c = 0; c < 2; ++c) {
    std::vector<double> angles;
    for (int y = 0; y < 512; y += 4)
      for (int x = 0; x < 512; x += 4) {
        const auto a = kb.cameras[c].camera.bearing({x, y});
        const auto b = ds.cameras[c].camera.bearing({x, y});
        if (a && b && a->z() > std::cos(80.0 * std::numbers::pi / 180.0))
          angles.push_back(angle_between(*a, *b) * 180.0 / std::numbers::pi);
      }
    ASSERT_GT(angles.size(), 10000u);
    std::sort(angles.begin(), angles.end());
    const double median = angles[angles.size() / 2];
    RecordProperty("median_deg_cam" + std::to_string(c), std::to_string(median));
    RecordProperty("max_deg_cam" + std::to_string(c), std::to_string(angles.back()));
    std::cout << "cam" << c << ": median " << median << " deg, largest " << angles.back()
              << " deg of " << angles.size() << " rays within 80 deg\n";
    EXPECT_LT(angles.back(), 0.3);
    // Where the cameras look from the body: the same mounting within a degree and a centimetre.
    const Eigen::Isometry3d off =
        kb.cameras[c].T_vehicle_camera.inverse() * ds.cameras[c].T_vehicle_camera;
    EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), std::numbers::pi / 180.0);
    EXPECT_LT(off.translation().norm(), 0.01);
  }
}

}  // namespace
}  // namespace roadbook::test
