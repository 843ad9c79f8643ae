#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/inference/score_table.hpp"
#include "diagnosis/range/fitted_mixture.hpp"
#include "diagnosis/range/range_diagnosis.hpp"
#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/sessions_diagnosis.hpp"

namespace roadbook {
namespace {

constexpr double kDrivesApart = 5.0;  // [s] between drives that stand one behind the other

RangeReadings joined_ranges(const std::vector<SessionRanges>& drives) {
  RangeReadings all;
  double end_s = 0.0;
  for (const SessionRanges& drive : drives) {
    const RangeReadings& own = *drive.readings;
    all.max_m = own.max_m;
    all.left_out += own.left_out;
    const double shift = end_s + kDrivesApart - own.samples.front().t_s;
    for (ExpectedRange r : own.samples) {
      r.t_s += shift;
      end_s = std::max(end_s, r.t_s);
      all.samples.push_back(r);
    }
    for (std::vector<RangeBeam> beams : own.beams) {
      for (RangeBeam& b : beams) b.t_s += shift;
      all.beams.push_back(std::move(beams));
    }
  }
  return all;
}

// The parts that were found: other parts would only blur them.
RangeParts parts_of(const Diagnosis& found) {
  RangeParts parts{};
  for (const FoundCause& c : found.causes)
    for (std::size_t k = 0; k < kRangeParts; ++k)
      if (c.effect == range_part_name(k)) parts[k] = true;
  return parts;
}

RangeParts either(RangeParts a, const RangeParts& b) {
  for (std::size_t k = 0; k < kRangeParts; ++k) a[k] = a[k] || b[k];
  return a;
}

bool reach_alike(const std::vector<SessionRanges>& drives) {
  return std::all_of(drives.begin(), drives.end(), [&](const SessionRanges& drive) {
    return drive.readings->max_m == drives.front().readings->max_m;
  });
}

// Whether the drives' own shares scatter about one mean by no more than their errors, to which
// belongs what each drive's map gets wrong.
bool are_alike(const std::vector<SessionRanges>& drives, const RangeParts& parts) {
  constexpr double kSurely = 0.001;
  std::vector<RangeMixture> own;
  for (const SessionRanges& drive : drives) {
    own.push_back(fit_mixture(*drive.readings, parts));
  }
  double statistic = 0.0;
  int freedom = 0;
  for (std::size_t k = 0; k < kRangeParts; ++k) {
    if (!parts[k]) continue;
    freedom += static_cast<int>(drives.size()) - 1;
    double weights = 0.0, weighted = 0.0, squares = 0.0;
    for (const RangeMixture& m : own) {
      const double weight = 1.0 / (std::pow(m.sigma[k], 2) + std::pow(kLeastRangeShare, 2));
      weights += weight;
      weighted += weight * m.share[k];
      squares += weight * m.share[k] * m.share[k];
    }
    statistic += std::max(0.0, squares - weighted * weighted / weights);
  }
  return freedom == 0 || chi_squared_tail(statistic, freedom) > kSurely;
}

}  // namespace

Diagnosis diagnose_ranges(const std::vector<SessionRanges>& drives,
                          const std::vector<std::string>& without) {
  Diagnosis all;
  std::vector<SessionRanges> read;
  for (const SessionRanges& drive : drives) {
    if (!drive.readings->samples.empty()) read.push_back(drive);
    for (const std::string& note : drive.readings->notes)
      all.notes.push_back(drive.name + ": " + note);
  }
  std::vector<Diagnosis> own;
  for (const SessionRanges& drive : read) {
    RangeReadings readings = *drive.readings;
    readings.notes.clear();  // said above
    own.push_back(diagnose_ranges(readings, without));
  }
  if (read.size() > 1 && reach_alike(read)) {
    const Diagnosis common = diagnose_ranges(joined_ranges(read), without);
    // What one drive alone shows is thin among all.
    RangeParts parts = parts_of(common);
    for (const Diagnosis& drive : own) parts = either(parts, parts_of(drive));
    if (are_alike(read, parts)) {
      add_findings(common, all);
      return all;
    }
  }
  if (read.size() > 1)
    all.notes.emplace_back(
        "range0: the shares of the drives differ; each drive is reported separately");
  for (std::size_t d = 0; d < read.size(); ++d) {
    if (read.size() > 1) mark_session(read[d].name, own[d]);
    add_findings(own[d], all);
  }
  return all;
}

}  // namespace roadbook
