# Installs the libraries, their headers, and what find_package and pkg-config read.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/monograin")
target_include_directories(monograin PUBLIC "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
install(TARGETS ${installed_libraries} EXPORT monograin-targets)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/monograin" "${PROJECT_BINARY_DIR}/include/monograin"
        DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" FILES_MATCHING PATTERN "*.hpp")

# The same package from the build tree, for CMAKE_PREFIX_PATH or monograin_DIR.
export(EXPORT monograin-targets NAMESPACE monograin:: FILE "${PROJECT_BINARY_DIR}/monograin-targets.cmake")
install(EXPORT monograin-targets NAMESPACE monograin:: DESTINATION "${package_folder}")

configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/monograin-config.cmake.in"
                              "${PROJECT_BINARY_DIR}/monograin-config.cmake" INSTALL_DESTINATION "${package_folder}")
# Until version 1 a minor version may change the interface.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/monograin-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/monograin-config.cmake" "${PROJECT_BINARY_DIR}/monograin-config-version.cmake"
        DESTINATION "${package_folder}")

if(BUILD_SHARED_LIBS)
  # Of a shared library the linker finds by itself what that stands on.
  file(RELATIVE_PATH prefix_from_here "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
  set(include_folder "\${prefix}")
  set(library_folder "\${prefix}")
  cmake_path(APPEND include_folder "${CMAKE_INSTALL_INCLUDEDIR}")
  cmake_path(APPEND library_folder "${CMAKE_INSTALL_LIBDIR}")
  foreach(library IN LISTS installed_libraries)
    configure_file("${CMAKE_CURRENT_LIST_DIR}/${library}.pc.in" "${PROJECT_BINARY_DIR}/${library}.pc" @ONLY)
    install(FILES "${PROJECT_BINARY_DIR}/${library}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
  endforeach()
endif()
