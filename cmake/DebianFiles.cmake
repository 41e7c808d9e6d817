# Run by CPack before it packs: writes the changelog of the package, and compresses what Debian wants compressed.
set(root "${CPACK_TEMPORARY_DIRECTORY}")
file(GLOB_RECURSE changelog "${root}/changelog")
file(GLOB_RECURSE page "${root}/monograin.1")

# The release and its day stand in the changelog of the project.
file(READ "${changelog}" text)
string(REGEX MATCH "## \\[${CPACK_PACKAGE_VERSION}\\] - ([0-9-]+)" heading "${text}")
if(NOT heading)
  message(FATAL_ERROR "CHANGELOG.md has no release ${CPACK_PACKAGE_VERSION}")
endif()
execute_process(COMMAND date --utc --rfc-email "--date=${CMAKE_MATCH_1}" OUTPUT_VARIABLE day OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
file(WRITE "${changelog}.Debian"
"monograin (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium

  * Version ${CPACK_PACKAGE_VERSION}; changelog.gz says what is in it.

 -- ${CPACK_PACKAGE_CONTACT}  ${day}
")
foreach(file IN ITEMS "${changelog}" "${changelog}.Debian" "${page}")
  execute_process(COMMAND gzip -9nf "${file}" COMMAND_ERROR_IS_FATAL ANY)
endforeach()
