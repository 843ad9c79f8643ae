#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/views/view_problem.hpp"
#include "drive/drive.hpp"

namespace roadbook {

/// The motion of a car beside the views of its drive in a map: what wheels, steering and gyro are
/// compared with, and what of them is asked. That are the drive's reference poses; without any, the
/// poses that the views give, which leave to the views what these have answered.
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

  /// `views`: null where they say nothing; `found`: what they have found, `answered` the names that
  /// they have answered at all.
  [[nodiscard]] Question question(const ViewProblem* views,
                                  const EffectSizes& found,
                                  const std::vector<std::string>& answered) const;
  /// Evidence [nats] of all names that the motion wants beside what is known and `found`; none
  /// where nothing can be said of it. `answered` as above.
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
