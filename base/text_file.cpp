#include "base/text_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"

namespace roadbook {
namespace {

// "" for a regular file.
std::string kind_fault(mode_t mode) {
  if (S_ISREG(mode)) return "";
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

}  // namespace

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.flush();
  if (!out)
    throw StorageError("error: " + file.string() + ": writing: got " + write_fault(file) +
                       ", want a disk that takes it");
}

RegularFile::RegularFile(const std::filesystem::path& file) : fault_("no readable file") {
  // Without O_NONBLOCK, opening a pipe waits until a process writes to it.
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (fd < 0) return;
  struct stat status {};
  if (::fstat(fd, &status) != 0) {
    ::close(fd);
    return;
  }
  fault_ = kind_fault(status.st_mode);
  if (fault_.empty()) file_.reset(::fdopen(fd, "rb"));
  if (!file_)
    ::close(fd);
  else
    size_ = static_cast<std::uint64_t>(status.st_size);
}

std::string read_regular_file(const std::filesystem::path& file,
                              const std::string& want,
                              std::uint64_t most) {
  const RegularFile in(file);
  if (!in) throw BadInput({Severity::kError, file.string(), 0, "", in.fault(), want});
  if (in.size() > most)
    throw BadInput({Severity::kError, file.string(), 0, "size",
                    std::to_string(in.size()) + " bytes", "at most " + std::to_string(most)});
  std::string text(in.size(), '\0');
  if (std::fread(text.data(), 1, text.size(), in.get()) != text.size())
    throw BadInput({Severity::kError, file.string(), 0, "", "no readable file", want});
  return text;
}

void require_regular_file(const std::filesystem::path& file, const std::string& want) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return;
  const std::string fault = kind_fault(status.st_mode);
  if (!fault.empty()) throw BadInput({Severity::kError, file.string(), 0, "", fault, want});
}

}  // namespace roadbook
