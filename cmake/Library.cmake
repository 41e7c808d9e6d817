# The library that others link, monograin::monograin: the rooms that the public interface stands on.

set(library_rooms numerics models scenario scene engine history formula api)
set(library_objects)
set(library_dependencies)
foreach(room IN LISTS library_rooms)
  list(APPEND library_objects $<TARGET_OBJECTS:monograin_${room}>)
  get_target_property(dependencies monograin_${room} MONOGRAIN_LIBRARIES)
  # The objects are compiled already: nothing is left to link of headers that have no package.
  list(FILTER dependencies EXCLUDE REGEX "^monograin_")
  list(APPEND library_dependencies ${dependencies})
endforeach()
list(REMOVE_DUPLICATES library_dependencies)

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

add_library(monograin ${library_objects})
add_library(monograin::monograin ALIAS monograin)
target_compile_features(monograin PUBLIC cxx_std_20)
target_include_directories(monograin PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>"
                                            "$<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>")
# Headers of laws include Eigen's, and Boost's.
target_link_libraries(monograin PUBLIC Eigen3::Eigen Boost::headers PRIVATE ${library_dependencies})
if(BUILD_SHARED_LIBS AND NOT MONOGRAIN_SANITIZE)
  target_link_options(monograin PRIVATE -Wl,--no-undefined)
endif()
set_target_properties(monograin PROPERTIES VERSION "${PROJECT_VERSION}"
                                           SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
# The program of the same name stands in the build folder itself.
set_target_properties(monograin PROPERTIES LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib"
                                           ARCHIVE_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib")
