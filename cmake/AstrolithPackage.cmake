# cpack -G DEB makes a Debian package of the programs, their man pages and the recipe's schema. scripts/package.sh runs it.
set(CPACK_PACKAGE_NAME astrolith)
# The authors as CITATION.cff names them. They give no address.
file(STRINGS CITATION.cff authors REGEX "^  - name: ")
string(REGEX REPLACE "^  - name: " "" CPACK_PACKAGE_CONTACT "${authors}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "procedural recipes for asteroids and rock")
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION
  "Fits compact procedural recipes to shape models of asteroids and to photos of
 rock, and turns recipes into watertight meshes and textures of any resolution.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL programs)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME astrolith)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# The name compare belongs to ImageMagick where that is installed. The package therefore installs compare-astrolith, and
# offers it as compare to Debian's alternatives.
set(scripts ${PROJECT_BINARY_DIR}/debian)
configure_file(cmake/debian/postinst ${scripts}/postinst COPYONLY)
configure_file(cmake/debian/prerm ${scripts}/prerm COPYONLY)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_CONTROL_EXTRA ${scripts}/postinst ${scripts}/prerm)

# Debian wants the licence and the changes at these places and in these forms.
file(READ LICENSE licence)
string(REGEX REPLACE "\n\n" "\n.\n" licence "${licence}")
string(REGEX REPLACE "\n([^\n])" "\n \\1" licence "${licence}")
file(WRITE ${scripts}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: Astrolith

Files: *
Copyright: 2026 The Astrolith authors
License: Expat
 ${licence}

Files: library/*
Copyright: the people that library/SOURCES.md names for each body
License: CC0-1.0 and CC-BY-4.0
 library/SOURCES.md states the licence of each body.
")
install(FILES ${scripts}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/astrolith COMPONENT programs)
install(FILES CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/astrolith COMPONENT programs)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian/finish.cmake)
include(CPack)
