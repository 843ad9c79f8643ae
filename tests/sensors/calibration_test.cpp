#include <vector>

#include "base/random.hpp"
#include "sensors/calibration/calibration_io.hpp"
#include "tests/sensors/calibration_files.hpp"

namespace roadbook::test {
namespace {

// Rays of all pixels of a grid that the first camera sees; the second must see the same.
void expect_same_rays(const Camera& a, const Camera& b) {
  ASSERT_EQ(a.model, b.model);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  int seen = 0;
  for (int y = 0; y < a.height; y += 40)
    for (int x = 0; x < a.width; x += 40) {
      const auto ray_a = a.bearing({x, y});
      const auto ray_b = b.bearing({x, y});
      ASSERT_EQ(ray_a.has_value(), ray_b.has_value());
      if (!ray_a) continue;
      ++seen;
      EXPECT_LT(angle_between(*ray_a, *ray_b), 1e-6);
    }
  EXPECT_GT(seen, 100);
}

Camera only_camera(const std::string& name, const std::string& text) {
  const Calibration calibration = read_text(name, text);
  EXPECT_EQ(calibration.rig.cameras.size(), 1u);
  return calibration.rig.cameras.at(0).camera;
}

TEST(Calibration, TheSameFisheyeInFourFormatsSeesTheSameRays) {
  const Camera kalibr = only_camera("camchain.yaml", kKalibrFisheye);
  expect_same_rays(kalibr, only_camera("front.yaml", kOpenCvFisheye));
  expect_same_rays(kalibr, only_camera("front.yaml", kCamOdoCalFisheye));
  expect_same_rays(kalibr, only_camera("calib.json", kBasaltFisheye));
}

TEST(Calibration, TheSameMirrorCameraInTwoFormatsSeesTheSameRays) {
  expect_same_rays(only_camera("camchain.yaml", kKalibrMei),
                   only_camera("image_02.yaml", kCamOdoCalMei));
}

TEST(Calibration, TheSamePinholeInThreeFormatsSeesTheSameRays) {
  const Camera kalibr = only_camera("camchain.yaml", kKalibrPinhole);
  expect_same_rays(kalibr, only_camera("left.yaml", kRosPinhole));
  expect_same_rays(kalibr, only_camera("left.yaml", kCamOdoCalPinhole));
}

// The unified model in Basalt's words, fx x / (alpha d + (1 - alpha) z), worked by hand.
TEST(Calibration, BasaltsUnifiedModelIsOmniWithoutDistortion) {
  const Camera camera = only_camera("calib.json", R"({"value0": {
    "T_imu_cam": [{"px": 0, "py": 0, "pz": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}],
    "intrinsics": [{"camera_type": "ucm",
      "intrinsics": {"fx": 200.0, "fy": 210.0, "cx": 255.0, "cy": 250.0, "alpha": 0.6}}],
    "resolution": [[512, 512]]}})");
  EXPECT_EQ(camera.model, CameraModel::kOmni);
  const auto pixel = camera.project({2.0, 6.0, 9.0});  // of length 11
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 200.0 * 2.0 / (0.6 * 11.0 + 0.4 * 9.0) + 255.0, 1e-10);
  EXPECT_NEAR(pixel->y(), 210.0 * 6.0 / (0.6 * 11.0 + 0.4 * 9.0) + 250.0, 1e-10);
}

Rig rig_of_all_models() {
  Rig rig;
  for (const char* const text : {kKalibrFisheye, kKalibrMei, kKalibrPinhole})
    rig.cameras.push_back(read_text("camchain.yaml", text).rig.cameras.at(0));
  MountedCamera sphere;
  sphere.camera = {CameraModel::kDoubleSphere, {-0.17, 0.59, 158, 159, 255, 256}, 512, 512};
  rig.cameras.push_back(sphere);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    auto& camera = rig.cameras[i];
    camera.name = "cam" + std::to_string(i);
    camera.time_offset_s = 0.001 * static_cast<double>(i);
    camera.T_vehicle_camera =
        Eigen::Translation3d(1.0 + static_cast<double>(i), 0.3, 1.1) *
        Eigen::AngleAxisd(0.4 + static_cast<double>(i), Eigen::Vector3d(1, 2, 2) / 3.0);
  }
  return rig;
}

