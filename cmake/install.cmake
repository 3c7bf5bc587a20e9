# What stands beside the programs (src/render, convert, compare and study install those), and the Debian package: cpack -G DEB.

# Manual pages and the package's changelog are installed compressed, as Debian wants them; -n leaves out the
# time stamp, so that equal sources give equal packages.
find_program(PPRT_GZIP gzip REQUIRED)
function(pprt_compressed source name destination)
  set(compressed ${PROJECT_BINARY_DIR}/compressed/${name}.gz)
  add_custom_command(OUTPUT ${compressed}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/compressed
    COMMAND ${PPRT_GZIP} -9nc ${source} > ${compressed}
    DEPENDS ${source} VERBATIM)
  set_property(GLOBAL APPEND PROPERTY PPRT_COMPRESSED ${compressed})
  install(FILES ${compressed} DESTINATION ${destination})
endfunction()

file(GLOB pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/man/*.[15])
foreach(page ${pages})
  get_filename_component(name ${page} NAME)
  string(REGEX MATCH "[0-9]$" section ${name})
  pprt_compressed(${page} ${name} ${CMAKE_INSTALL_MANDIR}/man${section})
endforeach()
pprt_compressed(${PROJECT_SOURCE_DIR}/CHANGELOG.md changelog ${CMAKE_INSTALL_DOCDIR})
pprt_compressed(${PROJECT_SOURCE_DIR}/cmake/debian/changelog changelog.Debian ${CMAKE_INSTALL_DOCDIR})
get_property(compressed_files GLOBAL PROPERTY PPRT_COMPRESSED)
add_custom_target(compressed_documents ALL DEPENDS ${compressed_files})

install(FILES README.md LICENSE cmake/debian/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
file(GLOB guides CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/*.md)
install(FILES ${guides} DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)
install(DIRECTORY docs/images docs/decisions DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)
install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples)

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

set(CPACK_GENERATOR DEB)
# Debian wants an address. One under .invalid is nobody's, now and later (RFC 2606).
set(CPACK_PACKAGE_CONTACT "The pprt authors <nobody@pprt.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "parallel progressive ray tracer with a fixed frame rate")
set(CPACK_PACKAGE_DESCRIPTION
"pprt renders scenes and camera animations by progressive ray tracing on MPI
ranks. Every frame has a deadline: what time allows goes where the picture
varies most, and the rest is interpolated between samples.
.
It reads Haines' Neutral File Format and meshes, generates the Standard
Procedural Databases, and writes numbered OpenEXR and PNG frames.")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS openmpi-bin)  # pprt-render starts mpirun
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS gnuplot-nox)  # pprt-study has it draw plots
set(CPACK_DEBIAN_PACKAGE_SUGGESTS ffmpeg)  # pprt-render --film
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
include(CPack)
