# `cmake --install`: the program, the libraries below it with their headers, a reader of maps in Python,
# and a package for find_package(roadbook). Programs link roadbook::workflows, or the module they need
# (roadbook::mapping), and include headers as "mapping/map.hpp". The command itself (apps) is no library
# for others.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/roadbook)
set(exported roadbook_opencv roadbook_opencv_headers roadbook_late_opencv_imgcodecs roadbook_late_opencv_videoio
    roadbook_late_gdal roadbook_libdeflate roadbook_cholmod)
foreach(module ${ROADBOOK_MODULES})
  if(module STREQUAL "apps" OR NOT TARGET roadbook_${module})
    continue()
  endif()
  list(APPEND exported roadbook_${module})
  set_target_properties(roadbook_${module} PROPERTIES EXPORT_NAME ${module})
  install(DIRECTORY ${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/roadbook COMPONENT libraries
          FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(TARGETS ${exported} EXPORT roadbook ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/roadbook
        COMPONENT libraries)
install(EXPORT roadbook NAMESPACE roadbook:: DESTINATION ${package_folder} FILE roadbook-targets.cmake
        COMPONENT libraries)
configure_package_config_file(cmake/roadbook-config.cmake.in ${CMAKE_BINARY_DIR}/roadbook-config.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/roadbook-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/roadbook-config.cmake ${CMAKE_BINARY_DIR}/roadbook-config-version.cmake
        DESTINATION ${package_folder} COMPONENT libraries)
# Reads map files without the libraries (docs/guide/library.md).
install(PROGRAMS python/roadbook_map.py DESTINATION ${CMAKE_INSTALL_DATADIR}/roadbook/python COMPONENT python)
install(FILES python/roadbook_geopackage.py DESTINATION ${CMAKE_INSTALL_DATADIR}/roadbook/python
        COMPONENT python)
if(TARGET roadbook)
  install(TARGETS roadbook DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
