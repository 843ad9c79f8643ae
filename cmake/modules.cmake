add_library(roadbook_flags INTERFACE)
target_compile_options(roadbook_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow
                                                -Wold-style-cast)
if(ROADBOOK_WARNINGS_AS_ERRORS)
  target_compile_options(roadbook_flags INTERFACE -Werror)
endif()

# Which of the libraries belong to modules that are not built (ROADBOOK_MODULES).
function(roadbook_missing result)
  set(missing)
  foreach(library ${ARGN})
    string(REGEX REPLACE "^roadbook_" "" module ${library})
    if(NOT TARGET ${library} AND NOT module STREQUAL library AND EXISTS ${CMAKE_SOURCE_DIR}/${module}/CMakeLists.txt)
      list(APPEND missing ${library})
    endif()
  endforeach()
  set(${result} ${missing} PARENT_SCOPE)
endfunction()

# roadbook_module(NAME SOURCES a.cpp b.cpp DEPENDS roadbook_base Eigen3::Eigen ... [TEXT])
# TEXT: it reads options, writes files or prints; no loop of it is hot, and many of its files include JSON.
# One module = one folder = one library roadbook_<NAME>; headers beside sources, included from the
# project's root as "NAME/file.hpp".
function(roadbook_module name)
  cmake_parse_arguments(ARG "TEXT" "" "SOURCES;DEPENDS" ${ARGN})
  roadbook_missing(missing ${ARG_DEPENDS})
  if(missing)
    message(FATAL_ERROR "ROADBOOK_MODULES: got ${name} without ${missing}, want all modules below it")
  endif()
  add_library(roadbook_${name} STATIC ${ARG_SOURCES})
  roadbook_unity_groups(${ARG_SOURCES})
  target_include_directories(roadbook_${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>
                                                     $<INSTALL_INTERFACE:include/roadbook>)
  target_compile_features(roadbook_${name} PUBLIC cxx_std_20)
  target_link_libraries(roadbook_${name} PUBLIC ${ARG_DEPENDS} PRIVATE $<BUILD_INTERFACE:roadbook_flags>)
  if(ARG_TEXT)
    roadbook_precompiled(roadbook_${name} text)
  else()
    roadbook_precompiled(roadbook_${name} plain)
  endif()
endfunction()

# Adds the suites of test_<NAME> to ctest, which lists them with cmake/test_suites.cmake when it runs.
function(roadbook_test_suites name)
  set(script ${CMAKE_CURRENT_BINARY_DIR}/test_${name}_include.cmake)
  file(GENERATE OUTPUT ${script} CONTENT "set(program [==[$<TARGET_FILE:test_${name}>]==])
set(prefix ${name}.)
set(list_file [==[${CMAKE_CURRENT_BINARY_DIR}/test_${name}_suites.cmake]==])
set(properties ${ARGN})
include([==[${CMAKE_SOURCE_DIR}/cmake/test_suites.cmake]==])
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${script})
endfunction()

# roadbook_test(NAME SOURCES a_test.cpp ... DEPENDS roadbook_x ... [JSON]): one executable test_<NAME>,
# every suite in it a ctest case. TIMEOUT [s] and COST are those of each suite; ctest starts dear ones
# first. ROADBOOK_DATA points at the real recordings, where there are any.
function(roadbook_test name)
  cmake_parse_arguments(ARG "JSON" "TIMEOUT;COST" "SOURCES;DEPENDS" ${ARGN})
  if(NOT ARG_COST)
    set(ARG_COST 1)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  roadbook_missing(missing ${ARG_DEPENDS})
  if(missing)
    message(STATUS "test_${name} is left out: ${missing} is not built")
    return()
  endif()
  add_executable(test_${name} ${ARG_SOURCES})
  set(ROADBOOK_UNITY_SMALL 0)  # folders of tests stay apart: names in functions of some hide those of others
  roadbook_unity_groups(${ARG_SOURCES})
  target_include_directories(test_${name} PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(test_${name} PRIVATE ${ARG_DEPENDS} roadbook_test_support roadbook_flags
                                             GTest::gtest_main)
  if(ARG_JSON)
    roadbook_precompiled(test_${name} json_tests)
  else()
    roadbook_precompiled(test_${name} tests)
  endif()
  roadbook_test_suites(${name} TIMEOUT ${ARG_TIMEOUT} COST ${ARG_COST} LABELS ${name})
endfunction()

# roadbook_runs_program(TARGET...): tests that run the program itself.
function(roadbook_runs_program)
  foreach(target ${ARGN})
    add_dependencies(${target} roadbook)
    target_compile_definitions(${target} PRIVATE ROADBOOK_PROGRAM="$<TARGET_FILE:roadbook>"
                                                 ROADBOOK_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
                                                 ROADBOOK_TEST_DRIVES="${CMAKE_BINARY_DIR}/test_drives")
  endforeach()
endfunction()
