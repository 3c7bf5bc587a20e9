# What stands beside the programs (src/render, convert, compare and study install those).

# Manual pages are installed compressed, as Debian wants them, and name the version at their foot. -n leaves out the time
# stamp, so that equal sources give equal packages.
find_program(PPRT_GZIP gzip REQUIRED)
find_program(PPRT_SED sed REQUIRED)
file(GLOB pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/man/*.[15])
foreach(page ${pages})
  get_filename_component(name ${page} NAME)
  string(REGEX MATCH "[0-9]$" section ${name})
  set(compressed ${PROJECT_BINARY_DIR}/man/${name}.gz)
  add_custom_command(OUTPUT ${compressed}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/man
    COMMAND ${PPRT_SED} "s/^[.]Os$/.Os pprt ${PROJECT_VERSION}/" ${page} | ${PPRT_GZIP} -9nc > ${compressed}
    DEPENDS ${page} VERBATIM)
  list(APPEND compressed_pages ${compressed})
  install(FILES ${compressed} DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section})
endforeach()
add_custom_target(manual_pages ALL DEPENDS ${compressed_pages})

install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
file(GLOB guides CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/*.md)
install(FILES ${guides} DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)
install(DIRECTORY docs/images docs/decisions DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)

# Named one by one: an example is also worked through where it stands, and what it makes there is not installed.
foreach(file
    README.md
    accuracy/README.md accuracy/lamp.nff
    load-balancing/README.md load-balancing/tables
    previsualisation/README.md previsualisation/ledger.gp previsualisation/shots.anim previsualisation/stage.aff)
  cmake_path(GET file PARENT_PATH folder)
  install(FILES examples/${file} DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples/${folder})
endforeach()
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The programs tell their own completion; the folders are those in which Debian's shells look.
function(pprt_completion program shell file directory)
  set(script ${PROJECT_BINARY_DIR}/completion/${shell}/${file})
  add_custom_command(OUTPUT ${script}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/completion/${shell}
    COMMAND ${program} --completion ${shell} > ${script}
    DEPENDS ${program} VERBATIM)
  set_property(GLOBAL APPEND PROPERTY PPRT_COMPLETION ${script})
  install(FILES ${script} DESTINATION ${CMAKE_INSTALL_DATADIR}/${directory})
endfunction()
foreach(program pprt-render pprt-convert pprt-compare pprt-study)
  pprt_completion(${program} bash ${program} bash-completion/completions)
  pprt_completion(${program} zsh _${program} zsh/vendor-completions)
  pprt_completion(${program} fish ${program}.fish fish/vendor_completions.d)
endforeach()
get_property(completion_files GLOBAL PROPERTY PPRT_COMPLETION)
add_custom_target(completion_scripts ALL DEPENDS ${completion_files})

# What `cmake --install` needs, without tests and benchmarks.
add_custom_target(programs DEPENDS pprt-render pprt-convert pprt-compare pprt-study manual_pages completion_scripts)
