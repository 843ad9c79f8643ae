#include "apps/label_server/round_worker.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <stdexcept>
#include <thread>

#include "semantics/labels/turn_taker.hpp"

namespace roadbook {
namespace {

// Two people ask for rounds of two classes while a third one runs: all are worked off, in order,
// and what waits already is not done twice.
TEST(RoundWorker, WorksOffWhatWasAskedForWhileARoundRan) {
  EventHub hub;
  std::promise<void> begun;
  std::promise<void> go_on;
  std::promise<void> all_done;
  std::vector<std::string> rounds;  // of the worker's thread, until all are done
  RoundWorker worker(&hub, "learning", [&](const std::string& kind) {
    rounds.push_back(kind);
    if (kind == "first") {
      begun.set_value();
      go_on.get_future().wait();
    }
    if (kind == "crossing") all_done.set_value();
  });
  worker.start("first");
  begun.get_future().wait();
  for (const char* kind : {"parking_space", "parking_space", "crossing", "parking_space"})
    worker.start(kind);
  EXPECT_TRUE(worker.running());
  go_on.set_value();
  auto done = all_done.get_future();
  ASSERT_EQ(done.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  EXPECT_EQ(rounds, (std::vector<std::string>{"first", "parking_space", "crossing"}));
}

// A failed run is reported to all clients that waited for it, and the next run starts.
TEST(TurnTaker, GoesOnAfterATurnThatThrew) {
  TurnTaker turns;
  const auto work = [] { return std::vector<Label>(1); };
  const auto fail = [](const auto&) { throw std::runtime_error("no room"); };
  EXPECT_THROW((void)turns.run(work, fail), std::runtime_error);
  auto next = std::async(std::launch::async, [&] {
    return turns.run(work, [](const auto& jobs) {
      for (TurnTaker::Job* job : jobs) job->labels = job->work();
    });
  });
  ASSERT_EQ(next.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  EXPECT_EQ(next.get().size(), 1U);
}

}  // namespace
}  // namespace roadbook