TEST(Calibration, AKalibrChainReadsBackAsItWasWritten) {
  const Rig rig = rig_of_all_models();
  const std::string text = kalibr_camchain_text(rig);
  // Kalibr refuses whole numbers as focal lengths.
  EXPECT_NE(text.find("158.0, 159.0, 255.0, 256.0"), std::string::npos) << text;
  const Calibration back = read_text("camchain.yaml", text);
  EXPECT_EQ(back.frame, CalibrationFrame::kBody);
  ASSERT_EQ(back.rig.cameras.size(), rig.cameras.size());
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const auto& a = rig.cameras[i];
    const auto& b = back.rig.cameras[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.camera.model, b.camera.model);
    EXPECT_EQ(a.camera.parameters, b.camera.parameters);
    EXPECT_EQ(a.camera.width, b.camera.width);
    EXPECT_EQ(a.time_offset_s, b.time_offset_s);
    EXPECT_LT((a.T_vehicle_camera.matrix() - b.T_vehicle_camera.matrix()).norm(), 1e-13);
  }
}

TEST(Calibration, BasaltsPoseIsBodyFromCameraAndItsTimeIsAdded) {
  const auto camera = read_text("calib.json", kBasaltFisheye).rig.cameras.at(0);
  // A quarter of the way and a bit around z: cos = 0.8^2 - 0.6^2, sin = 2 * 0.6 * 0.8.
  const Eigen::Vector3d p = camera.T_vehicle_camera * Eigen::Vector3d::UnitX();
  EXPECT_LT((p - Eigen::Vector3d(1.28, 1.46, 1.5)).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(camera.time_offset_s, 0.002);
}

const char* const kMoved = "[[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n";

std::string second_camera(const std::string& pose) {
  return replaced(kKalibrFisheye, "cam0", "cam1") + "  " + pose;
}

TEST(Calibration, AChainWithoutABodyHangsOnItsFirstCamera) {
  const auto chain =
      read_text("camchain.yaml",
                std::string(kKalibrFisheye) + second_camera(std::string("T_cn_cnm1: ") + kMoved));
  EXPECT_EQ(chain.frame, CalibrationFrame::kFirstCamera);
  // cam1 <- cam0 adds half a metre, so cam1 is half a metre to the left of cam0.
  EXPECT_EQ(chain.rig.cameras.at(1).T_vehicle_camera.translation().x(), -0.5);
  EXPECT_EQ(read_text("camchain.yaml", kKalibrFisheye).frame, CalibrationFrame::kNone);
}

TEST(Calibration, OpenVinsStatesTheInverseAndBothMustAgreeWithTheChain) {
  const std::string first =
      std::string(kKalibrFisheye) +
      "  T_imu_cam: [[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n";
  const auto chain =
      read_text("camchain.yaml", first + second_camera(std::string("T_cn_cnm1: ") + kMoved) +
                                     "  T_cam_imu: [[1, 0, 0, -1.5], [0, 1, 0, 0], [0, 0, 1, 0], "
                                     "[0, 0, 0, 1]]\n");
  EXPECT_EQ(chain.frame, CalibrationFrame::kBody);
  EXPECT_EQ(chain.rig.cameras.at(0).T_vehicle_camera.translation().x(), 2.0);
  EXPECT_EQ(chain.rig.cameras.at(1).T_vehicle_camera.translation().x(), 1.5);
  const auto text =
      faults_of("camchain.yaml", first + second_camera(std::string("T_cn_cnm1: ") + kMoved) +
                                     "  T_cam_imu: [[1, 0, 0, -1.4], [0, 1, 0, 0], [0, 0, 1, 0], "
                                     "[0, 0, 0, 1]]\n");
  EXPECT_NE(text.find("cam1: got a T_cn_cnm1 that contradicts T_cam_imu"), std::string::npos)
      << text;
}

struct Fault {
  const char* file;
  const char* text;
  const char* what;
  const char* by;
  const char* line;  ///< text that the message must contain
};

TEST(Calibration, EveryFaultNamesFileLineFieldGotAndWant) {
  const std::vector<Fault> faults = {
      {"camchain.yaml", kKalibrFisheye, "pinhole", "eucm",
       "camchain.yaml:3: cam0.camera_model: got eucm, want pinhole, omni or ds"},
      {"camchain.yaml", kKalibrFisheye, "0.00056406]", "0.00056406, 1]",
       "camchain.yaml:4: cam0.distortion_coeffs: got 5 numbers, want 4"},
      {"camchain.yaml", kKalibrFisheye, "[422.1", "[-422.1", "camchain.yaml:6: cam0.intrinsics"},
      {"camchain.yaml", kKalibrFisheye, "rostopic", "rostopik", "did you mean rostopic?"},
      {"camchain.yaml", kKalibrFisheye, "  rostopic: /front/image_raw",
       "  T_cam_imu: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]",
       "camchain.yaml:8: cam0.T_cam_imu: got a left-handed rotation"},
      {"camchain.yaml", kKalibrFisheye, "  rostopic: /front/image_raw",
       "  T_cam_imu: [[1, 0.1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]",
       "cam0.T_cam_imu: got a rotation off orthonormal by 0.1"},
      {"camchain.yaml", kKalibrMei, "radtan", "equidistant", "want radtan or none with omni"},
      {"front.yaml", kOpenCvFisheye, "422.13163849, 0.", "422.13163849, 1.5",
       "front.yaml:3: camera_matrix"},
      {"front.yaml", kOpenCvFisheye, "rows: 4", "rows: 5",
       "front.yaml:13: dist_coeffs.data: got 4 numbers, want 5"},
      {"front.yaml", kOpenCvFisheye, "1280, 1080", "1280.5, 1080", "resolution"},
      {"left.yaml", kRosPinhole, "e-05, 0]", "e-05, 0.3]", "want k1 k2 p1 p2, then zeros"},
      {"left.yaml", kRosPinhole, "plumb_bob", "rational", "got rational"},
      {"front.yaml", kCamOdoCalFisheye, "KANNALA_BRANDT", "SCARAMUZZA", "want MEI, KANNALA_BRANDT"},
      {"front.yaml", kCamOdoCalFisheye, "   k4: -0.00333139\n", "",
       "projection_parameters.k4: got nothing"},
      {"front.yaml", kCamOdoCalMei, "xi: 2.2134", "xi: .nan", "front.yaml:8: mirror_parameters.xi"},
      {"calib.json", kBasaltFisheye, "kb4", "eucm",
       "calib.json:6: value0.intrinsics[0].camera_type: got eucm, want ds, kb4, ucm or pinhole"},
      {"calib.json", kBasaltFisheye, "\"qw\": 0.8", "\"qw\": 0.9",
       "value0.T_imu_cam[0].qx: got a quaternion of length"},
      {"calib.json", kBasaltFisheye, "\"px\": 1.0", "\"px\": 1e999", "number overflow"},
      {"calib.json", kBasaltFisheye, "[[1280, 1080]]", "[]", "calib.json:13: value0.resolution"},
      {"calib.json", kBasaltFisheye, "{\n    \"T_imu", "\n    \"T_imu", "invalid JSON"},
      {"other.yaml", "a: 1\n", "1", "2", "none of the keys of a calibration"},
  };
  for (const Fault& fault : faults) {
    const auto text = faults_of(fault.file, replaced(fault.text, fault.what, fault.by));
    EXPECT_NE(text.find(fault.line), std::string::npos) << fault.line << "\n" << text;
  }
}

// Whatever happens to a file, it is read or refused.
TEST(Calibration, DamagedFilesAreReadOrRefusedButNeverCrash) {
  const std::string chain = kalibr_camchain_text(rig_of_all_models());
  const std::vector<std::pair<const char*, std::string>> files = {
      {"camchain.yaml", chain},          {"front.yaml", kOpenCvFisheye},
      {"front.yaml", kCamOdoCalFisheye}, {"image_02.yaml", kCamOdoCalMei},
      {"left.yaml", kRosPinhole},        {"calib.json", kBasaltFisheye}};
  const std::vector<std::string> pieces = {"[", "]",  "{",   "}",     ":",    "-",   "\n",  " ",
                                           "#", "&a", "*a",  "1e999", ".nan", "'",   "\"",  "\t",
                                           "0", "-1", "!!x", "? ",    "| ",   "...", "\xff"};
  for (std::size_t f = 0; f < files.size(); ++f) {
    const TemporaryFile file(files[f].first);
    int refused = 0;
    for (std::uint64_t i = 0; i < 500; ++i) {
      Random random(11, "calibration fuzz", 1000 * f + i);
      std::string text = files[f].second;
      for (std::uint64_t edits = 1 + random.below(4); edits > 0; --edits) {
        const std::size_t at = random.below(text.size());
        const std::size_t length = std::min<std::size_t>(random.below(12), text.size() - at);
        if (random.below(2) == 0)
          text.erase(at, length);
        else
          text.replace(at, length, pieces[random.below(pieces.size())]);
        if (text.empty()) text = " ";
      }
      file.write(text);
      try {
        for (const auto& camera : read_calibration(file.path()).rig.cameras)
          (void)camera.camera.bearing({10.0, 20.0});
      } catch (const BadInput&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, 100) << files[f].first;
  }
}

}  // namespace
}  // namespace roadbook::test
