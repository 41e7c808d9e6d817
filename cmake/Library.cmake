# The libraries that others link: monograin::monograin, the rooms that the public interface stands on, and
# monograin::studies, those of studies of many runs.

# monograin_library(name ROOMS room...): a library of the objects of rooms, with what these stand on.
function(monograin_library name)
  cmake_parse_arguments(PARSE_ARGV 1 LIBRARY "" "" "ROOMS")
  set(objects)
  set(dependencies)
  foreach(room IN LISTS LIBRARY_ROOMS)
    list(APPEND objects $<TARGET_OBJECTS:monograin_${room}>)
    get_target_property(of_room monograin_${room} MONOGRAIN_LIBRARIES)
    # The objects are compiled already: nothing is left to link of headers that have no package.
    list(FILTER of_room EXCLUDE REGEX "^monograin_")
    list(APPEND dependencies ${of_room})
  endforeach()
  list(REMOVE_DUPLICATES dependencies)
  add_library(${name} ${objects})
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_link_libraries(${name} PRIVATE ${dependencies})
  if(BUILD_SHARED_LIBS AND NOT MONOGRAIN_SANITIZE)
    set(map "${PROJECT_SOURCE_DIR}/cmake/library.map")
    target_link_options(${name} PRIVATE -Wl,--no-undefined "-Wl,--version-script=${map}")
    set_target_properties(${name} PROPERTIES LINK_DEPENDS "${map}")
  endif()
  # The program of the same name stands in the build folder itself.
  set_target_properties(${name} PROPERTIES VERSION "${PROJECT_VERSION}"
                                           SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}"
                                           LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib"
                                           ARCHIVE_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib")
endfunction()

# Headers of models, as others include them: <monograin/laws/elastic/hertz.hpp>. They are those of the tree, which name
# each other from the folder models/.
set(law_headers "${PROJECT_BINARY_DIR}/include/monograin/laws")
file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE "${PROJECT_SOURCE_DIR}/models" "${PROJECT_SOURCE_DIR}/models/*.hpp")
foreach(header IN LISTS headers)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/models/${header}")
  file(READ "${PROJECT_SOURCE_DIR}/models/${header}" text)
  string(REPLACE "#include \"" "#include \"monograin/laws/" text "${text}")
  file(CONFIGURE OUTPUT "${law_headers}/${header}" CONTENT "${text}" @ONLY)
endforeach()
# A header that has left the tree must not be installed from an older build.
file(GLOB_RECURSE staged_headers RELATIVE "${law_headers}" "${law_headers}/*.hpp")
list(REMOVE_ITEM staged_headers ${headers})
foreach(header IN LISTS staged_headers)
  file(REMOVE "${law_headers}/${header}")
endforeach()

monograin_library(monograin ROOMS numerics models scenario scene engine history exchange continuum formula api)
add_library(monograin::monograin ALIAS monograin)
target_include_directories(monograin PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>"
                                            "$<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>")
# Headers of laws include Eigen's, and Boost's.
target_link_libraries(monograin PUBLIC Eigen3::Eigen Boost::headers)

set(installed_libraries monograin)
if(MONOGRAIN_HAS_STUDIES)
  monograin_library(monograin_studies ROOMS figure sweep calibrate identify api_study)
  add_library(monograin::studies ALIAS monograin_studies)
  # Studies read tables of TOML, as the room scenario does.
  target_link_libraries(monograin_studies PUBLIC monograin PRIVATE tomlplusplus::tomlplusplus)
  # Both libraries are installed into one folder.
  set_target_properties(monograin_studies PROPERTIES EXPORT_NAME studies INSTALL_RPATH "$ORIGIN")
  list(APPEND installed_libraries monograin_studies)
endif()
