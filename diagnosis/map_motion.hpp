#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/views/view_problem.hpp"
#include "drive/drive.hpp"

namespace roadbook {

/// The motion part of a diagnosis through a map: the poses that wheels, steering and gyro are
/// compared with, and the effects to search in them. The poses are the drive's reference. Without
/// one they come from the observations; effects that these have answered are left out.
class MapMotion {
 public:
  /// Streams and the options they are asked with.
  struct Question {
    MotionStreams streams;
    DiagnosisOptions options;
  };

  /// `one_session`: the map knows no other drive, so that its scale and bend are the drive's own.
  MapMotion(const Drive& drive, const DiagnosisOptions& options, bool one_session)
      : drive_(drive), options_(options), one_session_(one_session), reference_(drive.truth()) {}

  [[nodiscard]] bool has_reference() const { return !reference_.empty(); }
  /// What decides where views do not: "the reference poses".
  [[nodiscard]] std::string witness() const;

  /// `views`: null without observations. `found`: their effects; `answered`: all effects that they
  /// have judged.
  [[nodiscard]] Question question(const ViewProblem* views,
                                  const EffectSizes& found,
                                  const std::vector<std::string>& answered) const;
  /// Evidence [nats] of all effects that the motion supports in addition to the known ones and
  /// `found`; empty if the motion cannot judge. `answered` as above.
  [[nodiscard]] std::optional<double> wants(const ViewProblem& views,
                                            const EffectSizes& found,
                                            const std::vector<std::string>& answered) const;

 private:
  const Drive& drive_;
  const DiagnosisOptions& options_;
  bool one_session_;
  std::vector<TimedPose> reference_;
};

}  // namespace roadbook
