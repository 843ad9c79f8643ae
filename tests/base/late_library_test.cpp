#include "base/files/late_library.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "base/error.hpp"
#include "tests/base/late/far_library.hpp"

// Tests libraries that are loaded when one of their functions is called, with two made for this.

namespace roadbook {
namespace {

bool is_loaded(const char* file) {
  void* handle = dlopen(file, RTLD_LAZY | RTLD_NOLOAD);
  if (handle != nullptr) dlclose(handle);
  return handle != nullptr;
}

// The first call goes through the search of the function, the second directly: both must pass all
// arguments, in registers and on the stack, and the result.
TEST(LateLibrary, IsLoadedByTheFirstCallWhichPassesAllArguments) {
  EXPECT_FALSE(is_loaded("libroadbook_far.so"));
  for (int call = 0; call < 2; ++call) {
    const far::Sums sums = far::sums(1, 0.5, 20, 0.25F, 300, 2.0, 4000, 50000, 4.0, "text", 600000,
                                     8.0, 16.0, 32.0, 64.0, 128.0, 256.0);
    EXPECT_EQ(sums.whole, 654321);
    EXPECT_EQ(sums.reals, 510.75);
    EXPECT_EQ(sums.text, "text");
  }
  EXPECT_TRUE(is_loaded("libroadbook_far.so"));
}

TEST(LateLibrary, MakesObjectsAndThrowsAsOthersDo) {
  far::Counter counter(41);
  EXPECT_EQ(counter.next(), 42);
  for (int call = 0; call < 2; ++call) {
    try {
      far::refuse("too far");
      FAIL() << "no exception";
    } catch (const std::domain_error& error) {
      EXPECT_STREQ(error.what(), "too far");
    }
  }
}

TEST(LateLibrary, IsLoadedByManyThreadsAtOnce) {
  std::vector<int> seen(8, 0);
  std::vector<std::thread> threads;
  for (int& value : seen)
    threads.emplace_back([&value] {
      far::Counter counter(6);
      value = counter.next();
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(seen, std::vector<int>(8, 7));
}

// The exception leaves through the stub, which has no C++ source: its frame must be known.
TEST(LateLibrary, ThatIsMissingIsOneLineThatNamesItsPackage) {
  for (int call = 0; call < 2; ++call) {
    try {
      (void)gone::answer(1.0);
      FAIL() << "no exception";
    } catch (const StorageError& error) {
      EXPECT_STREQ(error.what(),
                   "error: libroadbook_gone.so: got libroadbook_gone.so: cannot open shared object "
                   "file: No such file or directory, want the library of package libroadbook-gone");
    }
  }
}

// A library of another version may lack a function.
TEST(LateLibrary, WithoutTheFunctionIsALineToo) {
  void* function = nullptr;
  const char* name = "no_such_function";
  LateLibrary library{"libm.so.6", "libc6", &function, &name, nullptr};
  EXPECT_THROW((void)roadbook_late_function(&library, 0), StorageError);
  EXPECT_EQ(function, nullptr);
}

}  // namespace
}  // namespace roadbook
