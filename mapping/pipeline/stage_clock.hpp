#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "mapping/pipeline/build_summary.hpp"

namespace roadbook {

/// Largest resident memory of this process so far [MB].
[[nodiscard]] double peak_rss_mb();

/// Runs stages and notes their times.
class StageClock {
 public:
  explicit StageClock(std::vector<StageTime>& stages) : stages_(stages) {}
  template <typename Work>
  auto run(const std::string& name, const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    auto result = work();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    stages_.push_back({name, taken.count(), peak_rss_mb()});
    return result;
  }

 private:
  std::vector<StageTime>& stages_;
};

}  // namespace roadbook
