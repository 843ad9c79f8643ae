#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include "semantics/labels/labels.hpp"

namespace roadbook {

/// Groups the jobs of waiting threads: the first thread runs all waiting jobs. One wait for the
/// disk then serves all of them.
class TurnTaker {
 public:
  struct Job {
    std::function<std::vector<Label>()> work;
    std::vector<Label> labels;
    std::exception_ptr fault;
    bool done = false;
  };

  /// Adds `work` and waits until it is done. `work_all(jobs)` runs all waiting jobs; only one
  /// thread calls it at a time. What `work_all` throws is thrown in each waiting thread.
  template <class WorkAll>
  std::vector<Label> run(std::function<std::vector<Label>()> work, const WorkAll& work_all) {
    Job mine{std::move(work), {}, nullptr, false};
    std::unique_lock lock(mutex_);
    waiting_.push_back(&mine);
    turn_.wait(lock, [&] { return mine.done || !busy_; });
    if (!mine.done) {
      busy_ = true;
      const std::vector<Job*> jobs = std::exchange(waiting_, {});
      lock.unlock();
      std::exception_ptr fault;
      try {
        work_all(jobs);
      } catch (...) {
        fault = std::current_exception();
      }
      lock.lock();
      if (fault)
        for (Job* job : jobs) job->fault = fault;
      for (Job* job : jobs) job->done = true;
      busy_ = false;
      turn_.notify_all();
    }
    if (mine.fault) std::rethrow_exception(mine.fault);
    return std::move(mine.labels);
  }

 private:
  std::mutex mutex_;
  std::condition_variable turn_;
  std::vector<Job*> waiting_;
  bool busy_ = false;
};

}  // namespace roadbook
