# Headers that most files read are parsed once: two thirds of the time of a build is reading headers.
# Every file still names what it needs: with a compiler cache (which would not keep such objects) or
# clang-tidy, nothing is read before it.
option(ROADBOOK_PRECOMPILED_HEADERS "Parse the commonest headers once (no compiler cache then)" ON)
if(CMAKE_CXX_COMPILER_LAUNCHER OR CMAKE_CXX_CLANG_TIDY OR NOT ROADBOOK_PRECOMPILED_HEADERS)
  function(roadbook_precompiled)
  endfunction()
  return()
endif()

# GCC 12 warns of what it inlines from the library's own strings (GCC bugs 105329, 105651), and forgets
# with a precompiled header that this is a system's; builds that parse every header have these warnings.
target_compile_options(roadbook_flags INTERFACE -Wno-array-bounds -Wno-restrict
                                                -Wno-stringop-overflow -Wno-stringop-overread)

set(common_headers <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map> <memory>
    <optional> <span> <string> <vector> <Eigen/Cholesky> <Eigen/Core> <Eigen/Geometry> <Eigen/LU>
    <Eigen/SparseCore> <nlohmann/json.hpp> <opencv2/core.hpp>)
set(nothing ${CMAKE_BINARY_DIR}/precompiled.cpp)
file(CONFIGURE OUTPUT ${nothing} CONTENT "")
add_library(roadbook_common_headers OBJECT ${nothing})
target_link_libraries(roadbook_common_headers PRIVATE Eigen3::Eigen nlohmann_json::nlohmann_json
                                                      roadbook_opencv roadbook_flags)
target_precompile_headers(roadbook_common_headers PRIVATE ${common_headers})
if(ROADBOOK_BUILD_TESTS)
  add_library(roadbook_common_headers_of_tests OBJECT ${nothing})
  target_link_libraries(roadbook_common_headers_of_tests
                        PRIVATE Eigen3::Eigen nlohmann_json::nlohmann_json roadbook_opencv
                                roadbook_flags GTest::gtest)
  target_precompile_headers(roadbook_common_headers_of_tests PRIVATE ${common_headers} <gtest/gtest.h>)
endif()

# roadbook_precompiled(TARGET [OF_TESTS])
function(roadbook_precompiled target)
  if(ARGN)
    target_precompile_headers(${target} REUSE_FROM roadbook_common_headers_of_tests)
  else()
    target_precompile_headers(${target} REUSE_FROM roadbook_common_headers)
  endif()
endfunction()
