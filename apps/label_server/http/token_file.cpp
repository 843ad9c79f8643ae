#include "apps/label_server/http/token_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "apps/label_server/http/http_guard.hpp"
#include "base/error.hpp"
#include "base/text_file.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kTokenDigits = 32;

std::string read_token(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0 || (status.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    throw BadInput({Severity::kError, file.string(), 0, "mode",
                    "a file that other users can read or write",
                    "a file for its owner only (chmod 600)"});
  require_regular_file(file, "a file of its own");
  std::ifstream in(file);
  std::string token;
  in >> token;
  if (token.size() != kTokenDigits ||
      token.find_first_not_of("0123456789abcdef") != std::string::npos)
    throw BadInput({Severity::kError, file.string(), 1, "token", "another text",
                    "32 digits, as `roadbook label` writes them"});
  return token;
}

}  // namespace

std::string kept_token(const std::filesystem::path& file) {
  if (std::filesystem::exists(std::filesystem::symlink_status(file))) return read_token(file);
  // The file must be complete or absent. Half a token would stop every later start.
  const std::string part = file.string() + ".part." + std::to_string(::getpid());
  const std::string token = random_token();
  const std::string line = token + "\n";
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  errno = descriptor < 0 ? errno : ENOSPC;  // a short write does not set errno
  bool written = descriptor >= 0 &&
                 ::write(descriptor, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  if (descriptor >= 0) ::close(descriptor);
  written = written && ::rename(part.c_str(), file.c_str()) == 0;
  if (written) return token;
  const std::string reason = std::strerror(errno);
  if (descriptor >= 0) ::unlink(part.c_str());
  throw StorageError(
      to_line({Severity::kError, file.string(), 0, "--token-file", reason, "a writable path"}));
}

}  // namespace roadbook
