#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace roadbook {

// The exceptions of roadbook, each with the exit status of the command, and `Problem`: one fault in
// an input, with file and line.

enum class ExitStatus {
  kDone = 0,
  kUsage = 1,
  kBadInput = 2,
  kStorage = 3,      ///< disk, permission or lock
  kRefused = 4,      ///< a quality gate refused the result
  kInterrupted = 5,  ///< run again to resume
};

enum class Severity { kWarning, kError };

/// One fault in an input. Fields that do not apply stay empty (line: 0).
struct Problem {
  Severity severity = Severity::kError;
  std::string file;
  std::int64_t line = 0;
  std::string field;
  std::string got;
  std::string want;
};

/// "error: FILE:LINE: FIELD: got X, want Y"; what does not apply is left out.
[[nodiscard]] std::string to_line(const Problem& problem);

/// Base of all exceptions that roadbook throws on purpose; caught once, in main.
class Error : public std::runtime_error {
 public:
  Error(ExitStatus status, const std::string& what) : std::runtime_error(what), status_(status) {}
  [[nodiscard]] ExitStatus status() const { return status_; }

 private:
  ExitStatus status_;
};

/// Input that cannot be used. Carries every fault found; `what()` lists errors first.
class BadInput : public Error {
 public:
  explicit BadInput(Problem problem);
  explicit BadInput(std::vector<Problem> problems);
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// An option outside its range: names the field, its value and the range. A function that read the
/// option from a file throws BadInput instead, with `problem()` and the file's name.
class InvalidOption : public Error {
 public:
  InvalidOption(const std::string& field, const std::string& got, const std::string& want);
  [[nodiscard]] const Problem& problem() const { return problem_; }

 private:
  Problem problem_;
};

/// A disk, permission or lock that does not work.
class StorageError : public Error {
 public:
  explicit StorageError(const std::string& what) : Error(ExitStatus::kStorage, what) {}
};

/// A result that a quality check refused; it is not written.
class Refused : public Error {
 public:
  explicit Refused(const std::string& what) : Error(ExitStatus::kRefused, what) {}
};

/// The user stopped the program.
class Interrupted : public Error {
 public:
  explicit Interrupted(const std::string& what) : Error(ExitStatus::kInterrupted, what) {}
};

/// An assertion that stays on in release: our own mistake, never bad input.
#define ROADBOOK_ASSERT(condition) \
  ((condition) ? void(0) : ::roadbook::assertion_failed(#condition, __FILE__, __LINE__))
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);

}  // namespace roadbook
