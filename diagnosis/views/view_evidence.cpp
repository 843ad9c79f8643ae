#include "diagnosis/views/view_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "diagnosis/views/view_basis.hpp"

namespace roadbook {
namespace {

std::size_t telling_view_channel(const ViewResiduals& residuals, std::size_t channels) {
  std::vector<double> weight(channels, 0.0);
  for (const auto& r : residuals.rows) weight[r.row.channel] += r.moved * r.moved;
  return static_cast<std::size_t>(std::max_element(weight.begin(), weight.end()) - weight.begin());
}

struct ViewAxis {
  std::string name;
  double (*of)(const ViewData&, const ViewRow&);
};

double radius_px(const ViewData& data, const ViewRow& row) {
  const BundleObservation& o = data.bundle.observations[at(row.observation)];
  const Camera& camera = data.bundle.cameras[at(o.camera)].camera;
  return (o.pixel - 0.5 * Eigen::Vector2d(camera.width - 1.0, camera.height - 1.0)).norm();
}

ViewAxis axis_of(const Candidate& cause, bool view) {
  const std::string covariate = [&] {
    if (cause.kind == CandidateKind::kGrammar) return cause.covariate;
    const auto dot = cause.name.find('.');
    const std::string declared =
        cause.name.starts_with("cam") ? "cam" + cause.name.substr(dot) : cause.name;
    for (const EffectInfo& info : all_effects())
      if (info.name == declared) return std::string(info.covariate);
    return std::string();
  }();
  using D = ViewData;
  if (view && (covariate == "image radius" || covariate == "constant" || covariate.empty()))
    return {"image radius [px]", radius_px};
  if (view && (covariate == "row" || covariate == "image row"))
    return {"image row [px]", [](const D& d, const ViewRow& r) {
              return d.bundle.observations[at(r.observation)].pixel.y();
            }};
  if (covariate == "speed")
    return {"speed [m/s]",
            [](const D& d, const ViewRow& r) { return d.moments[at(r.pose)].speed; }};
  if (covariate == "turn rate")
    return {"turn rate [rad/s]",
            [](const D& d, const ViewRow& r) { return d.moments[at(r.pose)].yaw_rate; }};
  if (covariate == "acceleration")
    return {"acceleration [m/s^2]",
            [](const D& d, const ViewRow& r) { return d.moments[at(r.pose)].acceleration; }};
  return {"time [s]", [](const D& d, const ViewRow& r) { return d.moments[at(r.pose)].t_s; }};
}

}  // namespace

ViewResiduals view_residuals(const ViewSystem& system, const Eigen::VectorXd& sum) {
  ViewResiduals residuals;
  const ViewSides sides = system.sides(sum);
  system.each_pose(sides, [&](std::size_t k, const ViewPanel& values) {
    const auto& info = system.row_info(k);
    for (std::size_t i = 0; i < info.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      residuals.rows.push_back(
          {info[i],
           i > 0 && info[i].observation >= 0 && info[i - 1].observation == info[i].observation,
           values(row, 0), values(row, 1)});
    }
  });
  return residuals;
}

EvidencePlot view_evidence(const ViewData& data,
                           const std::vector<ChannelName>& channels,
                           const Candidate& cause,
                           const ViewResiduals& before,
                           const ViewResiduals& after) {
  const std::size_t channel = telling_view_channel(before, channels.size());
  const bool view = channel < data.bundle.cameras.size();
  const ViewAxis axis = axis_of(cause, view);
  EvidencePlot plot;
  plot.channel = channels[channel].stream + " " + channels[channel].channel;
  plot.covariate = axis.name;
  const auto values = [&](const ViewResiduals& residuals) {
    std::vector<EvidenceValue> all;
    for (std::size_t i = 0; i < before.rows.size(); ++i) {
      const auto& direction = before.rows[i];
      if (direction.row.channel != channel || direction.moved == 0.0) continue;
      all.emplace_back(axis.of(data, direction.row),
                       std::copysign(1.0, direction.moved) * residuals.rows[i].left);
    }
    return all;
  };
  plot.bins = evidence_bins(values(before), values(after));
  return plot;
}

}  // namespace roadbook
