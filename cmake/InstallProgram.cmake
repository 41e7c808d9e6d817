# What an installation of the program has: the program, its manual page, completion for bash, and the data that atlas,
# bench and regress read (share/monograin; src/cli/data_folder.cpp finds them there).
include(GNUInstallDirs)

function(monograin_install_program)
  set(data "${CMAKE_INSTALL_DATADIR}/monograin")
  install(TARGETS monograin_cli RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT program)
  install(FILES "${PROJECT_SOURCE_DIR}/src/cli/monograin.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT program)
  install(FILES "${PROJECT_SOURCE_DIR}/src/cli/monograin.bash"
          DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" RENAME monograin COMPONENT program)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/scenarios" DESTINATION "${data}" COMPONENT program)
  # Of the figures the definitions and what they read, not what is drawn.
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/plots/fe" "${PROJECT_SOURCE_DIR}/plots/scenarios" DESTINATION "${data}/plots"
          COMPONENT program)
  file(GLOB definitions CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/plots/*.toml")
  install(FILES ${definitions} "${PROJECT_SOURCE_DIR}/plots/README.md" DESTINATION "${data}/plots" COMPONENT program)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/tests/curves" DESTINATION "${data}" COMPONENT program)
endfunction()
monograin_install_program()
