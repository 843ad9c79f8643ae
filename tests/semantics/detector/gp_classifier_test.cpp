#include "semantics/detector/gp_classifier.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/random.hpp"

namespace roadbook {
namespace {

struct Data {
  Eigen::MatrixXd X;
  std::vector<int> labels;
};

Data random_data(int examples, int features, std::uint64_t seed) {
  Random random(seed, "classifier");
  Data data{Eigen::MatrixXd(examples, features), {}};
  Eigen::VectorXd w(features);
  for (int j = 0; j < features; ++j) w[j] = random.normal();
  for (int i = 0; i < examples; ++i) {
    for (int j = 0; j < features; ++j) data.X(i, j) = random.normal();
    const double f = data.X.row(i).dot(w) - 0.5;
    data.labels.push_back(random.uniform(0.0, 1.0) < 1.0 / (1.0 + std::exp(-f)) ? 1 : -1);
  }
  data.labels[0] = 1;
  data.labels[1] = -1;
  return data;
}

// Rasmussen and Williams, equations 3.13 to 3.25 and 3.32, with plain inverses of the kernel
// matrix. This reference is slow and shares no algebra with the classifier.
struct Reference {
  Eigen::MatrixXd K, X;
  Eigen::VectorXd f, W, gradient;
  double scale2, bias2, log_marginal;

