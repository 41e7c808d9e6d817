# A room is a folder with one purpose, and a library. Rooms use each other from left to right: what a room stands on is
# named with ROOMS, and nothing else is on its link line.

# monograin_room(name SOURCES file... [ROOMS room...] [LIBRARIES library...])
function(monograin_room name)
  cmake_parse_arguments(PARSE_ARGV 1 ROOM "" "" "SOURCES;ROOMS;LIBRARIES")
  list(TRANSFORM ROOM_ROOMS PREPEND monograin_)
  add_library(monograin_${name} STATIC ${ROOM_SOURCES})
  target_compile_features(monograin_${name} PUBLIC cxx_std_20)
  target_include_directories(monograin_${name} PUBLIC "${PROJECT_SOURCE_DIR}/include" "${PROJECT_SOURCE_DIR}/src")
  target_link_libraries(monograin_${name} PUBLIC ${ROOM_ROOMS} PRIVATE ${ROOM_LIBRARIES} monograin_flags)
  set_property(TARGET monograin_${name} PROPERTY MONOGRAIN_LIBRARIES ${ROOM_LIBRARIES})
  target_link_libraries(monograin_rooms INTERFACE monograin_${name})
  # All objects of the room, with what it stands on: a use of a room on its right is an error of the linker.
  if(MONOGRAIN_BUILD_TESTS AND NOT MONOGRAIN_SANITIZE)
    add_executable(monograin_${name}_links "${PROJECT_SOURCE_DIR}/cmake/empty.cpp" $<TARGET_OBJECTS:monograin_${name}>)
    set_target_properties(monograin_${name}_links PROPERTIES UNITY_BUILD OFF)
    target_link_libraries(monograin_${name}_links PRIVATE $<TARGET_PROPERTY:monograin_${name},LINK_LIBRARIES>)
  endif()
endfunction()
