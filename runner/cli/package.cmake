# Manual pages, completions, and the Debian package: `cpack --config build/CPackConfig.cmake`.
install(CODE [[
  set(share $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share)
  set(program $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/bin/terrazzo)
  set(folders man/man1 bash-completion/completions zsh/vendor-completions fish/vendor_completions.d)
  list(TRANSFORM folders PREPEND ${share}/)
  file(MAKE_DIRECTORY ${folders})
  execute_process(COMMAND ${program} man --all ${share}/man/man1 COMMAND_ERROR_IS_FATAL ANY)
  foreach(file bash-completion/completions/terrazzo zsh/vendor-completions/_terrazzo fish/vendor_completions.d/terrazzo.fish)
    string(REGEX REPLACE "[-/].*" "" shell ${file})
    execute_process(COMMAND ${program} completion ${shell} OUTPUT_FILE ${share}/${file} COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
]])
install(FILES LICENSE DESTINATION share/doc/terrazzo RENAME copyright)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME terrazzo)
set(CPACK_PACKAGE_CONTACT "The terrazzo developers <terrazzo@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "more PBR material from a small one: example-based texture synthesis")
set(CPACK_PACKAGE_DESCRIPTION "terrazzo makes more material out of a small one: from the maps of a
 PBR material, or from a photograph, a material of any size that does not
 repeat, with all maps aligned to the pixel. It has a graph editor for the
 browser, and writes the files of engines, glTF, MaterialX and USD.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/runner/cli/package_debian.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
if(TERRAZZO_PYTHON)
  # The module is compiled for this version only.
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PACKAGE_DEPENDS
      "python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}), python3 (<< ${Python3_VERSION_MAJOR}.${next_minor})")
  set(CPACK_DEBIAN_PACKAGE_RECOMMENDS python3-numpy)
endif()
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)  # for programs that link the library
file(WRITE ${CMAKE_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/triggers)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})
include(CPack)
