#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/ml.hpp>

#include "semantics/detector/gp_classifier.hpp"
#include "semantics/people/person_window.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

struct Crops {
  Eigen::MatrixXd X;
  std::vector<int> labels;
};

// Every second image of each folder, starting with the first or the second.
Crops read_crops(const std::filesystem::path& data, std::size_t first) {
  const PersonWindow window;
  std::vector<Eigen::VectorXd> rows;
  Crops crops;
  for (const auto& [folder, label] : {std::pair{"positive", 1}, std::pair{"negative", -1}}) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(data / folder))
      files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (std::size_t i = first; i < files.size(); i += 2) {
      cv::Mat grey = cv::imread(files[i].string(), cv::IMREAD_GRAYSCALE);
      if (grey.empty()) continue;
      cv::resize(grey, grey, {PersonWindow::kWidth, PersonWindow::kHeight}, 0, 0, cv::INTER_AREA);
      rows.push_back(window.feature(grey));
      crops.labels.push_back(label);
    }
  }
  crops.X.resize(static_cast<Eigen::Index>(rows.size()), PersonWindow::feature_size());
  for (std::size_t i = 0; i < rows.size(); ++i) crops.X.row(static_cast<Eigen::Index>(i)) = rows[i];
  return crops;
}

// Real images of people and of background; one half for training, one half for testing. The test
// compares the classifier with a linear support vector machine on the same features, and checks the
// calibration of its probabilities.
TEST(PersonCrops, TheClassifierIsAsGoodAsALinearSvmAndKnowsHowSureItIs) {
  ROADBOOK_REQUIRE_DATA(data, "inria_person_crops");
  const Crops learn = read_crops(data, 0);
  const Crops judge = read_crops(data, 1);
  ASSERT_GT(learn.labels.size(), 400U);
  GpClassifierOptions options;
  options.calibrate = true;
  const GpClassifier classifier = GpClassifier::train(learn.X, learn.labels, options);

  cv::Mat features(static_cast<int>(learn.X.rows()), static_cast<int>(learn.X.cols()), CV_32F);
  cv::Mat labels(features.rows, 1, CV_32S);
  for (int i = 0; i < features.rows; ++i) {
    labels.at<int>(i) = learn.labels[static_cast<std::size_t>(i)];
    for (int j = 0; j < features.cols; ++j)
      features.at<float>(i, j) = static_cast<float>(learn.X(i, j));
  }
  const auto svm = cv::ml::SVM::create();
  svm->setType(cv::ml::SVM::C_SVC);
  svm->setKernel(cv::ml::SVM::LINEAR);
  // C by cross-validation on the training half.
  svm->trainAuto(features, cv::ml::ROW_SAMPLE, labels, 5);

  double right = 0.0;
  double svm_right = 0.0;
  constexpr int kBins = 10;
  std::array<double, kBins> count{};
  std::array<double, kBins> said{};
  std::array<double, kBins> was{};
  const auto n = static_cast<double>(judge.labels.size());
  for (std::size_t i = 0; i < judge.labels.size(); ++i) {
    const Eigen::VectorXd x = judge.X.row(static_cast<Eigen::Index>(i));
    const double p = classifier.predict(x).probability;
    const bool person = judge.labels[i] > 0;
    right += (p > 0.5) == person ? 1.0 : 0.0;
    cv::Mat row(1, features.cols, CV_32F);
    for (int j = 0; j < row.cols; ++j) row.at<float>(j) = static_cast<float>(x[j]);
    svm_right += (svm->predict(row) > 0.0F) == person ? 1.0 : 0.0;
    const auto bin = static_cast<std::size_t>(std::min(kBins - 1, static_cast<int>(kBins * p)));
    count[bin] += 1.0;
    said[bin] += p;
    was[bin] += person ? 1.0 : 0.0;
  }
  double error = 0.0;
  for (std::size_t b = 0; b < kBins; ++b) error += std::abs(said[b] - was[b]) / n;
  std::cout << "held out: " << judge.labels.size() << " crops, accuracy " << right / n
            << ", linear SVM " << svm_right / n << ", calibration error " << error << ", sharpness "
            << classifier.sharpness() << ", scale " << classifier.scale() << '\n';
  RecordProperty("accuracy", std::to_string(right / n));
  RecordProperty("svm_accuracy", std::to_string(svm_right / n));
  RecordProperty("calibration_error", std::to_string(error));
  // Random difference of the two on this number of crops: one standard deviation at an error rate
  // of 3 %.
  EXPECT_GT(right / n, svm_right / n - std::sqrt(0.03 * 0.97 / n));
  EXPECT_LT(error, 0.05);
}

}  // namespace
}  // namespace roadbook
