#pragma once

#include <cstddef>

namespace roadbook {

/// A shared library that a program loads when it first calls one of its functions, so that runs
/// which call none do not wait for it. Assembler made by cmake/late/write_stubs.sh holds one for
/// each such library: fields, and the order of fields, are the same there.
struct LateLibrary {
  const char* file;          ///< name by which the loader finds it, as "libgdal.so.32"
  const char* package;       ///< Debian's package of it, for the message
  void** functions;          ///< as many as `names`: what the stubs jump to
  const char* const* names;  ///< symbols of the functions
  void* handle;              ///< of dlopen(); null before the first call
};

/// Function number `index` of the library, which is loaded if it was not; the stub jumps there from
/// then on. Called by stubs, in any thread. Throws StorageError if the library, or the function in
/// it, is missing.
extern "C" void* roadbook_late_function(LateLibrary* library, std::size_t index);

}  // namespace roadbook
