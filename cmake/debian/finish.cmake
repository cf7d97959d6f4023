# CPack runs this script on the installed tree, before the tree becomes a package: it renames compare, compresses the man
# pages and the changelog as Debian wants them, and writes Debian's own changelog.
set(tree ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/programs/usr)
file(RENAME ${tree}/bin/compare ${tree}/bin/compare-astrolith)
file(RENAME ${tree}/share/man/man1/compare.1 ${tree}/share/man/man1/compare-astrolith.1)

set(documents ${tree}/share/doc/astrolith)
file(RENAME ${documents}/CHANGELOG.md ${documents}/changelog)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${documents}/changelog.Debian "astrolith (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * changelog.gz lists the changes.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
file(GLOB pages ${tree}/share/man/man1/*.1)
foreach(file IN LISTS pages ITEMS ${documents}/changelog ${documents}/changelog.Debian)
  execute_process(COMMAND gzip -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
