# Every library comes from Debian 12; setup/packages.txt is the list, docs/design/dependencies.md the reasons.
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(Ceres REQUIRED)
find_package(JPEG REQUIRED)
find_package(OpenCV REQUIRED COMPONENTS core imgproc objdetect imgcodecs features2d calib3d ccalib flann ml videoio)
find_package(opengv REQUIRED)
find_package(Boost REQUIRED COMPONENTS graph)
find_package(embree 3 REQUIRED)
find_package(GDAL REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(pugixml REQUIRED)
find_package(TBB REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(Threads REQUIRED)
if(ROADBOOK_BUILD_TESTS)
  find_package(GTest REQUIRED)
endif()
if(ROADBOOK_BUILD_BENCH)
  find_package(benchmark REQUIRED)
endif()

# Split into header and library with defines that change its classes: flags from pkg-config alone.
find_package(PkgConfig REQUIRED)
pkg_check_modules(cpp_httplib REQUIRED cpp-httplib)

# Their headers are not ours to warn about. Files and videos come late, with all that they need.
include(cmake/late/late_library.cmake)
roadbook_late_library(opencv_imgcodecs $<TARGET_FILE:opencv_imgcodecs> libopencv-dev)
roadbook_late_library(opencv_videoio $<TARGET_FILE:opencv_videoio> libopencv-dev)
add_library(roadbook_opencv_headers INTERFACE)
target_include_directories(roadbook_opencv_headers SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
add_library(roadbook_opencv INTERFACE)
target_link_libraries(roadbook_opencv INTERFACE roadbook_opencv_headers roadbook_late_opencv_imgcodecs
  roadbook_late_opencv_videoio opencv_core opencv_imgproc opencv_objdetect opencv_features2d opencv_flann)

get_target_property(gdal_headers GDAL::GDAL INTERFACE_INCLUDE_DIRECTORIES)
get_target_property(gdal_file GDAL::GDAL IMPORTED_LOCATION)
roadbook_late_library(gdal ${gdal_file} libgdal-dev)
target_include_directories(roadbook_late_gdal SYSTEM INTERFACE ${gdal_headers})

# libdeflate 1.14 has no CMake configuration of its own.
find_path(LIBDEFLATE_INCLUDE_DIR libdeflate.h REQUIRED)
find_library(LIBDEFLATE_LIBRARY deflate REQUIRED)
add_library(roadbook_libdeflate INTERFACE)
target_include_directories(roadbook_libdeflate SYSTEM INTERFACE ${LIBDEFLATE_INCLUDE_DIR})
target_link_libraries(roadbook_libdeflate INTERFACE ${LIBDEFLATE_LIBRARY})

# Debian's SuiteSparse 5 has no CMake configuration of its own.
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
add_library(roadbook_cholmod INTERFACE)
target_include_directories(roadbook_cholmod SYSTEM INTERFACE ${CHOLMOD_INCLUDE_DIR})
target_link_libraries(roadbook_cholmod INTERFACE ${CHOLMOD_LIBRARY})
