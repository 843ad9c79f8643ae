#include "apps/console.hpp"

#include <spdlog/sinks/ansicolor_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

namespace roadbook {
namespace {

std::atomic<bool> stop_asked = false;
static_assert(std::atomic<bool>::is_always_lock_free);  // lock-free, so a signal handler may use it

extern "C" void on_interrupt(int signal) {
  if (stop_asked.exchange(true)) {
    // The program did not react to the first signal. End it with the default action of the signal.
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

// Messages contain their own "error:" or "warning:", so the pattern adds nothing.
spdlog::logger& log() {
  static const auto logger = [] {
    auto made = std::make_shared<spdlog::logger>(
        "roadbook", std::make_shared<spdlog::sinks::ansicolor_stderr_sink_mt>());
    made->set_pattern("%^%v%$");
    return made;
  }();
  return *logger;
}

// A message must be one line, even if it contains a file name with line breaks.
std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text;
}

void clear_bar() { std::fputs("\r\033[K", stderr); }

}  // namespace

Console::Console(bool json, bool quiet) : json_(json), quiet_(quiet), terminal_(isatty(2) != 0) {}

void Console::say(const std::string& line) const {
  if (!json_) std::cout << line << '\n';
}

void Console::result(const nlohmann::ordered_json& object) const {
  using nlohmann::ordered_json;
  if (json_)
    std::cout << object.dump(2, ' ', false, ordered_json::error_handler_t::replace) << '\n';
}

void Console::warn(const std::vector<Problem>& problems) const {
  for (const Problem& problem : problems) {
    const std::string line = one_line(to_line(problem));
    if (problem.severity == Severity::kError)
      log().error("{}", line);
    else
      log().warn("{}", line);
  }
}

void Console::note(const std::string& line) const { log().info("{}", one_line(line)); }

Progress Console::progress() {
  return [this](std::string_view stage, std::size_t done, std::size_t total) {
    return show(stage, done, total);
  };
}

bool Console::show(std::string_view stage, std::size_t done, std::size_t total) {
  if (interrupted()) {
    if (terminal_ && permille_ >= 0) clear_bar();
    return false;
  }
  if (quiet_ || total == 0) return true;
  const auto permille = static_cast<int>(1000 * done / total);
  const bool new_stage = stage != stage_;
  if (new_stage) {
    stage_ = stage;
    tenths_ = 0;
    permille_ = -1;
  }
  if (terminal_) {
    if (permille == permille_) return true;
    permille_ = permille;
    constexpr int kWidth = 30;
    const std::string bar(static_cast<std::size_t>(permille * kWidth / 1000), '#');
    std::fprintf(stderr, "\r\033[K%-24s [%-*s] %3d %%", stage_.c_str(), kWidth, bar.c_str(),
                 permille / 10);
    if (done >= total) std::fputc('\n', stderr);
  } else if (const auto tenths = static_cast<std::size_t>(permille / 100); tenths > tenths_) {
    tenths_ = tenths;
    std::fprintf(stderr, "%s: %zu %%\n", stage_.c_str(), 10 * tenths);
  }
  return true;
}

void print_error(const Error& error) {
  if (const auto* const bad = dynamic_cast<const BadInput*>(&error);
      bad != nullptr && !bad->problems().empty()) {
    for (const Problem& problem : bad->problems()) print_error(to_line(problem));
  } else if (error.status() == ExitStatus::kRefused) {
    std::istringstream lines(error.what());  // the warnings of its drives may follow
    for (std::string line; std::getline(lines, line);) print_error(line);
  } else {
    print_error(std::string(error.what()));
  }
}

void print_error(const std::string& line) {
  const std::string text = one_line(line);
  const bool complete = text.rfind("error: ", 0) == 0 || text.rfind("warning: ", 0) == 0;
  if (text.rfind("warning: ", 0) == 0)
    log().warn("{}", text);
  else
    log().error("{}{}", complete ? "" : "error: ", text);
}

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return stop_asked.load(); }

}  // namespace roadbook
