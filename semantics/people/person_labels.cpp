#include "semantics/people/person_labels.hpp"

#include <opencv2/imgcodecs.hpp>

#include "base/error.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/people/person_window.hpp"

namespace roadbook {
namespace {

cv::Mat decoded(const std::string& png, const std::string& table, const std::string& field) {
  const cv::Mat bytes(1, static_cast<int>(png.size()), CV_8U, const_cast<char*>(png.data()));
  cv::Mat crop = png.empty() ? cv::Mat() : cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
  if (crop.cols != PersonWindow::kWidth + 2 || crop.rows != PersonWindow::kHeight + 2)
    throw BadInput({Severity::kError, table, 0, field,
                    "a picture of " + std::to_string(crop.cols) + " x " + std::to_string(crop.rows),
                    "50 x 98 pixels"});
  return crop;
}

}  // namespace

std::string window_picture(const PersonCamera& camera,
                           const ImagePyramid& image,
                           const PersonBox& box) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", camera.cut(image, PersonWindow::patch(box)), bytes,
               {cv::IMWRITE_PNG_COMPRESSION, 9});
  return {bytes.begin(), bytes.end()};
}

void add_pictures(const std::vector<std::string>& pictures,
                  bool person,
                  const std::string& table,
                  const std::string& field,
                  PersonExamples& examples) {
  const PersonWindow window;
  for (const std::string& picture : pictures)
    add_example(window, decoded(picture, table, field), person, examples);
}

PersonExamples examples_of(const std::vector<Label>& labels) {
  PersonExamples examples;
  for (const Label& label : labels) {
    const bool person = label.kind == kPersonKind;
    if (is_on_ground(label) || (!person && label.kind != rejected_kind(kPersonKind))) continue;
    add_pictures(label.pictures, person, "label_events", "label " + std::to_string(label.id),
                 examples);
  }
  return examples;
}

std::vector<SearchAnswer> answers_of(const std::vector<Label>& labels) {
  std::vector<SearchAnswer> answers;
  for (const Label& label : labels) {
    const bool person = label.kind == kPersonKind;
    if (label.shape != LabelShape::kUpright || !was_found(label) ||
        (!person && label.kind != rejected_kind(kPersonKind)))
      continue;
    answers.push_back({logit_of(label.score), person});
  }
  return answers;
}

}  // namespace roadbook
