#include "drive/output_file.hpp"

#include <cerrno>
#include <utility>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"

namespace roadbook {

namespace fs = std::filesystem;

void throw_storage_error(const fs::path& path, const std::string& what, const std::string& why) {
  throw StorageError(
      to_line({Severity::kError, path.string(), 0, what, why, "a place that can be written"}));
}

void throw_storage_error(const fs::path& path, const std::string& what) {
  throw_storage_error(path, what, write_fault(path, errno));
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw_storage_error(folder, "creating", write_fault(folder, error.value()));
}

OutputFile::OutputFile(fs::path path)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
  if (file_ == nullptr) throw_storage_error(path_, "creating");
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
}

void OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size())
    throw_storage_error(path_, "writing");
}

void OutputFile::close() {
  if (file_ == nullptr) return;
  const bool flushed = std::fflush(file_) == 0;
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (!flushed || !closed) throw_storage_error(path_, "writing");
}

void write_file(const fs::path& path, std::string_view bytes) {
  OutputFile file(path);
  file.write(bytes);
  file.close();
}

OutputTable::OutputTable(const fs::path& folder, std::string_view header)
    : file_(folder / "data.csv") {
  file_.write(header);
  file_.write("\n");
}

void OutputTable::row(std::int64_t t_ns, std::string_view rest, StampOrder order) {
  ROADBOOK_ASSERT(t_ns > last_ns_ || (order == StampOrder::kRepeats && t_ns == last_ns_));
  last_ns_ = t_ns;
  file_.write(std::to_string(t_ns) + "," + std::string(rest) + "\n");
}

void OutputTable::close() { file_.close(); }

}  // namespace roadbook
