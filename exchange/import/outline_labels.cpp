#include "exchange/import/outline_labels.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "exchange/import/outline_shape.hpp"
#include "semantics/labels/label_check.hpp"

namespace roadbook {
namespace {

// Whether the second side, not the first, is the one along the heading.
bool is_across(const Eigen::Vector2d& along, const Eigen::Vector2d& across, double heading_rad) {
  const Eigen::Vector2d ahead(std::cos(heading_rad), std::sin(heading_rad));
  return std::abs(ahead.dot(across.normalized())) > std::abs(ahead.dot(along.normalized()));
}

// `heading_rad`: where it is known, roughly. Else of corners from ahead on the right; of somebody
// else's, along the longer side, and either way round: what is clockwise begins one corner later.
OrientedBox box_of(const std::vector<Eigen::Vector2d>& c,
                   const std::optional<double>& heading_rad) {
  OrientedBox box;
  box.centre = 0.25 * (c[0] + c[1] + c[2] + c[3]);
  Eigen::Vector2d along = 0.5 * (c[0] + c[1]) - box.centre;
  Eigen::Vector2d across = 0.5 * (c[1] + c[2]) - box.centre;
  if (heading_rad ? is_across(along, across, *heading_rad)
                  : across.norm() > along.norm() * (1.0 + 1e-9))
    std::swap(along, across);
  if (heading_rad && along.dot(Eigen::Vector2d(std::cos(*heading_rad), std::sin(*heading_rad))) < 0)
    along = -along;
  box.heading = std::atan2(along.y(), along.x());
  box.length_m = 2.0 * along.norm();
  box.width_m = 2.0 * across.norm();
  return box;
}

std::vector<Eigen::Vector2d> outline_in_map(const Map& map, const Label& label) {
  std::vector<Eigen::Vector2d> corners;
  for (const Eigen::Vector3d& corner : corners_in_map(map, label))
    corners.emplace_back(corner.head<2>());
  return corners;
}

// A file has the box as it looks from above; on a slope its sides are longer than that.
Label label_of_seen_box(const Map& map, const LabelAnchor& anchor, const OrientedBox& seen) {
  Label label = label_of_box(map, anchor, seen);
  const OrientedBox from_above = box_of(outline_in_map(map, label), seen.heading);
  if (from_above.length_m <= 0.0 || from_above.width_m <= 0.0) return label;  // refused later
  label.length_m *= seen.length_m / from_above.length_m;
  label.width_m *= seen.width_m / from_above.width_m;
  return label;
}

// The drawing's part of a sigma in a file; the pose's part is added at the place of the label.
double drawing_sigma(const Map& map, Label label, const std::optional<double>& of_place) {
  constexpr double kFinestM = 0.01;
  if (!of_place) return kFoundSigma_m;  // nobody says whose hand it was: a search's, then
  label.sigma_m = 0.0;
  const double of_pose = sigma_in_map(map, label).value_or(0.0);
  return std::sqrt(std::max(*of_place * *of_place - of_pose * of_pose, kFinestM * kFinestM));
}

bool becomes_box(const LabelOutline& outline, const std::vector<LabelClass>& classes) {
  if (!is_rectangle(outline.corners, rectangle_tolerance(outline))) return false;
  if (outline.shape) return outline.shape == LabelShape::kBox;
  return std::none_of(classes.begin(), classes.end(),
                      [&](const LabelClass& c) { return c.kind == outline.kind && !c.box; });
}

// A new label in the shape of an outline; empty and a problem where no image shows its ground.
std::optional<Label> label_in_map(const KeyframeIndex& keyframes,
                                  const LabelOutline& outline,
                                  const std::vector<LabelClass>& classes,
                                  const std::string& file,
                                  const std::optional<LabelAnchor>& now,
                                  std::vector<Problem>& problems) {
  const Map& map = keyframes.map();
  const auto anchor = anchor_for(keyframes, outline.corners, now);
  if (!anchor) {
    problems.push_back({Severity::kError, file, outline.line, outline.where,
                        "an area that no camera image shows completely",
                        "an area that one image shows completely"});
    return std::nullopt;
  }
  Label label = becomes_box(outline, classes)
                    ? label_of_seen_box(map, *anchor, box_of(outline.corners, outline.heading_rad))
                    : label_of_polygon(map, *anchor, outline.corners);
  label.kind = outline.kind;
  label.score = outline.score;
  label.source = LabelSource::kDrawn;
  label.sigma_m = drawing_sigma(map, label, outline.sigma_m);
  label.note = outline.note;
  try {
    check_new_label(label, file);
  } catch (const BadInput& bad) {
    const Problem& wrong = bad.problems().front();
    problems.push_back({Severity::kError, file, outline.line, outline.where,
                        wrong.field + " " + wrong.got, wrong.want});
  }
  return label;
}

// The label as an edit leaves it: as if a hand had moved it on the page.
std::optional<Label> edited_label(const KeyframeIndex& keyframes,
                                  const LabelEdit& edit,
                                  const std::vector<LabelClass>& classes,
                                  const std::string& file,
                                  std::vector<Problem>& problems) {
  Label label = edit.before;
  if (edit.shape) {
    const auto drawn =
        label_in_map(keyframes, edit.outline, classes, file, edit.before.anchor, problems);
    if (!drawn) return std::nullopt;
    label = *drawn;
    label.id = edit.before.id;
    label.version = edit.before.version;
    label.source = edit.before.source;
    label.score = edit.before.score;
    label.sigma_m = Label().sigma_m;
  }
  label.kind = edit.outline.kind;
  label.note = edit.outline.note;
  return label;
}

}  // namespace

NewLabels labels_of_outlines(const Map& map,
                             const MatchedLabels& matched,
                             const std::vector<LabelClass>& classes,
                             const std::string& file) {
  NewLabels labels;
  std::vector<Problem> problems;
  const KeyframeIndex keyframes(map);
  for (const LabelOutline& outline : matched.fresh)
    if (auto label = label_in_map(keyframes, outline, classes, file, std::nullopt, problems))
      labels.created.push_back(std::move(*label));
  for (const LabelEdit& edit : matched.edits)
    if (auto label = edited_label(keyframes, edit, classes, file, problems))
      labels.changed.push_back(std::move(*label));
  if (!problems.empty()) throw BadInput(problems);
  return labels;
}

}  // namespace roadbook
