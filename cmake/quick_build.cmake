# Most of the time of a build is reading headers and instantiating the same templates again. So common
# headers are parsed once, and up to 24 files of one folder are compiled together. Every file still
# includes what it needs: with a compiler cache (which would not keep such objects) or clang-tidy, each
# is compiled alone. Names in anonymous namespaces must differ within a folder of a target (tests/layout
# checks it).
option(ROADBOOK_QUICK_BUILD "Parse the commonest headers once, files together (no compiler cache then)" ON)
if(CMAKE_CXX_COMPILER_LAUNCHER OR CMAKE_CXX_CLANG_TIDY OR NOT ROADBOOK_QUICK_BUILD)
  function(roadbook_precompiled)
  endfunction()
  function(roadbook_unity_groups)
  endfunction()
  return()
endif()

set(CMAKE_UNITY_BUILD ON)
set(CMAKE_UNITY_BUILD_MODE GROUP)
# 24 instead of 16 save a seventh of the time of the folders that become one group, and take up to 3.5 GB.
set(ROADBOOK_UNITY_FILES 24 CACHE STRING "Files compiled together, at most")
set(ROADBOOK_UNITY_SMALL 8 CACHE STRING "Files of a folder that is compiled together with other small ones, at most")

# roadbook_unity_groups(SOURCES...): groups sources of the calling folder, up to ROADBOOK_UNITY_FILES
# of one sub-folder each, in parts of equal size. Small sub-folders share groups: a group alone costs
# about 1 s for templates that others instantiate as well.
function(roadbook_unity_groups)
  foreach(source ${ARGN})
    get_filename_component(folder "${source}" DIRECTORY)
    string(MAKE_C_IDENTIFIER "in_${folder}" name)
    list(APPEND folders ${name})
    list(APPEND sources_${name} ${source})
  endforeach()
  list(REMOVE_DUPLICATES folders)
  foreach(name ${folders})
    list(LENGTH sources_${name} count)
    if(count GREATER ROADBOOK_UNITY_SMALL)
      list(APPEND names ${name})
    else()
      list(APPEND names small_folders)
      list(APPEND sources_small_folders ${sources_${name}})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES names)
  foreach(name ${names})
    list(LENGTH sources_${name} count)
    math(EXPR groups "(${count} + ${ROADBOOK_UNITY_FILES} - 1) / ${ROADBOOK_UNITY_FILES}")
    math(EXPR size "(${count} + ${groups} - 1) / ${groups}")
    set(index 0)
    foreach(source ${sources_${name}})
      math(EXPR group "${index} / ${size}")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${name}_${group})
      math(EXPR index "${index} + 1")
    endforeach()
  endforeach()
endfunction()

# GCC 12 warns about code that it inlines from its own string library (GCC bugs 105329, 105651). With a
# precompiled header it forgets that this is a system header, and it takes files that are compiled
# together for headers (subobject-linkage). Builds that compile every file alone keep these warnings.
target_compile_options(roadbook_flags INTERFACE -Wno-array-bounds -Wno-restrict
                                                -Wno-stringop-overflow -Wno-stringop-overread -Wno-subobject-linkage)

# GCC's garbage collection takes a tenth of the time of files this large; without it, a sixth more memory.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(roadbook_flags INTERFACE --param=ggc-min-expand=1000 --param=ggc-min-heapsize=4000000)
endif()

# Fifty programs are linked with some hundred libraries. gold (of binutils) takes a quarter of the time.
include(CheckLinkerFlag)
check_linker_flag(CXX -fuse-ld=gold ROADBOOK_HAS_GOLD)
if(ROADBOOK_HAS_GOLD)
  add_link_options($<$<CONFIG:Release>:-fuse-ld=gold>)
endif()

set(common_headers <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map> <memory>
    <optional> <span> <string> <vector> <Eigen/Cholesky> <Eigen/Core> <Eigen/Geometry> <Eigen/LU>
    <Eigen/SparseCore> <opencv2/core.hpp>)
set(nothing ${CMAKE_BINARY_DIR}/precompiled.cpp)
file(CONFIGURE OUTPUT ${nothing} CONTENT "")
# Tests at -O1: this takes a fifth to a quarter less time, and a test spends its time in the libraries
# and in the program. So do modules that read options, write files and print: the time of a verb is
# spent in the modules below them (roadbook_module, TEXT). Numbers do not change: without
# -ffast-math GCC keeps the order of operations. A precompiled header goes with one level only. At this
# level GCC warns of values that it does not follow through inlined functions; other presets keep the
# warning.
function(roadbook_optimise_less target kind)
  if(kind MATCHES "tests$|^text$")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>
                                             $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-Wno-maybe-uninitialized>)
  endif()
endfunction()

function(roadbook_common_headers kind)
  cmake_parse_arguments(ARG "" "" "HEADERS;DEPENDS" ${ARGN})
  add_library(roadbook_common_headers_${kind} OBJECT ${nothing})
  target_link_libraries(roadbook_common_headers_${kind} PRIVATE Eigen3::Eigen roadbook_opencv_headers roadbook_flags
                                                                ${ARG_DEPENDS})
  target_precompile_headers(roadbook_common_headers_${kind} PRIVATE ${common_headers} ${ARG_HEADERS})
  roadbook_optimise_less(roadbook_common_headers_${kind} ${kind})
endfunction()

# JSON has headers of its own: each file that includes it instantiates its parser again (0.6 s).
roadbook_common_headers(plain)
roadbook_common_headers(text HEADERS <nlohmann/json.hpp> DEPENDS nlohmann_json::nlohmann_json)
if(ROADBOOK_BUILD_TESTS)
  roadbook_common_headers(tests HEADERS <gtest/gtest.h> DEPENDS GTest::gtest)
  roadbook_common_headers(json_tests HEADERS <gtest/gtest.h> <nlohmann/json.hpp>
                          DEPENDS GTest::gtest nlohmann_json::nlohmann_json)
endif()

# roadbook_precompiled(TARGET plain|text|tests|json_tests)
function(roadbook_precompiled target kind)
  target_precompile_headers(${target} REUSE_FROM roadbook_common_headers_${kind})
  roadbook_optimise_less(${target} ${kind})
endfunction()
