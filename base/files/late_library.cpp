#include "base/files/late_library.hpp"

#include <dlfcn.h>

#include <mutex>
#include <string>

#include "base/error.hpp"

namespace roadbook {
namespace {

[[noreturn]] void library_missing(const LateLibrary& library) {
  const char* reason = dlerror();
  throw StorageError(std::string("error: ") + library.file + ": got " +
                     (reason != nullptr ? reason : "no such library") +
                     ", want the library of package " + library.package);
}

}  // namespace

extern "C" void* roadbook_late_function(LateLibrary* library, std::size_t index) {
  static std::mutex loading;
  const std::lock_guard lock(loading);
  if (library->handle == nullptr) library->handle = dlopen(library->file, RTLD_LAZY | RTLD_LOCAL);
  if (library->handle == nullptr) library_missing(*library);
  void* function = dlsym(library->handle, library->names[index]);
  if (function == nullptr) library_missing(*library);
  // Threads that jump through the slot meanwhile come here, too, or see the whole pointer.
  __atomic_store_n(&library->functions[index], function, __ATOMIC_RELEASE);
  return function;
}

}  // namespace roadbook
