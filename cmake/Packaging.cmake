# A Debian package of the program and its data: `cpack -G DEB` in the folder of the build, or tools/package.
set(CPACK_PACKAGE_NAME monograin)
set(CPACK_PACKAGE_VENDOR "monograin developers")
set(CPACK_PACKAGE_CONTACT "monograin developers <monograin@monograin.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "mechanics of a single particle under contact")
set(CPACK_PACKAGE_DESCRIPTION
"Runs scenario files: one particle, a material, a contact law, rigid walls and
what they do. Every transition between contact regimes is located as an event.
A run leaves curves, events, figures and everything needed to repeat it.
.
The package has the program, ready scenarios, and the definitions from which
its figures are made.")
set(CPACK_PACKAGE_FILE_NAME "${CPACK_PACKAGE_NAME}")
set(CPACK_GENERATOR DEB)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)

# The components of the program alone, in one package.
set(CPACK_COMPONENTS_ALL program debian)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "gnuplot-nox, fonts-dejavu-core")
# Loaded, not linked: only sweeps with --format hdf5 need it.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS libhdf5-103-1)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "calculix-ccx")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# What Debian wants beside the program; manual page and changelog are compressed in the package.
install(FILES "${PROJECT_SOURCE_DIR}/cmake/copyright" DESTINATION share/doc/monograin COMPONENT debian EXCLUDE_FROM_ALL)
install(FILES "${PROJECT_SOURCE_DIR}/CHANGELOG.md" DESTINATION share/doc/monograin RENAME changelog COMPONENT debian
        EXCLUDE_FROM_ALL)
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/DebianFiles.cmake")

include(CPack)
