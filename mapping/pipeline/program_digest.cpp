#include "mapping/pipeline/program_digest.hpp"

#include <elf.h>
#include <link.h>

#include <cstring>
#include <string_view>

#include "base/digest.hpp"

namespace roadbook {
namespace {

std::size_t padded(std::size_t size) { return (size + 3) & ~std::size_t{3}; }

// Returns the bytes of the GNU build id in a segment of notes; empty without one.
std::string_view build_id_in(std::string_view notes) {
  ElfW(Nhdr) header{};
  while (notes.size() >= sizeof(header)) {
    std::memcpy(&header, notes.data(), sizeof(header));
    const std::size_t name = sizeof(header);
    const std::size_t content = name + padded(header.n_namesz);
    const std::size_t end = content + padded(header.n_descsz);
    if (end > notes.size()) return {};
    if (header.n_type == NT_GNU_BUILD_ID && notes.substr(name, 3) == "GNU")
      return notes.substr(content, header.n_descsz);
    notes.remove_prefix(end);
  }
  return {};
}

std::string_view build_id_of(const dl_phdr_info& object) {
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object.dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    // The loader gives the address as a number.
    const auto* begin =
        reinterpret_cast<const char*>(object.dlpi_addr + segment.p_vaddr);  // NOLINT
    const std::string_view id = build_id_in({begin, segment.p_memsz});
    if (!id.empty()) return id;
  }
  return {};
}

struct Seen {
  Sha256 digest;
  bool is_first = true;
  bool has_program = false;
};

// The executable comes first, without a name.
int add_object(dl_phdr_info* object, std::size_t, void* data) {
  auto& seen = *static_cast<Seen*>(data);
  const bool is_program = seen.is_first;
  seen.is_first = false;
  const std::string_view name = object->dlpi_name == nullptr ? "" : object->dlpi_name;
  if (!is_program && name.find("libroadbook") == std::string_view::npos) return 0;
  const std::string_view id = build_id_of(*object);
  seen.has_program = seen.has_program || (is_program && !id.empty());
  seen.digest.update(id);
  return 0;
}

}  // namespace

std::string program_digest() {
  Seen seen;
  dl_iterate_phdr(add_object, &seen);
  return seen.has_program ? seen.digest.hex() : sha256_file_hex("/proc/self/exe");
}

}  // namespace roadbook