  Reference(const Data& data, double scale, double bias_scale)
      : X(data.X), scale2(scale * scale), bias2(bias_scale * bias_scale) {
    const Eigen::Index n = X.rows();
    K = (scale2 * X * X.transpose()).array() + bias2;
    f = Eigen::VectorXd::Zero(n);
    W = gradient = f;
    const auto evaluate = [&] {
      double log_likelihood = 0.0;
      for (Eigen::Index i = 0; i < n; ++i) {
        const double y = data.labels[static_cast<std::size_t>(i)];
        const double p = 1.0 / (1.0 + std::exp(-f[i]));
        gradient[i] = 0.5 * (y + 1.0) - p;
        W[i] = p * (1.0 - p);
        log_likelihood += -std::log(1.0 + std::exp(-y * f[i]));
      }
      return log_likelihood;
    };
    for (int i = 0; i < 60; ++i) {
      (void)evaluate();
      const Eigen::MatrixXd B = Eigen::MatrixXd::Identity(n, n) + K * W.asDiagonal();
      f = B.partialPivLu().solve(K * (W.cwiseProduct(f) + gradient));
    }
    const double log_likelihood = evaluate();
    const Eigen::MatrixXd B = Eigen::MatrixXd::Identity(n, n) + K * W.asDiagonal();
    // At the mode f = K grad, so that f K^-1 f = f grad.
    log_marginal = log_likelihood - 0.5 * f.dot(gradient) - 0.5 * std::log(B.determinant());
  }
  std::pair<double, double> latent(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd k = (scale2 * X * x).array() + bias2;
    const Eigen::MatrixXd S = K + Eigen::MatrixXd(W.cwiseInverse().asDiagonal());
    return {k.dot(gradient), scale2 * x.squaredNorm() + bias2 - k.dot(S.partialPivLu().solve(k))};
  }
};

// Simpson's rule over f, with a finer step than necessary.
double averaged_logistic(double mean, double variance) {
  const double sigma = std::sqrt(variance);
  constexpr int kSteps = 40000;
  const double h = 20.0 * sigma / kSteps;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double f = mean - 10.0 * sigma + h * i;
    const double z = (f - mean) / sigma;
    const double weight = i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    sum += weight * std::exp(-0.5 * z * z) / (1.0 + std::exp(-f));
  }
  return sum * h / 3.0 / (sigma * std::sqrt(2.0 * std::numbers::pi));
}

TEST(GpClassifier, EqualsTheTextbooksFormulasWithMoreAndWithFewerExamplesThanFeatures) {
  for (const auto& [examples, features] :
       {std::pair{60, 8}, std::pair{25, 40}, std::pair{20, 20}}) {
    SCOPED_TRACE(::testing::Message() << examples << " examples of " << features);
    const Data data = random_data(examples, features, 3);
    GpClassifierOptions options;
    options.learn_scale = false;
    options.scale = 0.7;
    options.bias_scale = 2.0;
    const GpClassifier classifier = GpClassifier::train(data.X, data.labels, options);
    const Reference reference(data, 0.7, 2.0);
    EXPECT_NEAR(classifier.log_marginal_likelihood(), reference.log_marginal, 1e-6);
    const Data other = random_data(30, features, 4);
    for (Eigen::Index i = 0; i < other.X.rows(); ++i) {
      const auto [mean, variance] = reference.latent(other.X.row(i));
      const GpPrediction got = classifier.predict(other.X.row(i));
      EXPECT_NEAR(got.mean, mean, 1e-6);
      EXPECT_NEAR(got.variance, variance, 1e-6);
      EXPECT_NEAR(got.probability, averaged_logistic(mean, variance), 1e-6);
    }
  }
}

TEST(GpClassifier, TakesTheScaleThatTheDataMakeMostLikely) {
  const Data data = random_data(200, 5, 7);
  GpClassifierOptions options;
  const GpClassifier learnt = GpClassifier::train(data.X, data.labels, options);
  options.learn_scale = false;
  for (int power = -4; power <= 4; ++power) {
    options.scale = std::pow(2.0, power);
    const Reference reference(data, options.scale, options.bias_scale);
    EXPECT_GE(learnt.log_marginal_likelihood(), reference.log_marginal - 1e-6) << power;
  }
}

TEST(GpClassifier, ProbabilitiesMeanWhatTheySayOnDataOfItsOwnKind) {
  const Data data = random_data(300, 10, 11);
  Random random(12, "weights");
  const GpClassifier classifier =
      GpClassifier::train(data.X.topRows(150), {data.labels.begin(), data.labels.begin() + 150});
  // The number of positives agrees with the mean probability.
  double predicted = 0.0;
  double found = 0.0;
  for (Eigen::Index i = 150; i < 300; ++i) {
    predicted += classifier.predict(data.X.row(i)).probability;
    found += data.labels[static_cast<std::size_t>(i)] > 0 ? 1.0 : 0.0;
  }
  // 150 draws: standard deviation of the mean below 0.04.
  EXPECT_NEAR(predicted / 150.0, found / 150.0, 0.1);
}

TEST(GpClassifier, FarFromTheExamplesItDoesNotPretendToKnow) {
  Eigen::MatrixXd X(2, 2);
  X << 1.0, 0.0, -1.0, 0.0;
  const GpClassifier classifier = GpClassifier::train(X, {1, -1});
  const GpPrediction seen = classifier.predict(Eigen::Vector2d(1.0, 0.0));
  const GpPrediction unseen = classifier.predict(Eigen::Vector2d(0.0, 5.0));
  EXPECT_GT(unseen.variance, 5.0 * seen.variance);
  EXPECT_NEAR(unseen.probability, 0.5, 1e-6);
}

// The digest is that of the exact weights, whether the classifier is trained by features or by
// examples.
TEST(GpClassifier, IsNamedByWhatItHasLearnt) {
  for (const int examples : {12, 60}) {
    Data data = random_data(examples, 20, 3);
    const GpClassifier one = GpClassifier::train(data.X, data.labels);
    GpClassifier again = GpClassifier::train(data.X, data.labels);
    again.set_shift(0.5);  // a shift from searches is not part of the training
    EXPECT_EQ(one.digest().size(), 16U);
    EXPECT_EQ(again.digest(), one.digest());
    data.X(3, 4) += 1e-9;
    EXPECT_NE(GpClassifier::train(data.X, data.labels).digest(), one.digest());
    data.X(3, 4) -= 1e-9;
    GpClassifierOptions sharper;
    sharper.calibrate = true;
    EXPECT_NE(GpClassifier::train(data.X, data.labels, sharper).digest(), one.digest());
  }
}

TEST(GpClassifier, RefusesExamplesOfOneClassAndValuesThatAreNoNumbers) {
  const Data data = random_data(6, 3, 1);
  EXPECT_THROW((void)GpClassifier::train(data.X, {1, 1, 1, 1, 1, 1}), InvalidOption);
  EXPECT_THROW((void)GpClassifier::train(data.X, {1, -1}), InvalidOption);
  EXPECT_THROW((void)GpClassifier::train(data.X, {1, -1, 0, 1, 1, 1}), InvalidOption);
  Eigen::MatrixXd bad = data.X;
  bad(2, 1) = std::nan("");
  EXPECT_THROW((void)GpClassifier::train(bad, data.labels), InvalidOption);
}

TEST(GpClassifier, SeparableClassesOfHugeFeaturesStayFinite) {
  Eigen::MatrixXd X(40, 1);
  std::vector<int> labels;
  for (int i = 0; i < 40; ++i) {
    X(i, 0) = i < 20 ? -1e3 - i : 1e3 + (i - 20);
    labels.push_back(i < 20 ? -1 : 1);
  }
  const GpClassifier classifier = GpClassifier::train(X, labels);
  const GpPrediction p = classifier.predict(Eigen::VectorXd::Constant(1, 2e3));
  EXPECT_TRUE(std::isfinite(p.mean) && std::isfinite(p.variance));
  EXPECT_GT(p.probability, 0.7);
  const GpPrediction opposite = classifier.predict(Eigen::VectorXd::Constant(1, -2e3));
  EXPECT_NEAR(p.probability + opposite.probability, 1.0, 1e-6);
}

}  // namespace
}  // namespace roadbook
