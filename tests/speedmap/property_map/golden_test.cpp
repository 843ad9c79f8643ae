#include "tests/speedmap/golden.hpp"

#include <cmath>
#include <map>

#include "speedmap/property_map/interpolation.hpp"
#include "speedmap/property_map/kernel.hpp"
#include "speedmap/property_map/mixture.hpp"
#include "speedmap/property_map/projection.hpp"
#include "speedmap/property_map/property_map.hpp"

// The expected values come from another program that computed with 40 digits. The tolerances are
// those in its README.

namespace roadbook {
namespace {

using nlohmann::json;
using test::expect_close;

Knots knots_of(const json& data) {
  std::vector<PathPlace> places;
  for (const json& node : data["nodes"]) places.push_back({node[0], node[1]});
  std::optional<double> period;
  if (data.contains("period") && !data["period"].is_null()) period = data["period"].get<double>();
  return {std::move(places), {data["D"][0], data["D"][1]}, period};
}

std::vector<NormalGamma> classes_of(const json& data) {
  std::vector<NormalGamma> classes;
  for (std::size_t i = 0; i < data["mu"].size(); ++i)
    classes.push_back({data["mu"][i], data["lam"][i], data["alpha"][i], data["beta"][i]});
  return classes;
}

const std::map<std::string, NormalGammaProjection> kNormalGamma = {
    {"predictive", NormalGammaProjection::kPredictive},
    {"natural", NormalGammaProjection::kNatural},
    {"kl", NormalGammaProjection::kKl},
    {"printed", NormalGammaProjection::kPrinted}};
const std::map<std::string, DirichletProjection> kDirichlet = {
    {"trace", DirichletProjection::kTrace},
    {"frac", DirichletProjection::kFractional},
    {"printed", DirichletProjection::kPrinted}};

// "predictive+trace" -> its two halves.
struct Names {
  std::string normal_gamma, dirichlet;
};
Names split_name(const std::string& name) {
  const std::size_t plus = name.find('+');
  return {name.substr(0, plus), name.substr(plus + 1)};
}

PropertyMapPrior prior_of(const json& data, std::size_t K) {
  PropertyMapPrior prior;
  prior.classes.resize(K, "class");
  prior.counts.assign(K, 1.0);
  PropertyPrior property;
  property.min = -100.0;
  property.max = 100.0;
  property.classes = classes_of(data);
  prior.properties.push_back(property);
  return prior;
}

PropertyMapOptions plain_options() {
  PropertyMapOptions options;
  options.semantics = SemanticModel::kGeometricPool;
  options.outlier_weight = 0.0;
  options.gate_counts = 0.0;
  options.prior_mean_sigma = 0.0;
  return options;
}

void set_beliefs(PropertyMap& map, const json& a) {
  for (std::size_t l = 0; l < map.knots().size(); ++l)
    map.set_belief(l, a[a.size() == 1 ? 0 : l].get<std::vector<double>>(), 0.0);
}

void expect_beliefs(const PropertyMap& map, const json& a, double rel) {
  for (std::size_t l = 0; l < map.knots().size(); ++l)
    for (std::size_t i = 0; i < map.classes(); ++i) expect_close(map.belief(l)[i], a[l][i], rel);
}

TEST(Golden, KernelAndItsDerivative) {
  ROADBOOK_REQUIRE_GOLDEN(data, "kernel_interp");
  for (const json& c : data["cases"]) {
    if (c["type"] != "kernel") continue;
    for (std::size_t i = 0; i < c["r"].size(); ++i) {
      const double r = c["r"][i];
      expect_close(sparse_kernel(r), c["k"][i], 1e-10, 1e-12);
      expect_close(sparse_kernel_derivatives(r).first_over_r * r, c["dk_dr"][i], 1e-10, 1e-12);
    }
  }
}

TEST(Golden, InterpolationOnOpenClosedAndAnisotropicGrids) {
  ROADBOOK_REQUIRE_GOLDEN(data, "kernel_interp");
  int judged = 0;
  for (const json& c : data["cases"]) {
    if (c["type"] != "interp") continue;
    const Knots knots = knots_of(c);
    Interpolation result;
    InterpolationDerivatives derivatives;
    interpolate(knots, {c["v"][0], c["v"][1]}, result, derivatives);
    ASSERT_EQ(result.covered(), c["covered"].get<bool>());
    if (!result.covered()) continue;
    expect_close(result.kernel_sum, c["kernel_sum"], 1e-10, 1e-12);
    ASSERT_EQ(result.size(), c["active"].size());
    for (std::size_t i = 0; i < result.size(); ++i) {
      const auto& active = c["active"];
      const auto place = std::find(active.begin(), active.end(), result.knots[i]);
      ASSERT_NE(place, active.end());
      const auto n = static_cast<std::size_t>(place - active.begin());
      expect_close(result.weights[i], c["I"][n], 1e-10, 1e-12);
      expect_close(derivatives.gradients[i].x(), c["dI"][n][0], 1e-10, 1e-12);
      expect_close(derivatives.gradients[i].y(), c["dI"][n][1], 1e-10, 1e-12);
    }
    ++judged;
  }
  EXPECT_GE(judged, 20);
}

TEST(Golden, LabelsByTheGeometricAndTheLinearPool) {
  ROADBOOK_REQUIRE_GOLDEN(data, "dirichlet_update");
  for (const json& c : data["cases"]) {
    const std::size_t K = c["a"][0].size();
    PropertyMapPrior prior;
    prior.classes.resize(K, "class");
    prior.counts.assign(K, 1.0);
    const auto run = [&](const PropertyMapOptions& options, int label, double weight) {
      PropertyMap map(knots_of(c), prior, options);
      set_beliefs(map, c["a"]);
      EXPECT_TRUE(map.add_label({c["v"][0], c["v"][1]}, label, weight));
      return map;
    };
    PropertyMapOptions options = plain_options();
    if (c["type"] == "hard_label") {
      expect_beliefs(run(options, c["c"], c["weight"]), c["a_post"], 1e-10);
      continue;
    }
    // Its likelihood is the column of a confusion matrix whose rows are completed by a last label.
    options.semantics = SemanticModel::kLinearPool;
    for (std::size_t i = 0; i < K; ++i)
      for (std::size_t label = 0; label < K; ++label) {
        const double p = c["likelihood"][i];
        options.confusion.push_back(label == 0 ? p : label == 1 ? 1.0 - p : 0.0);
      }
    for (const auto& [name, projection] : kDirichlet) {
      if (name == "printed") continue;
      options.dirichlet = projection;
      expect_beliefs(run(options, 0, 1.0), c["a_post"][name], 1e-10);
    }
  }
}

TEST(Golden, OnePropertyMeasurementInFiveProjections) {
  ROADBOOK_REQUIRE_GOLDEN(data, "property_update");
  for (const json& c : data["cases"]) {
    const std::size_t K = c["K"];
    const std::size_t L = c["L"];
    const std::vector<NormalGamma> classes = classes_of(c);
    std::vector<double> shares;
    for (const json& a : c["a"]) {
      double sum = 0.0;
      for (const double x : a) sum += x;
      for (const double x : a) shares.push_back(x / sum);
    }
    PropertyMixture mixture;
    mixture_posterior(c["y"], c["I"].get<std::vector<double>>(), shares, classes, {}, mixture);
    expect_close(mixture.log_evidence, c["log_evidence"], 1e-10);
    for (std::size_t j = 0; j < K; ++j) {
      expect_close(mixture.log_c[j], c["log_c"][j], 1e-10);
      expect_close(mixture.q[j], c["q"][j], 1e-10);
      for (std::size_t l = 0; l < L; ++l)
        expect_close(mixture.rho[l * K + j], c["rho"][l][j], 1e-10);
    }
    for (const auto& [name, want] : c["posterior"].items()) {
      SCOPED_TRACE(name);
      const Names names = split_name(name);
      const double rel = names.normal_gamma == "kl" ? 1e-8 : 1e-10;
      for (std::size_t j = 0; j < K; ++j) {
        const NormalGamma got = project_mixture_unguarded(classes[j], c["y"], mixture.q[j],
                                                          kNormalGamma.at(names.normal_gamma));
        expect_close(got.mu, want["mu"][j], rel);
        expect_close(got.lambda, want["lam"][j], rel);
        expect_close(got.alpha, want["alpha"][j], rel);
        expect_close(got.beta, want["beta"][j], rel);
      }
      for (std::size_t l = 0; l < L; ++l) {
        auto a = c["a"][l].get<std::vector<double>>();
        project_dirichlet(a, {&mixture.rho[l * K], K}, kDirichlet.at(names.dirichlet));
        for (std::size_t j = 0; j < K; ++j) expect_close(a[j], want["a"][l][j], 1e-10);
      }
    }
  }
}

TEST(Golden, TwoHundredMixedUpdatesOnFiftyKnots) {
  ROADBOOK_REQUIRE_GOLDEN(data, "sequence");
  for (const json& c : data["cases"]) {
    const std::string name = c["projection"];
    SCOPED_TRACE(name);
    PropertyMapOptions options = plain_options();
    options.normal_gamma = kNormalGamma.at(split_name(name).normal_gamma);
    options.dirichlet = kDirichlet.at(split_name(name).dirichlet);
    PropertyMap map(knots_of(data), prior_of(data, data["mu"].size()), options);
    set_beliefs(map, data["a"]);
    std::size_t done = 0;
    for (const json& checkpoint : c["checkpoints"]) {
      for (; done < checkpoint["after"].get<std::size_t>(); ++done) {
        const json& update = data["updates"][done];
        const PathPlace v{update["v"][0], update["v"][1]};
        if (update["type"] == "semantic") {
          ASSERT_TRUE(map.add_label(v, update["c"], update["weight"]));
        } else {
          ASSERT_EQ(map.add_value(0, v, update["y"]).status, PropertyUpdate::kDone);
        }
      }
      // The root of the KL projection is good to 1e-10 an update.
      const double rel = name.starts_with("kl") ? 1e-8 : 1e-9;
      expect_beliefs(map, checkpoint["a"], rel);
      const std::vector<NormalGamma> want = classes_of(checkpoint);
      for (std::size_t i = 0; i < want.size(); ++i) {
        expect_close(map.property(0)[i].mu, want[i].mu, rel);
        expect_close(map.property(0)[i].lambda, want[i].lambda, rel);
        expect_close(map.property(0)[i].alpha, want[i].alpha, rel);
        expect_close(map.property(0)[i].beta, want[i].beta, rel);
      }
    }
  }
}

TEST(Golden, MomentsAndTheirGradients) {
  ROADBOOK_REQUIRE_GOLDEN(data, "likelihood_moments");
  for (const json& c : data["cases"]) {
    const json& state = c["state"];
    PropertyMap map(knots_of(c), prior_of(state, state["mu"].size()), plain_options());
    set_beliefs(map, state["a"]);
    for (const json& point : c["points"]) {
      const PathPlace v{point["v"][0], point["v"][1]};
      const auto got = map.moments_with_derivatives(0, v);
      ASSERT_TRUE(got);
      expect_close(got->mean, point["mean"], 1e-10, 1e-12);
      expect_close(got->variance, point["variance"], 1e-10, 1e-12);
      for (int k = 0; k < 2; ++k) {
        const auto n = static_cast<std::size_t>(k);
        expect_close(got->d_mean[k], point["dmean"][n], 1e-10, 1e-12);
        expect_close(got->d_variance[k], point["dvariance"][n], 1e-10, 1e-12);
      }
      EXPECT_EQ(map.moments(0, v)->mean, got->mean);
      EXPECT_EQ(map.moments(0, v)->variance, got->variance);
    }
  }
}

}  // namespace
}  // namespace roadbook
